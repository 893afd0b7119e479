// What steers a relaxation: sums over the nodes that depend neither on their order nor on the ranks.
#pragma once
#include "forces/tables.hpp"

namespace cdem {

/// What the checks of a relaxation keep, [n_owned][3] on the host.
struct BalanceMemory {
  std::vector<double> u, residual;  ///< at the last check that counts [m], [N]; empty before the first one
  std::vector<double> now;          ///< residual of the last look [N]
};

/// Over all ranks: kinetic energy [J]; over the path du since the last check that counts: du . K du [J], du . M du [kg m^2].
struct BalanceTerms {
  double kinetic = 0, stiffness = 0, inertia = 0;
};
inline constexpr int kBalanceShares = 3;

/// A node's share of them. [in] v: at t_n; force: out of balance, 0 where prescribed; last_u, last_force: those of the last
/// check, or NULL.
CDEM_HD void BalanceOfNode(double mass, const double u[3], const double v[3], const double force[3],
                           const double *last_u, const double *last_force, double share[kBalanceShares]) {
  for (int k = 0; k < kBalanceShares; ++k) share[k] = 0;
  for (int k = 0; k < 3; ++k) {
    share[0] += 0.5 * mass * v[k] * v[k];
    if (!last_u || force[k] == 0) continue;
    const double du = u[k] - last_u[k];
    share[1] += du * (last_force[k] - force[k]);
    share[2] += du * mass * du;
  }
}

/// The terms of host arrays (collective). [in] u, v, memory.now: [n_owned][3].
PetscErrorCode BalanceOnHost(const Tables &tables, const double *u, const double *v, const BalanceMemory &memory,
                             BalanceTerms *terms);
/// The kinetic energy alone (collective). [in] v: [n_owned][3].
PetscErrorCode KineticOnHost(const Tables &tables, const double *v, double *energy);

}  // namespace cdem
