// Drucker-Prager plasticity: f = sqrt(J2) + a I1 - k, flow by a_psi, cut-off I1 <= sigma_t, and linear softening.
#pragma once
#include "physics/block_elastic.hpp"
#include "physics/principal.hpp"
#include "physics/strength.hpp"

namespace cdem {

struct DruckerPrager : BlockLawDefaults {
  static constexpr const char *kName = "drucker_prager";
  static constexpr int kState = 7;  ///< plastic strain (true shears), plastic shear strain
  static constexpr int kPlasticShear = 6;
  static constexpr bool kNeedsSize = true;
  static constexpr bool kCarriesOffset = true;
  enum Cone { kOuter, kMiddle, kInscribed };
  /// Slope of the cone, of the flow [-], shear strength at I1 = 0 and cut-off [Pa]; what they lose down to the residual
  /// strength; and one over the plastic shear strain at which they have lost it.
  enum { kLambda, kMu, kA, kFlow, kK, kTension, kLossA, kLossFlow, kLossK, kLossTension, kRate, kParams };

  enum { kCohesion = 2, kFriction, kDilation, kSigmaT, kCone, kGf, kResidualC, kResidualPhi, kResidualT };
  static constexpr std::array<Property, 11> kProperties = {
      {Elastic::kProperties[0],
       Elastic::kProperties[1],
       kCohesionProperty,
       kFrictionProperty,
       kDilationProperty,
       kTensionProperty,
       {"cone", "", 0, 2, kPropertyClosed,
        "Mohr-Coulomb's edges that the cone goes through: of compression, of extension; or within its planes", 0,
        "outer,middle,inscribed"},
       {"gf", "J/m^2", 0, kPropertyInf, kPropertyOpen,
        "fracture energy: the strength falls linearly to the residual one with plastic shear strain, the faster the "
        "larger the element",
        kPropertyInf, "", "no softening"},
       kResidualCohesionProperty,
       kResidualFrictionProperty,
       {"residual_tension", "Pa", 0, kPropertyInf, kPropertyClosed, "tensile strength that is left in the end",
        kPropertyInf, "", "0 if tension is given"}}};

  /// Slope a and shear strength k [Pa] at I1 = 0 of a cone, by Mohr-Coulomb's numbers (angle in degrees).
  static void ConeOf(int cone, double cohesion, double angle, double *a, double *k) {
    const double root3 = std::sqrt(3.0), s = std::sin(angle * kDegree), c = std::cos(angle * kDegree);
    const double below = cone == kOuter    ? root3 * (3 - s) / 2
                         : cone == kMiddle ? root3 * (3 + s) / 2
                                           : root3 * std::sqrt(3 + s * s);
    *a = s / below;
    *k = 3 * cohesion * c / below;
  }

  struct Strength {
    double a, flow, k, tension, apex;
  };
  static Strength Peak(const double *p) {
    Strength s;
    double unused;
    ConeOf(static_cast<int>(p[kCone]), p[kCohesion], p[kFriction], &s.a, &s.k);
    ConeOf(static_cast<int>(p[kCone]), 0, p[kDilation], &s.flow, &unused);
    s.apex = s.a > 0 ? s.k / s.a : kPropertyInf;
    s.tension = TensionWithin(p[kSigmaT], s.apex);
    return s;
  }
  static Strength Residual(const double *p) {
    Strength s;
    const double phi = std::isinf(p[kResidualPhi]) ? p[kFriction] : p[kResidualPhi];
    ConeOf(static_cast<int>(p[kCone]), p[kResidualC], phi, &s.a, &s.k);
    s.flow = std::fmin(Peak(p).flow, s.a);
    s.apex = s.a > 0 ? s.k / s.a : kPropertyInf;
    const double left = std::isinf(p[kResidualT]) && std::isfinite(p[kSigmaT]) ? 0 : p[kResidualT];
    s.tension = TensionWithin(left, s.apex);
    return s;
  }
  static bool Softens(const double *p) { return std::isfinite(p[kGf]); }

  static std::string Check(const double *p) {
    std::string wrong = CheckDilation(p[kFriction], p[kDilation]);
    const bool residual = p[kResidualC] != 0 || std::isfinite(p[kResidualPhi]) || std::isfinite(p[kResidualT]);
    if (wrong.empty() && residual && !Softens(p))
      wrong = "the residual strength is reached by softening: give gf in J/m^2";
    if (!Softens(p) || !wrong.empty()) return wrong;
    wrong = CheckNotAbove("residual_cohesion", p[kResidualC], "cohesion", p[kCohesion]);
    if (wrong.empty() && std::isfinite(p[kResidualPhi]))
      wrong = CheckNotAbove("residual_friction", p[kResidualPhi], "friction", p[kFriction]);
    if (wrong.empty() && std::isfinite(p[kResidualT])) {
      if (std::isinf(p[kSigmaT])) return "residual_tension is given without tension";
      wrong = CheckNotAbove("residual_tension", p[kResidualT], "tension", p[kSigmaT]);
    }
    if (wrong.empty() && Residual(p).k >= Peak(p).k)
      wrong = "gf is given, but the shear strength does not fall: lower residual_cohesion";
    return wrong;
  }
  static std::string Remark(const double *p) { return TensionRemark(p[kSigmaT], Peak(p).apex); }

  /// 2 G gf/(k - k_residual)^2, from which on the softening is as steep as the unloading.
  static double LargestCell(const double *p) {
    const double lost = Peak(p).k - Residual(p).k;
    return Softens(p) ? p[0] / (1 + p[1]) * p[kGf] / (lost * lost) : kPropertyInf;
  }

  /// With gf the strength is residual where plastic shear strain x size has spent gf: (k - k_residual)/2 of it per
  /// volume at I1 = 0.
  static void Derive(const double *property, double size, double *param) {
    Elastic::Derive(property, size, param);
    const Strength peak = Peak(property);
    param[kA] = peak.a, param[kFlow] = peak.flow, param[kK] = peak.k, param[kTension] = peak.tension;
    param[kLossA] = param[kLossFlow] = param[kLossK] = param[kLossTension] = param[kRate] = 0;
    if (!Softens(property)) return;
    const Strength left = Residual(property);
    param[kLossA] = peak.a - left.a, param[kLossFlow] = peak.flow - left.flow, param[kLossK] = peak.k - left.k;
    param[kLossTension] = peak.tension - left.tension;
    param[kRate] = size * (peak.k - left.k) / (2 * property[kGf]);
  }

  static void MakeIntact(double *param) { param[kK] = param[kTension] = kUnreached; }

  /// Stress [Pa] of a strain (true shears) at one Gauss point; the mask of the lanes whose state changed. The strength is
  /// that of the plastic shear strain before.
  template <class T>
  static CDEM_HD MaskOf<T> Stress(const T *param, const T strain[6], T state[kState], T stress[6]) {
    const T zero = T{}, mu = param[kMu], bulk9 = 9.0 * param[kLambda] + 6.0 * mu;
    T e[6];
    CDEM_UNROLL for (int i = 0; i < 6; ++i) e[i] = strain[i] - state[i];
    Elastic::Stress(param, e, stress);
    T lost = state[6] * param[kRate];
    lost = lost > 1.0 ? zero + 1.0 : lost;
    const T a = param[kA] - lost * param[kLossA], k = param[kK] - lost * param[kLossK];
    const T tension = param[kTension] - lost * param[kLossTension];
    const T trace = stress[kXX] + stress[kYY] + stress[kZZ], mean = trace * (1.0 / 3.0);
    const T j2 = SecondInvariant(stress, mean), room = k - a * trace;
    const MaskOf<T> yields = (j2 > room * room) | (room < zero) | (trace > tension);
    if (Any(yields)) {
      // On the cone, but no further than the corner with the cut-off (the apex, where that is the cut-off).
      const T flow = param[kFlow] - lost * param[kLossFlow], q = Sqrt(j2);
      T slip = (q - room) / (mu + bulk9 * a * flow), corner = k - a * tension;
      corner = corner > zero ? corner : zero;
      const T most = (q - corner) / mu;
      slip = slip < most ? slip : most;
      slip = slip > zero ? slip : zero;
      T back = trace - bulk9 * flow * slip;
      back = back > tension ? tension : back;
      const T drop = (trace - back) * (1.0 / 3.0), part = mu * slip / (q > zero ? q : q + 1.0);
      const T swell = (trace - back) / bulk9;
      CDEM_UNROLL for (int i = 0; i < 6; ++i) {
        const T away = part * (i < 3 ? stress[i] - mean : stress[i]);
        state[i] = yields ? state[i] + (away * 0.5 / mu + (i < 3 ? swell : zero)) : state[i];
        stress[i] = yields ? stress[i] - away - (i < 3 ? drop : zero) : stress[i];
      }
      state[6] = yields ? state[6] + slip : state[6];
    }
    return yields;
  }
};

}  // namespace cdem
