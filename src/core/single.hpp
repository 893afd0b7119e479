// The number types of element arithmetic in single precision, for the CPU and the GPU. They are classes, so that the
// constants of the bodies, which are doubles, become single before they meet a number: else the arithmetic would be double.
#pragma once
#include "core/lanes.hpp"

namespace cdem {

/// V: float, or a vector of floats.
template <class V>
struct SingleOf {
  V v;

  friend CDEM_HD SingleOf operator+(SingleOf a, SingleOf b) { return {a.v + b.v}; }
  friend CDEM_HD SingleOf operator-(SingleOf a, SingleOf b) { return {a.v - b.v}; }
  friend CDEM_HD SingleOf operator*(SingleOf a, SingleOf b) { return {a.v * b.v}; }
  friend CDEM_HD SingleOf operator/(SingleOf a, SingleOf b) { return {a.v / b.v}; }
  friend CDEM_HD SingleOf operator-(SingleOf a) { return {-a.v}; }
  friend CDEM_HD SingleOf operator*(double a, SingleOf b) { return {static_cast<float>(a) * b.v}; }
  friend CDEM_HD SingleOf operator*(SingleOf a, double b) { return {a.v * static_cast<float>(b)}; }
  friend CDEM_HD SingleOf operator/(double a, SingleOf b) { return {static_cast<float>(a) / b.v}; }
  friend CDEM_HD SingleOf operator/(SingleOf a, double b) { return {a.v / static_cast<float>(b)}; }
  friend CDEM_HD auto operator<(SingleOf a, SingleOf b) { return a.v < b.v; }
  CDEM_HD SingleOf &operator+=(SingleOf b) { return *this = *this + b; }
  CDEM_HD SingleOf &operator-=(SingleOf b) { return *this = *this - b; }
  CDEM_HD SingleOf &operator*=(SingleOf b) { return *this = *this * b; }
  CDEM_HD SingleOf &operator*=(double b) { return *this = *this * b; }
};

using Single = SingleOf<float>;

#if !defined(__CUDACC__)

inline constexpr int kSingleLanes = 2 * kLanes;
typedef float SingleVector __attribute__((vector_size(4 * kSingleLanes)));
using SingleLanes = SingleOf<SingleVector>;

/// Two vectors of doubles as one of singles.
CDEM_HD SingleLanes Rounded(Lanes low, Lanes high) {
  typedef float Half __attribute__((vector_size(4 * kLanes)));
  const Half l = __builtin_convertvector(low, Half), h = __builtin_convertvector(high, Half);
#if defined(__AVX512F__)
  return {__builtin_shufflevector(l, h, 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15)};
#elif defined(__AVX__)
  return {__builtin_shufflevector(l, h, 0, 1, 2, 3, 4, 5, 6, 7)};
#else
  return {__builtin_shufflevector(l, h, 0, 1, 2, 3)};
#endif
}

#endif

}  // namespace cdem
