// Softening springs: linear up to the strength, then falling in a straight line, so that breaking takes G_I per area in
// tension and G_II in shear. One damage D, from 0 to 1, for both: tension unloads to the origin, shear elastically.
#pragma once
#include "physics/joint_strength.hpp"
#include "physics/spring.hpp"

#include <cstdio>

namespace cdem {

template <bool kDilates>
struct SofteningLaw : StrengthLawDefaults {
  static constexpr const char *kName = "softening";
  enum { kOpeningEnd = kStrengthParams, kSlipEnd, kFrozen, kPlainParams };  ///< delta_f and s_f [m]; 1: no more damage
  enum { kTanPsi = kPlainParams, kDilationSlip, kDilatingParams };          ///< -, m
  static constexpr int kParams = kDilates ? kDilatingParams : kPlainParams;

  /// History: slip s [3], damage D, length of the slip's path; with dilation the opening g that it made [m].
  enum { kSlip = 0, kDamage = 3, kPath = 4, kGap = 5 };
  static constexpr int kState = kDilates ? 6 : 5;

  enum { kGI = kStrengthDilationSlip + 1, kGII };
  static constexpr std::array<Property, 7> kProperties = {
      {StrengthProperty(kStrengthTension, "Pa", kPropertyInf, kPropertyOpen, "tensile strength"),
       StrengthProperty(kStrengthCohesion, "Pa", kPropertyInf, kPropertyOpen, "cohesion"),
       kJointFriction,
       kDilationProperties[0],
       kDilationProperties[1],
       {"gi", "J/m^2", 0, kPropertyInf, kPropertyOpen, "fracture energy in tension"},
       {"gii", "J/m^2", 0, kPropertyInf, kPropertyOpen, "fracture energy in shear, above friction"}}};
  static bool Serves(const double *property) { return (property[kStrengthDilation] > 0) == kDilates; }

  static void Derive(const double *property, double *param) {
    DeriveStrength(property, param);
    param[kOpeningEnd] = 2 * property[kGI] / param[kTension];
    param[kSlipEnd] = 2 * property[kGII] / param[kCohesion];
    param[kFrozen] = 0;
    if (kDilates) DeriveDilation(property, &param[kTanPsi], &param[kDilationSlip]);
  }

  /// The fall must be longer than the rise: delta_f > sigma_t / k_n and s_f > c / k_s.
  static std::string CheckFace(const double *property, double kn, double ks) {
    const struct {
      const char *what, *energy;
      double strength, g, k;
    } sides[] = {{"tension", "gi", property[kStrengthTension], property[kGI], kn},
                 {"cohesion", "gii", property[kStrengthCohesion], property[kGII], ks}};
    for (const auto &side : sides) {
      const double most = std::sqrt(2 * side.g * side.k);
      if (side.strength < most) continue;
      char text[400];
      std::snprintf(text, sizeof text,
                    "%s %g Pa is too much for %s %g J/m^2 on springs of %g Pa/m: reaching it takes more energy than "
                    "breaking. The largest usable %s there is just below %g Pa; or give more %s, or stiffer springs",
                    side.what, side.strength, side.energy, side.g, side.k, side.what, most, side.energy);
      return text;
    }
    return {};
  }

  /// A fifth of the length of the process zone, l_ch = E G_I / sigma_t^2.
  static double LargestCell(const double *property, double young) {
    return young * property[kGI] / (property[kStrengthTension] * property[kStrengthTension]) / 5;
  }

  /// Energy stored: unloading goes to the origin in tension and along K_n, K_s otherwise.
  template <class T>
  static CDEM_HD T Energy(const Spring<T> &s, const T force[3]) {
    T along = Dot(s.normal, force), opening = Dot(s.normal, s.d);
    if constexpr (kDilates) opening = opening - s.history[kGap];
    T shear2 = Dot(force, force) - along * along;
    return 0.5 * (shear2 / s.ks - along * opening);
  }

  static constexpr bool kCarriesOffset = kDilates;
  static constexpr bool kSoftens = true;  ///< damaged springs are softer in tension
  /// The tensile strength shapes the unloading of damaged springs: it stays, and their damage does.
  static void MakeIntact(double *param) {
    param[kFrozen] = 1;
    param[kCohesion] = kUnreached;
  }

  template <class T>
  struct Normal {
    T tension, cohesion;      ///< T = sigma_t A, C = c A [N]
    T first, range;           ///< delta_0 and delta_f - delta_0 [m]
    T opening, damage;        ///< d_n - g [m], D
    T stiffness, pressing;    ///< in the present unloading [N/m]; F_n, positive in compression [N]
    MaskOf<T> pulled, grows;  ///< grows: D does, by the opening

    /// Stiffness and force for the present opening and damage.
    CDEM_HD void Carry(T kn) {
      const T zero = T{};
      stiffness = (pulled & (damage > zero)) ? (1.0 - damage) * tension / (first + damage * range) : kn;
      pressing = (pulled & (damage >= zero + 1.0)) ? zero : -(stiffness * opening);
    }
  };

  /// Force on node b [N].
  template <bool kBeta, class T>
  static CDEM_HD Outcome<T> Force(Spring<T> &s, T force[3]) {
    const T zero = T{}, one = zero + 1.0;
    const T tan_phi = s.param[kTanPhi];
    T along = Dot(s.normal, s.d);
    Normal<T> n;
    n.tension = s.param[kTension] * s.area;
    n.cohesion = s.param[kCohesion] * s.area;
    n.opening = along;
    if constexpr (kDilates) n.opening = along - s.history[kGap];
    n.damage = Larger(s.history[kDamage], s.cohesion_lost);
    n.stiffness = s.kn;
    n.pressing = -(s.kn * n.opening);
    n.pulled = n.opening > zero;
    n.grows = zero > zero;
    n.first = n.range = zero;
    if (Any(n.pulled)) {
      n.first = n.tension / s.kn;
      n.range = s.param[kOpeningEnd] - n.first;
      T now = Smaller((n.opening - n.first) / n.range, one);
      n.grows = n.pulled & (now > n.damage) & !(s.param[kFrozen] > zero);
      n.damage = n.grows ? now : n.damage;
      n.Carry(s.kn);
    }
    T shear[3];
    CDEM_UNROLL for (int k = 0; k < 3; ++k) shear[k] = -(s.ks * (s.d[k] - along * s.normal[k] - s.history[kSlip + k]));
    T shear2 = Dot(shear, shear);
    T cap = Larger(n.pressing * tan_phi + (1.0 - n.damage) * n.cohesion, zero);
    Outcome<T> out;
    out.open = n.pulled & (n.damage >= one);
    out.slides = (shear2 > cap * cap) & !out.open;
    if (Any(out.slides)) {
      T size = Sqrt(shear2);
      cap = Slide(s, size, cap, out.slides, &n);
      T scale = cap / (size > zero ? size : size + 1.0);
      CDEM_UNROLL for (int k = 0; k < 3; ++k) shear[k] = out.slides ? shear[k] * scale : shear[k];
      out.open = n.pulled & (n.damage >= one);
      out.slides = out.slides & !out.open;
    }
    if (Any(out.open)) {
      CDEM_UNROLL for (int k = 0; k < 3; ++k) shear[k] = out.open ? zero : shear[k];
    }
    if (Any(out.open | out.slides)) {
      CDEM_UNROLL for (int k = 0; k < 3; ++k) {
        T moved = s.d[k] - along * s.normal[k] + shear[k] / s.ks;
        s.history[kSlip + k] = (out.open | out.slides) ? moved : s.history[kSlip + k];
      }
    }
    out.changed = n.grows | out.open | out.slides;
    out.tension_lost = out.cohesion_lost = n.damage >= one;
    s.history[kDamage] = out.changed ? n.damage : s.history[kDamage];
    if (kBeta) {
      // Viscous part beta K d' with the stiffness of the present unloading: none while open, no shear part while
      // sliding, and a broken spring never pulls through it.
      T rate = Dot(s.normal, s.beta_rate);
      T total = n.pressing - n.stiffness * rate;
      total = (out.tension_lost & (total < zero)) ? zero : total;
      CDEM_UNROLL for (int k = 0; k < 3; ++k) {
        T viscous = s.ks * (s.beta_rate[k] - rate * s.normal[k]);
        shear[k] = (out.open | out.slides) ? shear[k] : shear[k] - viscous;
      }
      n.pressing = out.open ? zero : total;
    }
    CDEM_UNROLL for (int k = 0; k < 3; ++k) force[k] = n.pressing * s.normal[k] + shear[k];
    return out;
  }

  /// For the energy audit, as in BrittleLaw: here it is the damage that says what holds.
  template <class T>
  static CDEM_HD T NormalStiffness(const Spring<T> &s, const T *history, T opening, MaskOf<T>) {
    const T zero = T{}, damage = history[kDamage];
    const T first = s.param[kTension] * s.area / s.kn, range = s.param[kOpeningEnd] - first;
    const T secant = (1.0 - damage) * s.param[kTension] * s.area / (first + damage * range);
    return ((opening > zero) & (damage > zero)) ? (damage < zero + 1.0 ? secant : zero) : s.kn;
  }

  /// Slip that brings the shear force from its trial size to the cap, which changes on the way: with the damage D = max(D,
  /// path / s_f), and with dilation, where the crack is pressed. Returns that cap. The balance
  ///   size - K_s l - cap(l)
  /// falls with the length l (s_f > c / k_s) and is straight between three corners: before (from there on the slip
  /// drives D), whole (D = 1) and rest (the end of the dilation). Its sign at a corner says on which side the root lies.
  template <class T>
  static CDEM_HD T Slide(Spring<T> &s, T size, T cap, MaskOf<T> slides, Normal<T> *n) {
    const T zero = T{}, one = zero + 1.0;
    const T tan_phi = s.param[kTanPhi], end = s.param[kSlipEnd], path = s.history[kPath];
    T fall = n->cohesion / end, friction = Larger(n->pressing * tan_phi, zero);
    T before = Larger(n->damage * end - path, zero), whole = end - path;
    T length, grip = zero, rest = zero;
    if constexpr (kDilates) {
      grip = n->pulled ? zero : s.kn * tan_phi * s.param[kTanPsi];
      rest = Larger(s.param[kDilationSlip] - path, zero);
    }
    MaskOf<T> drives = size - s.ks * before - grip * Smaller(before, rest) > cap;
    MaskOf<T> breaks = (size - s.ks * whole - grip * Smaller(whole, rest) > friction) & drives;
    breaks = breaks | (n->damage >= one);
    drives = drives & !breaks;
    T start = drives ? before : zero, base = breaks ? friction : cap, stiffness = s.ks - (drives ? fall : zero);
    if constexpr (kDilates) {
      T at_rest = Larger(Smaller((path + rest) / end, one), n->damage);
      MaskOf<T> spent = size - (s.ks + grip) * rest > friction + (1.0 - at_rest) * n->cohesion;
      stiffness = stiffness + (spent ? zero : grip);
      length = start + (size - base - s.ks * start - grip * (spent ? rest : start)) / stiffness;
    } else {
      length = start + (size - base - s.ks * start) / stiffness;
    }
    T damage = breaks ? one : drives ? (path + length) / end : n->damage;
    MaskOf<T> coupled = slides & drives & n->pulled & (tan_phi > zero);
    if (Any(coupled)) {
      const T root = PulledRoot(s, size, *n);
      length = coupled ? root * end - path : length;
      damage = coupled ? root : damage;
    }
    damage = Smaller(Larger(damage, n->damage), one);
    n->damage = slides ? damage : n->damage;
    s.history[kPath] = slides ? path + length : path;
    if (Any(n->pulled)) n->Carry(s.kn);
    if constexpr (kDilates) {
      T rides = (slides & !n->pulled) ? Smaller(length, rest) * s.param[kTanPsi] : zero;
      s.history[kGap] = s.history[kGap] + rides;
      n->opening = n->opening - rides;
      n->pressing = n->pressing + s.kn * rides;
    }
    return Larger(n->pressing * tan_phi + (1.0 - n->damage) * n->cohesion, zero);
  }

  /// Damage at which a spring that slips under tension is in balance: its tension falls with D too, so that
  ///   size - K_s (s_f D - path) = (1 - D) (C - T tan(phi) delta / (delta_0 + D (delta_f - delta_0))),
  /// a quadratic equation in D of which the larger root is the one.
  template <class T>
  static CDEM_HD T PulledRoot(const Spring<T> &s, T size, const Normal<T> &n) {
    T constant = size + s.ks * s.history[kPath] - n.cohesion, slope = n.cohesion - s.ks * s.param[kSlipEnd];
    T weight = n.tension * s.param[kTanPhi] * n.opening;
    T a = slope * n.range, b = constant * n.range + slope * n.first - weight, c = constant * n.first + weight;
    T root = Sqrt(Larger(b * b - 4.0 * a * c, T{}));
    return b < T{} ? 2.0 * c / (root - b) : (b + root) / (-2.0 * a);  // neither of them cancels
  }
};

using JointSoftening = SofteningLaw<false>;
using JointSofteningDilating = SofteningLaw<true>;

}  // namespace cdem
