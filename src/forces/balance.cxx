#include "forces/balance.hpp"

#include "core/order_free_sum.hpp"

namespace cdem {

PetscErrorCode BalanceOnHost(const Tables &tables, const double *u, const double *v, const BalanceMemory &memory,
                             BalanceTerms *terms) {
  PetscFunctionBeginUser;
  const std::size_t n = static_cast<std::size_t>(tables.n_owned);
  const bool path = !memory.u.empty();
  std::vector<double> share(kBalanceShares * n);
  for (std::size_t i = 0; i < n; ++i) {
    double one[kBalanceShares];
    BalanceOfNode(tables.mass[i], u + 3 * i, v + 3 * i, &memory.now[3 * i], path ? &memory.u[3 * i] : nullptr,
                  path ? &memory.residual[3 * i] : nullptr, one);
    for (int k = 0; k < kBalanceShares; ++k) share[k * n + i] = one[k];
  }
  std::vector<std::vector<Summands>> of(kBalanceShares);
  for (int k = 0; k < kBalanceShares; ++k) of[k] = {{share.data() + k * n, nullptr, n}};
  std::vector<double> sums;
  PetscCall(SumInAnyOrder(tables.comm, of, &sums));
  *terms = {sums[0], sums[1], sums[2]};
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode KineticOnHost(const Tables &tables, const double *v, double *energy) {
  PetscFunctionBeginUser;
  const std::size_t n = static_cast<std::size_t>(tables.n_owned);
  std::vector<double> share(n);
  for (std::size_t i = 0; i < n; ++i) share[i] = 0.5 * tables.mass[i] * Dot(v + 3 * i, v + 3 * i);
  std::vector<double> sums;
  PetscCall(SumInAnyOrder(tables.comm, {{{share.data(), nullptr, n}}}, &sums));
  *energy = sums[0];
  PetscFunctionReturn(PETSC_SUCCESS);
}

}  // namespace cdem
