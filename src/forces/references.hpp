// References: the strain of an element point and the shift of a spring that make no stress and no force. They are set
// where a body is under stress from the start, and where a stage changes a stiffness.
#pragma once
#include "forces/host_passes.hpp"
#include "physics/laws.hpp"

namespace cdem {

/// The elastic strain (true shears) of a stress [Pa]. [in] param: of a block law, lambda and mu [Pa] first.
inline void StrainOfStress(const double *param, const double stress[6], double strain[6]) {
  const double lambda = param[Elastic::kLambda], mu = param[Elastic::kMu];
  const double trace = stress[kXX] + stress[kYY] + stress[kZZ];
  for (int i = 0; i < 6; ++i) strain[i] = (stress[i] - (i < 3 ? lambda / (3 * lambda + 2 * mu) * trace : 0)) / (2 * mu);
}

/// Histories of a body that has the stress of its materials at u = 0: elements by sigma_0 at their points, springs by the
/// integral of N_j sigma_0 n dA over their face, so that everything is in balance with tractions and gravity.
void StartUnderStress(const Mesh &mesh, const Nodes &nodes, const std::vector<Material> &materials,
                      const Tables &tables, Histories *start);

/// Histories of the next stage's tables: those of the elements and springs that are still there. Where the stiffness is
/// another one, the reference becomes the present state, so that stress and force are continuous; elsewhere nothing changes
/// to the last bit (collective). [in] u: [n_local][3] of the state in which the stage begins.
PetscErrorCode TransferHistories(const Mesh &mesh, const Tables &old, const Histories &before, const Tables &tables,
                                 const double *u, Histories *after);

}  // namespace cdem
