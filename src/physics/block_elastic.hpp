// Linear elastic blocks (Eq. 1 of the method's paper): sigma = lambda tr(eps) 1 + 2 mu eps.
#pragma once
#include "core/lanes.hpp"
#include "physics/law.hpp"

namespace cdem {

struct Elastic : BlockLawDefaults {
  static constexpr const char *kName = "elastic";
  static constexpr bool kLinear = true;  ///< the forces are linear in u: beta damping acts on u + beta v for free
  enum { kLambda, kMu, kParams };        ///< Pa

  static constexpr std::array<Property, 2> kProperties = {
      {{"young", "Pa", 0, kPropertyInf, kPropertyOpen, "Young's modulus"},
       {"poisson", "", -1, 0.5, kPropertyOpen, "Poisson's ratio"}}};

  /// Parameters of the point function from the properties above. [in] size: of the element [m], for laws that need it.
  static void Derive(const double *property, double /*size*/, double *param) {
    double e = property[0], nu = property[1];
    param[kLambda] = e * nu / ((1 + nu) * (1 - 2 * nu));
    param[kMu] = e / (2 * (1 + nu));
  }

  /// Stress [Pa] of a strain (true shears) at one Gauss point.
  template <class T>
  static CDEM_HD void Stress(const T *param, const T strain[6], T stress[6]) {
    T pressure = param[kLambda] * (strain[kXX] + strain[kYY] + strain[kZZ]);
    T two_mu = param[kMu] + param[kMu];
    stress[kXX] = two_mu * strain[kXX] + pressure;
    stress[kYY] = two_mu * strain[kYY] + pressure;
    stress[kZZ] = two_mu * strain[kZZ] + pressure;
    stress[kXY] = two_mu * strain[kXY];
    stress[kYZ] = two_mu * strain[kYZ];
    stress[kXZ] = two_mu * strain[kXZ];
  }
};

/// The elastic part of a law that carries an offset: the stress of what its strain is more than the first six numbers of
/// its history.
template <int kNumbers>
struct ElasticFrom : BlockLawDefaults {
  static constexpr int kState = kNumbers;
  template <class T>
  static CDEM_HD MaskOf<T> Stress(const T *param, const T strain[6], T state[kState], T stress[6]) {
    T e[6];
    CDEM_UNROLL for (int i = 0; i < 6; ++i) e[i] = strain[i] - state[i];
    Elastic::Stress(param, e, stress);
    return T{} < T{};
  }
};

/// Elastic blocks that carry an offset.
struct ElasticOffset : ElasticFrom<6> {
  static constexpr const char *kName = Elastic::kName;
  static constexpr bool kCarriesOffset = true;
  static constexpr int kParams = Elastic::kParams;
  static constexpr auto kProperties = Elastic::kProperties;
  static void Derive(const double *property, double size, double *param) { Elastic::Derive(property, size, param); }
};

}  // namespace cdem
