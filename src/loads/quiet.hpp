// Quiet boundaries: dashpots that take up waves, and the plane wave that may come in through them.
#pragma once
#include "loads/boundary.hpp"
#include "mesh/split.hpp"
#include "physics/materials.hpp"

namespace cdem {

/// The dashpots of one corner of a face.
struct Dashpot {
  PetscInt node;  ///< local
  double c[6];    ///< C_a of this face alone [N s/m], in the order of small.hpp
};

/// Dashpots of a face at the corners of one side, C_a = integral of N_a rho (c_p n n^T + c_s (1 - n n^T)) dA with rho,
/// c_p and c_s of the element on that side. [in] side: 0 or 1, of Face::cell. [out] dashpots: up to 4. Returns their
/// number. Source: Lysmer and Kuhlemeyer, Finite dynamic model for infinite media, 1969.
int FaceDashpots(const Mesh &mesh, const Nodes &nodes, const std::vector<Material> &materials, const Face &face,
                 int side, Dashpot *dashpots);

/// Remarks on a weight that nothing but dashpots holds: the body sinks. [in] gravity: [3] m/s^2.
void RemarkUnheldWeight(const std::vector<Boundary> &boundaries, const double *gravity,
                        std::vector<std::string> *remarks);

}  // namespace cdem
