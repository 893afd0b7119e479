// The sharp critical step: the highest frequency itself, by Krylov steps, where the cheap bound judges every element alone.
#pragma once
#include "forces/step_bound.hpp"

#include <petscmat.h>

namespace cdem {

struct SharpStep {
  double theta = 0;        ///< the largest Ritz value [1/s^2], never above the largest eigenvalue
  double residual = 0;     ///< of its Ritz vector [1/s^2]
  int iterations = 0;      ///< products with the stiffness
  bool converged = false;  ///< otherwise the bound is taken
  double w2 = 0;           ///< min(bound, theta + residual) [1/s^2]; its last bits depend on the ranks
  double dt = 0;  ///< critical step with beta [s], rounded down to 10 significant bits; never below the bound's
};

/// The largest eigenvalue of M^(-1/2) K M^(-1/2) over the free components, springs closed (collective; the same on any
/// number of ranks). An estimate: theta + residual says that an eigenvalue is there, and the start vector, random with
/// the modes that give the bound, that it is the largest. Where nothing free has stiffness, the bound is taken.
/// [in] matrix: the elastic operator of these tables, whose Vecs say where the work is done (elastic_operator.hpp); it is
/// shifted. NULL: one of the CPU's loops.
PetscErrorCode ComputeSharpStep(const Mesh &mesh, const Nodes &nodes, const Tables &tables,
                                const std::vector<Material> &materials, const StepBound &bound, SharpStep *sharp,
                                Mat matrix = nullptr);

/// Down to 10 significant bits: sums over ranks differ in the last ones.
double RoundedStep(double step);

/// The square of the residual norm of the largest Ritz pair of a Lanczos process, from the Ritz values alone.
/// [in] before: of k - 1 steps, ascending; now: of k steps. With theta the largest of before, and p_k the characteristic
/// polynomials: p_k(theta) = -b_k^2 p_(k-2)(theta) and s^2 = p_(k-2)(theta)/p_(k-1)'(theta) make
/// (b_k s)^2 = -p_k(theta)/p_(k-1)'(theta).
double RitzResidual2(const std::vector<double> &before, const std::vector<double> &now);

}  // namespace cdem
