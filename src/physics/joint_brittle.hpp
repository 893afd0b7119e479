// Brittle springs (Eq. 3 of the method's paper): linear until the tensile strength or Mohr-Coulomb's cap is reached, then
// an open or rubbing crack that carries again when it closes. A crack that dilates rides up as it slips.
#pragma once
#include "physics/joint_strength.hpp"
#include "physics/spring.hpp"

namespace cdem {

template <bool kDilates>
struct BrittleLaw : StrengthLawDefaults {
  static constexpr const char *kName = "brittle";
  enum { kKeepTension = kStrengthParams, kPlainParams };            ///< 0 or 1
  enum { kTanPsi = kPlainParams, kDilationSlip, kDilatingParams };  ///< -, m
  static constexpr int kParams = kDilates ? kDilatingParams : kPlainParams;
  static constexpr bool kMayKeepTension = true;
  static constexpr bool kCarriesOffset = kDilates;
  static constexpr bool kSoftens = false;  ///< damaged springs are softer in tension

  /// History: slip s [3], zero while intact; with dilation the opening g that it made, and the length of its path [m].
  enum { kSlip = 0, kGap = 3, kPath = 4 };
  static constexpr int kState = kDilates ? 5 : 3;

  static constexpr std::array<Property, 5> kProperties = {
      {StrengthProperty(kStrengthTension, "Pa", kPropertyInf, kPropertyClosed, "tensile strength"),
       StrengthProperty(kStrengthCohesion, "Pa", kPropertyInf, kPropertyClosed, "cohesion"), kJointFriction,
       kDilationProperties[0], kDilationProperties[1]}};
  static bool Serves(const double *property) { return (property[kStrengthDilation] > 0) == kDilates; }

  static void Derive(const double *property, double *param) {
    DeriveStrength(property, param);
    param[kKeepTension] = 0;
    if (kDilates) DeriveDilation(property, &param[kTanPsi], &param[kDilationSlip]);
  }

  /// Force on node b [N]; the slip follows an opening or sliding crack (theory: s = d_s + F_s / K_s).
  template <bool kBeta, class T>
  static CDEM_HD Outcome<T> Force(Spring<T> &s, T force[3]) {
    const T zero = T{};
    const T *normal = s.normal, *d = s.d;
    const T kn = s.kn, ks = s.ks, tan_phi = s.param[kTanPhi];
    T *slip = s.history + kSlip;
    T tension = s.param[kTension] * s.area * (1.0 - s.tension_lost);  // what is left of T and C [N]
    T cohesion = s.param[kCohesion] * s.area * (1.0 - s.cohesion_lost);
    T along = Dot(normal, d), opening = along;
    if constexpr (kDilates) opening = along - s.history[kGap];
    T pressing = -(kn * opening);  // F_n, positive in compression
    T shear[3];
    CDEM_UNROLL for (int k = 0; k < 3; ++k) shear[k] = -(ks * (d[k] - along * normal[k] - slip[k]));
    T shear2 = Dot(shear, shear);
    T cap = pressing * tan_phi + cohesion;
    cap = cap > zero ? cap : zero;
    Outcome<T> out;
    // A spring that no force presses or pulls stays as it is, whatever its strength.
    out.open = (-pressing >= tension) & (opening > zero);
    out.slides = (shear2 > cap * cap) & !out.open;
    if (Any(out.slides)) {
      T size = Sqrt(shear2);
      if constexpr (kDilates) cap = Ride(s, size, cohesion, out.slides, &pressing);
      T scale = cap / (size > zero ? size : size + 1.0);
      CDEM_UNROLL for (int k = 0; k < 3; ++k) shear[k] = out.slides ? shear[k] * scale : shear[k];
    }
    if (Any(out.open)) {
      pressing = out.open ? zero : pressing;
      CDEM_UNROLL for (int k = 0; k < 3; ++k) shear[k] = out.open ? zero : shear[k];
    }
    if (Any(out.open | out.slides)) {
      CDEM_UNROLL for (int k = 0; k < 3; ++k) {
        T moved = d[k] - along * normal[k] + shear[k] / ks;
        slip[k] = (out.open | out.slides) ? moved : slip[k];
      }
    }
    if (kBeta) {
      // Viscous part beta K d': none while open, no shear part while sliding, and a crack never pulls through it.
      T rate = Dot(normal, s.beta_rate);
      T total = pressing - kn * rate;
      MaskOf<T> cracked = tension <= zero;
      total = (cracked & (total < zero)) ? zero : total;
      CDEM_UNROLL for (int k = 0; k < 3; ++k) {
        T viscous = ks * (s.beta_rate[k] - rate * normal[k]);
        shear[k] = (out.open | out.slides) ? shear[k] : shear[k] - viscous;
      }
      pressing = out.open ? zero : total;
    }
    CDEM_UNROLL for (int k = 0; k < 3; ++k) force[k] = pressing * normal[k] + shear[k];
    out.changed = out.cohesion_lost = out.open | out.slides;
    out.tension_lost = out.open | (out.slides & !(s.param[kKeepTension] > zero));
    return out;
  }

  /// For the energy audit: the normal stiffness [N/m] of a spring whose history is this one, at an opening [m], as long
  /// as nothing new happens to it. [in] lax: nothing holds it together, it carries pressure alone.
  template <class T>
  static CDEM_HD T NormalStiffness(const Spring<T> &s, const T *, T opening, MaskOf<T> lax) {
    return (lax & (opening > T{})) ? T{} : s.kn;
  }

  /// Slip with dilation: of the length that brings the shear force from its trial size to the cap, which grows on the
  /// way as the crack rides up. Returns that cap. The balance falls with the length and is straight but for the end of
  /// the dilation (spent) and for a cap of 0 (the longest slip there can be): so each is told by its sign there.
  template <class T>
  static CDEM_HD T Ride(Spring<T> &s, T size, T cohesion, MaskOf<T> slides, T *pressing) {
    const T zero = T{}, tan_phi = s.param[kTanPhi], push = s.kn * s.param[kTanPsi];
    T grip = push * tan_phi, rest = Larger(s.param[kDilationSlip] - s.history[kPath], zero);
    T excess = size - (*pressing * tan_phi + cohesion);
    MaskOf<T> spent = excess > (s.ks + grip) * rest;
    T length = (excess - (spent ? grip * rest : zero)) / (s.ks + (spent ? zero : grip));
    length = Smaller(length, size / s.ks);
    length = slides ? length : zero;
    T rides = Smaller(length, rest);
    *pressing = *pressing + push * rides;
    s.history[kGap] = s.history[kGap] + s.param[kTanPsi] * rides;
    s.history[kPath] = s.history[kPath] + length;
    return Larger(*pressing * tan_phi + cohesion, zero);
  }
};

using JointBrittle = BrittleLaw<false>;
using JointBrittleDilating = BrittleLaw<true>;

}  // namespace cdem
