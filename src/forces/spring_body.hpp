// The contents of the loop over springs: host and device loops gather, call this, and store.
#pragma once
#include "core/lanes.hpp"
#include "core/small.hpp"
#include "physics/laws.hpp"

#include <cstdint>

namespace cdem {

/// One spring, gathered.
template <class T>
struct Spring {
  T normal[3], kn, ks, area, d[3], beta_rate[3];  ///< d = u_b - u_a; beta_rate = beta (v_b - v_a)
  const T *param;
  T tension_lost, cohesion_lost;  ///< 1 or 0
  T slip[3];
};

/// Force on node b [N]. For laws with history, [out] breaks and slides: what the state byte and the slip become when the
/// evaluation is a committing one.
template <class Law, bool kBeta, class T>
CDEM_HD void SpringForce(Spring<T> &s, T force[3], MaskOf<T> *opens, MaskOf<T> *slides) {
  if constexpr (Law::kLinear) {
    T w[3];
    CDEM_UNROLL for (int k = 0; k < 3; ++k) w[k] = kBeta ? s.d[k] + s.beta_rate[k] : s.d[k];
    Law::Force(s.normal, s.kn, s.ks, w, force);
  } else {
    T tension = s.param[Law::kTension] * s.area * (1.0 - s.tension_lost);
    T cohesion = s.param[Law::kCohesion] * s.area * (1.0 - s.cohesion_lost);
    auto out = Law::template Force<kBeta>(s.normal, s.kn, s.ks, tension, cohesion, s.param[Law::kTanPhi], s.d,
                                          s.beta_rate, s.slip, force);
    *opens = out.open;
    *slides = out.slides;
  }
}

/// State byte after a committing evaluation.
CDEM_HD std::uint8_t NextState(std::uint8_t state, bool opens, bool slides, bool keep_tension) {
  int next = state & ~(kSliding | kOpen);
  if (opens) next |= kTensionLost | kCohesionLost | kOpen;
  if (slides) next |= (keep_tension ? 0 : kTensionLost) | kCohesionLost | kSliding;
  return static_cast<std::uint8_t>(next);
}

/// Energy stored in a spring that exerts force over K_n and K_s: F_n^2 / 2 K_n + F_s^2 / 2 K_s [J].
template <class T>
CDEM_HD T SpringEnergy(const T normal[3], T kn, T ks, const T force[3]) {
  T along = Dot(normal, force);
  T shear2 = Dot(force, force) - along * along;
  return 0.5 * (along * along / kn + shear2 / ks);
}

}  // namespace cdem
