// The cheap, rigorous bound of the critical time step: elements, springs and stiffness-proportional damping together.
#pragma once
#include "forces/tables.hpp"

namespace cdem {

struct StepBound {
  double element_w2 = 0;  ///< largest lambda_max(K_e, M_e) over the elements, from above [1/s^2]
  double spring_w2 = 0;   ///< largest 2 lambda_max(S_a)/m_a over the nodes, from above [1/s^2]
  double dt = 0;          ///< critical step with beta [s], never above the exact one

  double w2() const { return element_w2 + spring_w2; }
  /// Where the bound is reached, the first on this rank; -1 where it is reached only elsewhere.
  std::vector<int> element;  ///< per element table
  int node = -1;             ///< owned
};

/// w^2 <= max_e lambda_max(K_e, M_e) + max_a 2 lambda_max(S_a)/m_a (collective; the same on any number of ranks).
/// lambda_max is taken from above as ||A^16||_F^(1/16) of the mass-scaled matrix.
PetscErrorCode ComputeStepBound(const Tables &tables, const std::vector<Material> &materials, StepBound *bound);

/// The mode of the largest eigenvalue of element e in M_e^(-1/2) K_e M_e^(-1/2), nearly, of length 1.
/// [out] mode: [corners][3], in M_e^(1/2) u.
void ElementMode(const Tables &tables, const std::vector<Material> &materials, const ElementTable &t, int e,
                 double (*mode)[3]);
/// The same of the springs of an owned node alone: the direction [3] of the largest eigenvalue of S_a, nearly.
void SpringMode(const Tables &tables, int node, double mode[3]);

/// Gives every node the mass at which the bound above is w2 [1/s^2] in its own elements and springs, so that all of a body
/// runs at one step, and keeps its true share of it as weight: for runs whose inertia does not matter. Every element gives
/// lambda_max(K_e, M_e)/w2 times its mass, every spring what holds it, so that K <= w2 M.
void ScaleMasses(const std::vector<Material> &materials, double w2, Tables *tables);

/// Critical step of the largest frequency w [1/s] with beta damping [s]: (2/w)(sqrt(1 + x^2) - x), x = beta w/2.
double CriticalStep(double w2, double beta);

}  // namespace cdem
