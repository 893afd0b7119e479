// Mohr-Coulomb plasticity, perfectly plastic, with dilation and tension cut-off.
#pragma once
#include "physics/mohr_coulomb_return.hpp"
#include "physics/strength.hpp"

namespace cdem {

struct MohrCoulomb : BlockLawDefaults {
  static constexpr const char *kName = "mohr_coulomb";
  static constexpr int kState = 7;  ///< plastic strain (true shears), plastic shear strain
  static constexpr int kPlasticShear = 6;
  static constexpr bool kCarriesOffset = true;
  enum { kLambda, kMu, kSinPhi, kSinPsi, kStrength, kTension, kParams };  ///< Pa; strength: 2 c cos(phi)

  static constexpr std::array<Property, 6> kProperties = {{Elastic::kProperties[0], Elastic::kProperties[1],
                                                           kCohesionProperty, kFrictionProperty, kDilationProperty,
                                                           kTensionProperty}};

  static std::string Check(const double *p) { return CheckDilation(p[3], p[4]); }
  static std::string Remark(const double *p) { return TensionRemark(p[5], MohrCoulombApex(p[2], p[3])); }

  static void Derive(const double *property, double size, double *param) {
    Elastic::Derive(property, size, param);
    param[kSinPhi] = std::sin(property[3] * kDegree);
    param[kSinPsi] = std::sin(property[4] * kDegree);
    param[kStrength] = 2 * property[2] * std::cos(property[3] * kDegree);
    param[kTension] = TensionWithin(property[5], MohrCoulombApex(property[2], property[3]));
  }

  static void MakeIntact(double *param) { param[kStrength] = param[kTension] = kUnreached; }

  /// Stress [Pa] of a strain (true shears) at one Gauss point; the mask of the lanes whose state changed.
  template <class T>
  static CDEM_HD MaskOf<T> Stress(const T *param, const T strain[6], T state[kState], T stress[6]) {
    const MohrCoulombSurface<T> m = {param[kSinPhi], param[kSinPsi], param[kStrength], param[kTension]};
    return MohrCoulombStress(m, param, strain, state, stress);
  }
};

}  // namespace cdem
