// Linear elastic springs (Eq. 2 of the method's paper): F_n = -K_n d_n, F_s = -K_s d_s, never broken.
#pragma once
#include "physics/law.hpp"

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

}  // namespace cdem
