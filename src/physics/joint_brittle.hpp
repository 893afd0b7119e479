// Brittle springs (Eq. 3 of the method's paper): linear until the tensile strength or Mohr-Coulomb's cap is reached, then
// an open or rubbing crack that carries again when it closes.
#pragma once
#include "core/lanes.hpp"
#include "physics/law.hpp"

namespace cdem {

/// Bits of a spring's state, in history laws.
enum SpringState { kTensionLost = 1, kCohesionLost = 2, kSliding = 4, kOpen = 8 };

struct JointBrittle : JointLawDefaults {
  static constexpr const char *kName = "brittle";
  enum { kTension, kCohesion, kTanPhi, kKeepTension, kParams };  ///< Pa, Pa, -, 0 or 1

  /// Strengths of one interface; tension above cohesion / tan(phi) has been cut to it at set-up.
  static constexpr std::array<Property, 3> kProperties = {
      {{"tension", "Pa", 0, kPropertyInf, kPropertyClosed, "tensile strength"},
       {"cohesion", "Pa", 0, kPropertyInf, kPropertyClosed, "cohesion"},
       {"friction", "degrees", 0, 89.9, kPropertyClosed, "angle of friction"}}};

  static void Derive(const double *property, double *param) {
    const double degree = 3.14159265358979323846 / 180;
    param[kTension] = property[0];
    param[kCohesion] = property[1];
    param[kTanPhi] = std::tan(property[2] * degree);
    param[kKeepTension] = 0;
  }

  /// What a spring does in one evaluation: where the trial force left the elastic range.
  template <class T>
  struct Outcome {
    MaskOf<T> open, slides;
  };

  /// Force on node b [N] for the relative displacement d = u_b - u_a and its rate (beta damping; zero without).
  /// [in] tension, cohesion: what is left of T = sigma_t A and C = c A [N]; slip: s [m], zero while intact.
  /// [in,out] slip: follows an opening or sliding crack (theory: s = d_s + F_s / K_s).
  template <bool kBeta, class T>
  static CDEM_HD Outcome<T> Force(const T normal[3], T kn, T ks, T tension, T cohesion, T tan_phi, const T d[3],
                                  const T beta_rate[3], T slip[3], T force[3]) {
    const T zero = T{};
    T along = Dot(normal, d);
    T pressing = -(kn * along);  // F_n, positive in compression
    T shear[3];
    CDEM_UNROLL for (int k = 0; k < 3; ++k) shear[k] = -(ks * (d[k] - along * normal[k] - slip[k]));
    T shear2 = Dot(shear, shear);
    T cap = pressing * tan_phi + cohesion;
    cap = cap > zero ? cap : zero;
    Outcome<T> out;
    // A spring that no force presses or pulls stays as it is, whatever its strength.
    out.open = (-pressing >= tension) & (along > zero);
    out.slides = (shear2 > cap * cap) & !out.open;
    if (Any(out.slides)) {
      T size = Sqrt(shear2);
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
      T rate = Dot(normal, beta_rate);
      T total = pressing - kn * rate;
      MaskOf<T> cracked = tension <= zero;
      total = (cracked & (total < zero)) ? zero : total;
      CDEM_UNROLL for (int k = 0; k < 3; ++k) {
        T viscous = ks * (beta_rate[k] - rate * normal[k]);
        shear[k] = (out.open | out.slides) ? shear[k] : shear[k] - viscous;
      }
      pressing = out.open ? zero : total;
    }
    CDEM_UNROLL for (int k = 0; k < 3; ++k) force[k] = pressing * normal[k] + shear[k];
    return out;
  }
};

}  // namespace cdem
