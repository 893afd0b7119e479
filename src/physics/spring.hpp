// One spring, as an interface law is given it, and what the law says of it.
#pragma once
#include "core/lanes.hpp"
#include "physics/law.hpp"

#include <cstdint>

namespace cdem {

/// Bits of a spring's state, in laws with history: what it lost for good, what it does now, and whether it has a history
/// though it is not broken. Broken is kCohesionLost, whatever the law; a spring whose state is 0 has no history to read.
enum SpringState { kTensionLost = 1, kCohesionLost = 2, kSliding = 4, kOpen = 8, kDamaged = 16 };

/// One spring, gathered.
template <class T>
struct Spring {
  T normal[3], kn, ks, area, d[3], beta_rate[3];  ///< d = u_b - u_a; beta_rate = beta (v_b - v_a)
  const T *param;
  T tension_lost, cohesion_lost;  ///< 1 or 0
  T history[kMaxSpringState];     ///< the law's own kState numbers; [out] as a committing evaluation leaves them
};

/// What an evaluation made of a spring.
template <class T>
struct Outcome {
  MaskOf<T> open, slides;                 ///< in this evaluation
  MaskOf<T> tension_lost, cohesion_lost;  ///< from now on
  MaskOf<T> changed;                      ///< its history is another one
};

/// The bits that an outcome sets in the state.
template <class T>
CDEM_HD auto StateBits(const Outcome<T> &out) {
  return Bits(out.open, kOpen) | Bits(out.slides, kSliding) | Bits(out.tension_lost, kTensionLost) |
         Bits(out.cohesion_lost, kCohesionLost) | Bits(out.changed & !out.cohesion_lost, kDamaged);
}

/// State byte after a committing evaluation.
CDEM_HD std::uint8_t NextState(std::uint8_t state, long long bits) {
  return static_cast<std::uint8_t>((state & ~(kSliding | kOpen)) | bits);
}

template <class T>
CDEM_HD T Smaller(T a, T b) {
  return a < b ? a : b;
}
template <class T>
CDEM_HD T Larger(T a, T b) {
  return a > b ? a : b;
}

}  // namespace cdem
