// One spring of an interface law that softens or dilates, moved by hand, and the numbers that its tests share.
#pragma once
#include "forces/bodies.hpp"

#include <gtest/gtest.h>

namespace cdem {
inline constexpr double kKn = 9e11, kKs = 4e11, kArea = 0.7;  // Pa/m, m^2
inline constexpr double kSigmaT = 2e6, kC = 3e6, kPhi = 35, kGI = 40, kGII = 110;
inline const double kTan = TanOfDegrees(kPhi), kTanPsi = TanOfDegrees(12);
inline const double kT = kSigmaT * kArea, kCohesion = kC * kArea, kN = kKn * kArea, kS = kKs * kArea;  // N, N/m
inline const double kFirst = kSigmaT / kKn, kEnd = 2 * kGI / kSigmaT, kSlipEnd = 2 * kGII / kC;        // m
inline constexpr double kBar = 1e-12;

/// One spring, and its history.
template <class Law>
struct Point {
  double param[kMaxParams] = {}, history[kMaxSpringState] = {}, along = 0, across = 0, energy = 0;
  std::uint8_t state = 0;
  const double n[3] = {0.6, 0, 0.8}, t[3] = {0, 1, 0};  // n.t is 0 without rounding

  explicit Point(double dilation_slip = 1e9) {
    const double property[] = {kSigmaT, kC, kPhi, Law::kParams > 5 ? 12.0 : 0.0, dilation_slip, kGI, kGII};
    Law::Derive(property, param);
  }
  /// A committing evaluation at the opening z and the shift x; along: the pull, across: what resists the shift [N].
  void Move(double x, double z, double rate_x = 0, double rate_z = 0) {
    Spring<double> s{};
    for (int k = 0; k < 3; ++k) {
      s.normal[k] = n[k];
      s.d[k] = z * n[k] + x * t[k];
      s.beta_rate[k] = rate_z * n[k] + rate_x * t[k];
    }
    s.kn = kN, s.ks = kS, s.area = kArea;
    s.param = param;
    s.tension_lost = state & kTensionLost ? 1 : 0;
    s.cohesion_lost = state & kCohesionLost ? 1 : 0;
    std::copy_n(history, kMaxSpringState, s.history);
    double f[3];
    const bool beta = rate_x != 0 || rate_z != 0;
    const auto out = beta ? SpringForce<Law, true>(s, f) : SpringForce<Law, false>(s, f);
    state = NextState(state, StateBits(out));
    if (out.changed) std::copy_n(s.history, kMaxSpringState, history);
    along = -Dot(n, f);
    across = -Dot(t, f);
    energy = Law::Energy(s, f);
  }
  /// To there in a straight line.
  void Go(double x, double z, int steps) {
    const double x0 = x_, z0 = z_;
    for (int i = 1; i <= steps; ++i) Move(x0 + (x - x0) * i / steps, z0 + (z - z0) * i / steps);
    x_ = x, z_ = z;
  }
  double damage() const { return history[Law::kDamage]; }
  double x_ = 0, z_ = 0;
};
using Soft = Point<JointSoftening>;
using SoftRide = Point<JointSofteningDilating>;
using Ride = Point<JointBrittleDilating>;

}  // namespace cdem
