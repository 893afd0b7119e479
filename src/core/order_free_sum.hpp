// Sums of many numbers that do not depend on their order, nor on the ranks that hold them: every number is cut into two
// integers of a common unit, and integers add up exactly.
#pragma once
#include "core/host_device.hpp"
#include "core/petsc.hpp"

#include <cmath>
#include <cstdint>
#include <vector>

namespace cdem {

/// Integers of 33 bits each, so that 2^29 of them add up without overflow.
inline constexpr int kSumBits = 33;

/// What becomes of a number in units that the largest size of all of them sets.
struct SumUnit {
  double high = 0, low = 0;  ///< one over the units of the two parts; 0 where all numbers are 0

  /// [in] largest: of the sizes of the numbers, finite.
  static SumUnit Of(double largest) {
    SumUnit unit;
    if (!(largest > 0)) return unit;
    int exponent;
    std::frexp(largest, &exponent);
    if (exponent < -900) exponent = -900;  // the units of the parts stay normal numbers
    unit.high = std::ldexp(1.0, kSumBits - exponent);
    unit.low = std::ldexp(1.0, kSumBits);
    return unit;
  }
  CDEM_HD void Cut(double x, long long part[2]) const {
    const double scaled = x * high, whole = ::rint(scaled);
    part[0] = static_cast<long long>(whole);
    part[1] = static_cast<long long>(::rint((scaled - whole) * low));
  }
  double Value(const long long part[2]) const {
    return high > 0 ? (static_cast<double>(part[0]) + static_cast<double>(part[1]) / low) / high : 0;
  }
};

/// Some of the numbers of a sum. counted: one flag a number, NULL: all count.
struct Summands {
  const double *value = nullptr;
  const std::uint8_t *counted = nullptr;
  std::size_t n = 0;
};

/// sums[i] = the sum of all numbers of terms[i] on all ranks (collective); not a number where one of them is none.
PetscErrorCode SumInAnyOrder(MPI_Comm comm, const std::vector<std::vector<Summands>> &terms, std::vector<double> *sums);

}  // namespace cdem
