#include "core/exact_sum.hpp"

#include <cmath>

namespace cdem {

void ExactSum::Add(double term) {
  if (!std::isfinite(term)) {
    ++not_finite_;
    return;
  }
  if (term == 0) return;
  int exponent;
  const double mantissa = std::frexp(std::fabs(term), &exponent);
  const auto whole = static_cast<std::uint64_t>(std::ldexp(mantissa, 53));  // term is whole 2^(exponent - 53)
  const int at = exponent - 53 + kLowest, limb = at / kBits, shift = at % kBits;
  const std::uint64_t low = (whole & 0xffffffffu) << shift, high = (whole >> kBits) << shift;
  const std::int64_t sign = term < 0 ? -1 : 1;
  limb_[limb] += sign * static_cast<std::int64_t>(low & 0xffffffffu);
  limb_[limb + 1] += sign * static_cast<std::int64_t>((low >> kBits) + (high & 0xffffffffu));
  limb_[limb + 2] += sign * static_cast<std::int64_t>(high >> kBits);
}

/// Brings every limb but the last into 0 to 2^32 - 1: one sum has one form then.
void ExactSum::Carry() {
  constexpr std::int64_t kBase = std::int64_t{1} << kBits;
  for (int i = 0; i + 1 < kLimbs; ++i) {
    const std::int64_t rest = ((limb_[i] % kBase) + kBase) % kBase;
    limb_[i + 1] += (limb_[i] - rest) / kBase;
    limb_[i] = rest;
  }
}

double ExactSum::Value() const {
  if (not_finite_ != 0) return std::nan("");
  ExactSum sum = *this;
  sum.Carry();
  const double sign = sum.limb_[kLimbs - 1] < 0 ? -1 : 1;
  if (sign < 0) {
    for (std::int64_t &limb : sum.limb_) limb = -limb;
    sum.Carry();
  }
  double value = 0;
  for (int i = kLimbs - 1; i >= 0; --i) value += std::ldexp(static_cast<double>(sum.limb_[i]), i * kBits - kLowest);
  return sign * value;
}

PetscErrorCode ExactSum::OverRanks(MPI_Comm comm, ExactSum *sums, int n) {
  PetscFunctionBeginUser;
  static_assert(sizeof(ExactSum) == (kLimbs + 1) * sizeof(std::int64_t), "limbs and the count lie in a row");
  for (int i = 0; i < n; ++i) sums[i].Carry();
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, sums, n * (kLimbs + 1), MPI_INT64_T, MPI_SUM, comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

}  // namespace cdem
