#include "core/order_free_sum.hpp"

#include <limits>

namespace cdem {

/// The largest size, or infinity where one of them is no finite number.
static double Largest(const std::vector<Summands> &term) {
  double most = 0;
  for (const Summands &s : term)
    for (std::size_t i = 0; i < s.n; ++i) {
      if (s.counted && !s.counted[i]) continue;
      const double size = std::fabs(s.value[i]);
      if (!(size <= most)) most = std::isfinite(size) ? size : std::numeric_limits<double>::infinity();
    }
  return most;
}

PetscErrorCode SumInAnyOrder(MPI_Comm comm, const std::vector<std::vector<Summands>> &terms,
                             std::vector<double> *sums) {
  PetscFunctionBeginUser;
  const int n = static_cast<int>(terms.size());
  std::vector<double> largest(terms.size());
  for (std::size_t t = 0; t < terms.size(); ++t) largest[t] = Largest(terms[t]);
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, largest.data(), n, MPI_DOUBLE, MPI_MAX, comm));
  std::vector<long long> part(2 * terms.size(), 0);
  for (std::size_t t = 0; t < terms.size(); ++t) {
    if (!std::isfinite(largest[t])) continue;
    const SumUnit unit = SumUnit::Of(largest[t]);
    for (const Summands &s : terms[t])
      for (std::size_t i = 0; i < s.n; ++i) {
        if (s.counted && !s.counted[i]) continue;
        long long p[2];
        unit.Cut(s.value[i], p);
        part[2 * t] += p[0];
        part[2 * t + 1] += p[1];
      }
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, part.data(), 2 * n, MPI_LONG_LONG, MPI_SUM, comm));
  sums->resize(terms.size());
  for (std::size_t t = 0; t < terms.size(); ++t)
    (*sums)[t] = std::isfinite(largest[t]) ? SumUnit::Of(largest[t]).Value(&part[2 * t])
                                           : std::numeric_limits<double>::quiet_NaN();
  PetscFunctionReturn(PETSC_SUCCESS);
}

}  // namespace cdem
