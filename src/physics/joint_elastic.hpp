// Linear elastic springs (Eq. 2 of the method's paper): F_n = -K_n d_n, F_s = -K_s d_s, never broken.
#pragma once
#include "physics/spring.hpp"

namespace cdem {

struct JointElastic : JointLawDefaults {
  static constexpr const char *kName = "elastic";
  static constexpr bool kLinear = true;
  static constexpr bool kHistory = false;
  enum { kParams };
  static constexpr std::array<Property, 0> kProperties = {};
  static void Derive(const double *, double *) {}

  /// Force on node b of a spring [N], minus it on node a, for the relative displacement d = u_b - u_a [m].
  template <class T>
  static CDEM_HD void Force(const T normal[3], T kn, T ks, const T d[3], T force[3]) {
    T along = Dot(normal, d);
    T extra = (kn - ks) * along;  // K_n d_n n + K_s (d - d_n n) = K_s d + (K_n - K_s) d_n n
    CDEM_UNROLL for (int k = 0; k < 3; ++k) force[k] = -(ks * d[k] + extra * normal[k]);
  }
};

/// The same, measured from an offset: F_n = -K_n (d_n - g), F_s = -K_s (d_s - s).
struct JointElasticOffset : JointLawDefaults {
  static constexpr const char *kName = JointElastic::kName;
  static constexpr bool kCarriesOffset = true;
  enum { kParams };
  static constexpr std::array<Property, 0> kProperties = {};
  static void Derive(const double *, double *) {}
  enum { kSlip = 0, kGap = 3 };
  static constexpr int kState = 4;  ///< slip s [3], opening g [m]

  template <bool kBeta, class T>
  static CDEM_HD Outcome<T> Force(Spring<T> &s, T force[3]) {
    T w[3];
    CDEM_UNROLL for (int k = 0; k < 3; ++k) {
      w[k] = s.d[k] - (s.history[kSlip + k] + s.history[kGap] * s.normal[k]);
      if (kBeta) w[k] += s.beta_rate[k];
    }
    JointElastic::Force(s.normal, s.kn, s.ks, w, force);
    const MaskOf<T> none = T{} < T{};
    return {none, none, none, none, none};
  }
};

}  // namespace cdem
