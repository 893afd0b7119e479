// Sums of doubles that do not know the order of their terms: the same on any number of ranks.
#pragma once
#include "core/petsc.hpp"

#include <cstdint>

namespace cdem {

/// Adds doubles without rounding, in fixed-point numbers that span the whole range of a double; rounds at the end, when asked.
class ExactSum {
 public:
  /// Up to 2^31 terms on a rank.
  void Add(double term);
  /// The sum; not a number when a term was not finite.
  double Value() const;
  /// Adds n sums over the ranks (collective).
  static PetscErrorCode OverRanks(MPI_Comm comm, ExactSum *sums, int n);

 private:
  void Carry();

  static constexpr int kBits = 32, kLimbs = 70;
  static constexpr int kLowest = 1127;  ///< limb 0 counts units of 2^-1127
  std::int64_t limb_[kLimbs] = {}, not_finite_ = 0;
};

}  // namespace cdem
