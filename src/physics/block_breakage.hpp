// Breakage of blocks: an element is elastic until its mean stress breaks it in tension or in shear (Mohr-Coulomb); from
// then on every Gauss point returns to the residual strength, without tension and dilation.
#pragma once
#include "physics/mohr_coulomb_return.hpp"
#include "physics/strength.hpp"

namespace cdem {

struct Breakage : BlockLawDefaults {
  static constexpr const char *kName = "breakage";
  static constexpr int kState = 7;  ///< plastic strain (true shears), plastic shear strain; of broken elements
  static constexpr int kPlasticShear = 6;
  static constexpr bool kJudgesMean = true;
  /// Pa; strength: 2 c cos(phi)
  enum { kLambda, kMu, kSinPhi, kStrength, kTension, kResidualSin, kResidualStrength, kParams };

  static constexpr std::array<Property, 7> kProperties = {
      {Elastic::kProperties[0],
       Elastic::kProperties[1],
       kCohesionProperty,
       kFrictionProperty,
       {"tension", "Pa", 0, kPropertyInf, kPropertyClosed, kTensionProperty.text},
       kResidualCohesionProperty,
       kResidualFrictionProperty}};

  static std::string Check(const double *p) { return CheckNotAbove("residual_cohesion", p[5], "cohesion", p[2]); }
  static std::string Remark(const double *p) { return TensionRemark(p[4], MohrCoulombApex(p[2], p[3])); }

  static void Derive(const double *property, double size, double *param) {
    Elastic::Derive(property, size, param);
    const double phi = property[3] * kDegree, residual = std::isinf(property[6]) ? phi : property[6] * kDegree;
    param[kSinPhi] = std::sin(phi);
    param[kStrength] = 2 * property[2] * std::cos(phi);
    param[kTension] = TensionWithin(property[4], MohrCoulombApex(property[2], property[3]));
    param[kResidualSin] = std::sin(residual);
    param[kResidualStrength] = 2 * property[5] * std::cos(residual);
  }

  static void MakeIntact(double *param) { param[kStrength] = param[kTension] = kUnreached; }

  /// Lanes in which a mean stress breaks the element. A stress that is zero (hydrostatic) breaks nothing in tension (in
  /// shear), whatever the strength: a body without strength rests intact.
  template <class T>
  static CDEM_HD void Judge(const T *param, const T mean[6], MaskOf<T> *tension, MaskOf<T> *shear) {
    const MohrCoulombSurface<T> m = {param[kSinPhi], T{}, param[kStrength], param[kTension]};
    const MaskOf<T> near = MayHaveLeft(m, mean);
    *tension = *shear = T{} < T{};
    if (!Any(near)) return;
    T s[3];
    PrincipalValues(mean, s);
    *tension = near & (s[0] >= m.tension) & (s[0] > T{});
    *shear = near & ((1.0 + m.sin_phi) * s[0] - (1.0 - m.sin_phi) * s[2] >= m.strength) & (s[0] > s[2]);
  }

  /// Stress [Pa] of a strain (true shears) at one Gauss point of a broken element; the lanes whose state changed.
  template <class T>
  static CDEM_HD MaskOf<T> Stress(const T *param, const T strain[6], T state[kState], T stress[6]) {
    const MohrCoulombSurface<T> m = {param[kResidualSin], T{}, param[kResidualStrength], T{}};
    return MohrCoulombStress(m, param, strain, state, stress);
  }
};

/// Breaking blocks that carry an offset: intact ones too are measured from it.
struct BreakageOffset : Breakage {
  static constexpr bool kCarriesOffset = true;
};

}  // namespace cdem
