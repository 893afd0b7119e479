// Tetrahedra of the form bbar: dilatations and pressures averaged at the nodes, in two passes over the nodes with a halo
// exchange each. Regions are averaged apart, so that nothing is smeared across a change of material.
#pragma once
#include "forces/tables.hpp"
#include "mesh/mesh.hpp"

namespace cdem {

/// Numbers the regions that average, weighs their nodes and completes the element tables (collective).
PetscErrorCode BuildAveraging(const Mesh &mesh, const std::vector<Material> &materials, Tables *tables);

/// What one evaluation of the forces passes between elements and nodes on the CPU.
struct Averages {
  int rates = 1;                                ///< 2 with beta damping: dilatations of u and of beta v
  std::vector<double> dilatation;               ///< [n_local][layer][rate]
  std::vector<double> pressure;                 ///< [n_local][layer] Pa, the sum of integrals [N m] at first
  const std::vector<double> *before = nullptr;  ///< dilatation of the step before, for the energy audit
  std::vector<std::vector<double>> force;       ///< per element table that averages, [corner][component][n_pad] N
};

/// Nodal dilatations of u, and of beta v where beta is not 0 (collective).
PetscErrorCode AverageDilatation(const Tables &tables, const double *u, const double *v, double beta,
                                 Averages *averages);
/// Nodal pressures from the sums of the elements' integrals (collective).
PetscErrorCode AveragePressure(const Tables &tables, Averages *averages);
/// Adds the corner forces of a table, with their pressure averaged, to f.
void AddAveraged(const Tables &tables, std::size_t table, const Averages &averages, double *f);

}  // namespace cdem
