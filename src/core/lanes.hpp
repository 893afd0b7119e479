// The number type of the CPU: a GCC vector of doubles, as wide as the target's registers. Arithmetic, comparison and
// (mask ? a : b) come from the compiler; the few functions that do not are here, for Lanes and for double alike.
#pragma once
#include "core/host_device.hpp"

#include <cmath>

namespace cdem {

CDEM_HD double Sqrt(double a) { return ::sqrt(a); }
CDEM_HD bool Any(bool a) { return a; }
/// T from memory that need not be aligned, and back.
template <class T>
CDEM_HD T LoadAs(const double *p);
template <>
CDEM_HD double LoadAs<double>(const double *p) {
  return *p;
}
CDEM_HD void StoreAs(double *p, double v) { *p = v; }
CDEM_HD int Bits(bool mask, int bits) { return mask ? bits : 0; }

#if !defined(__CUDACC__)

#if defined(__AVX512F__)
inline constexpr int kLanes = 8;
#elif defined(__AVX__)
inline constexpr int kLanes = 4;
#else
inline constexpr int kLanes = 2;
#endif
typedef double Lanes __attribute__((vector_size(8 * kLanes)));
typedef decltype(Lanes{} < Lanes{}) LaneMask;

CDEM_HD Lanes Sqrt(Lanes a) {
  for (int l = 0; l < kLanes; ++l) a[l] = ::sqrt(a[l]);  // GCC turns this into one packed square root
  return a;
}
CDEM_HD bool Any(LaneMask a) {
  long long any = 0;
  for (int l = 0; l < kLanes; ++l) any |= a[l];
  return any != 0;
}
template <>
CDEM_HD Lanes LoadAs<Lanes>(const double *p) {
  Lanes r;
  __builtin_memcpy(&r, p, sizeof r);
  return r;
}
CDEM_HD void StoreAs(double *p, Lanes v) { __builtin_memcpy(p, &v, sizeof v); }
CDEM_HD LaneMask Bits(LaneMask mask, int bits) { return mask & bits; }

#endif

/// The mask type of a comparison of T.
template <class T>
using MaskOf = decltype(T{} < T{});

/// Count rounded up to full lanes of the widest target, so that tables do not depend on the machine.
inline constexpr int kPad = 8;
template <class I>
constexpr I Padded(I n) {
  return (n + kPad - 1) / kPad * kPad;
}

}  // namespace cdem
