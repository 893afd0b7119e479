// Discrete springs: at each corner of a hexahedron the three edges make an elastic stress, and each of the three faces
// there may break. A broken face carries no tension, and shear up to friction.
#pragma once
#include "core/lanes.hpp"
#include "physics/block_elastic.hpp"

#include <cmath>

namespace cdem {

struct SpringBlock : BlockLawDefaults {
  static constexpr const char *kName = "spring";
  static constexpr bool kAtCorners = true;
  static constexpr int kState = 1;  ///< broken faces of the corner: 1, 2, 4, added up
  enum { kLambda, kMu, kTension, kCohesion, kTanPhi, kTanResidual, kParams };

  static constexpr std::array<Property, 6> kProperties = {
      {Elastic::kProperties[0],
       Elastic::kProperties[1],
       {"tension", "Pa", 0, kPropertyInf, kPropertyClosed, "tensile strength"},
       {"cohesion", "Pa", 0, kPropertyInf, kPropertyClosed, "cohesion"},
       {"friction", "degrees", 0, 89.9, kPropertyClosed, "angle of friction"},
       {"residual_friction", "degrees", 0, 89.9, kPropertyClosed, "angle of friction that is left in the end",
        kPropertyInf, "", "that of friction"}}};

  static void Derive(const double *property, double size, double *param) {
    const double degree = 3.14159265358979323846 / 180;
    Elastic::Derive(property, size, param);
    param[kTension] = property[2];
    param[kCohesion] = property[3];
    param[kTanPhi] = std::tan(property[4] * degree);
    param[kTanResidual] = std::isinf(property[5]) ? param[kTanPhi] : std::tan(property[5] * degree);
  }

  static void MakeIntact(double *param) { param[kTension] = param[kCohesion] = kUnreached; }

  /// Stress [Pa] of a strain (true shears) at a corner. [in] area: vectors along the normals of its three faces, of any
  /// length. [in,out] state: its broken faces. Returns whether another one broke.
  template <class T>
  static CDEM_HD MaskOf<T> Stress(const T *param, const T strain[6], const T area[3][3], T state[kState], T stress[6]) {
    Elastic::Stress(param, strain, stress);
    return Judge(param, area, state, stress);
  }

 protected:
  /// Takes an elastic stress to what the corner can carry; the mask of those where another face broke.
  template <class T>
  static CDEM_HD MaskOf<T> Judge(const T *param, const T area[3][3], T state[1], T stress[6]) {
    const MaskOf<T> fails = (state[0] > T{}) | Breaks(param, stress, area[0]) | Breaks(param, stress, area[1]) |
                            Breaks(param, stress, area[2]);
    if (!Any(fails)) return fails;
    return Fail(param, area, fails, state, stress);
  }

 private:
  /// Corners of which something is broken, or breaks. [in,out] stress: elastic at first. Returns where something broke.
  template <class T>
  static CDEM_HD_CALL MaskOf<T> Fail(const T *param, const T area[3][3], MaskOf<T> fails, T state[1], T stress[6]) {
    T released[6], code = state[0];
    const T none{};
    MaskOf<T> broken[3], fresh = code < none;
    CDEM_UNROLL for (int i = 2; i >= 0; --i) {
      const double bit = i == 2 ? 4 : i == 1 ? 2 : 1;
      broken[i] = code >= bit;
      code = broken[i] ? code - bit : code;
    }
    CDEM_UNROLL for (int i = 0; i < 6; ++i) released[i] = stress[i];
    Release(param, area, broken, released);
    // what is broken has let go when the others are judged
    CDEM_UNROLL for (int i = 0; i < 3; ++i) {
      const MaskOf<T> breaks = Breaks(param, released, area[i]) & !broken[i];
      fresh = fresh | breaks;
      broken[i] = broken[i] | breaks;
    }
    if (Any(fresh)) {
      CDEM_UNROLL for (int i = 0; i < 6; ++i) released[i] = stress[i];
      Release(param, area, broken, released);
      state[0] = (broken[0] ? none + 1.0 : none) + (broken[1] ? none + 2.0 : none) + (broken[2] ? none + 4.0 : none);
    }
    CDEM_UNROLL for (int i = 0; i < 6; ++i) stress[i] = fails ? released[i] : stress[i];
    return fresh;
  }

  /// N >= sigma_t, or S >= c - N tan(phi), with N and S times the square of the area: no root, no division. A face that
  /// nothing pulls or shears is left as it is.
  template <class T>
  static CDEM_HD MaskOf<T> Breaks(const T *param, const T stress[6], const T area[3]) {
    const T zero{};
    T t[3], shear{};
    Apply(stress, area, t);
    T square = Dot(area, area), normal = Dot(area, t);
    CDEM_UNROLL for (int k = 0; k < 3; ++k) {
      T s = square * t[k] - normal * area[k];
      shear += s * s;
    }
    T cap = param[kCohesion] * square - normal * param[kTanPhi];
    const MaskOf<T> tension = (normal >= param[kTension] * square) & (normal > zero);
    const MaskOf<T> slides = ((shear >= square * cap * cap) | (cap < zero)) & (shear > zero);
    return tension | slides;
  }

  /// Takes off what broken faces cannot carry, one after the other: with dt the change of a face's traction,
  /// sigma += n dt^T + dt n^T - (n.dt) n n^T.
  template <class T>
  static CDEM_HD void Release(const T *param, const T area[3][3], const MaskOf<T> broken[3], T stress[6]) {
    const T zero{};
    CDEM_UNROLL for (int i = 0; i < 3; ++i) {
      T length = 1.0 / Sqrt(Dot(area[i], area[i])), n[3], t[3], shear[3], dt[3];
      CDEM_UNROLL for (int k = 0; k < 3; ++k) n[k] = area[i][k] * length;
      Apply(stress, n, t);
      T normal = Dot(n, t);
      CDEM_UNROLL for (int k = 0; k < 3; ++k) shear[k] = t[k] - normal * n[k];
      T size = Sqrt(Dot(shear, shear)), carried = normal < zero ? normal : zero;
      T cap = -carried * param[kTanResidual];
      T factor = size > cap ? cap / size : zero + 1.0;
      CDEM_UNROLL for (int k = 0; k < 3; ++k) {
        T change = (carried - normal) * n[k] + (factor - 1.0) * shear[k];
        dt[k] = broken[i] ? change : zero;
      }
      T along = Dot(n, dt);
      stress[kXX] += (2.0 * dt[0] - along * n[0]) * n[0];
      stress[kYY] += (2.0 * dt[1] - along * n[1]) * n[1];
      stress[kZZ] += (2.0 * dt[2] - along * n[2]) * n[2];
      stress[kXY] += n[0] * dt[1] + n[1] * dt[0] - along * n[0] * n[1];
      stress[kYZ] += n[1] * dt[2] + n[2] * dt[1] - along * n[1] * n[2];
      stress[kXZ] += n[0] * dt[2] + n[2] * dt[0] - along * n[0] * n[2];
    }
  }
};

/// Discrete springs that carry an offset: their strain is measured from it. Since they all have a history from the start, an
/// element of which something is broken says so by itself.
struct SpringBlockOffset : SpringBlock {
  static constexpr bool kCarriesOffset = true;
  static constexpr int kState = 7;  ///< the offset; broken faces of the corner
  template <class T>
  static CDEM_HD MaskOf<T> Stress(const T *param, const T strain[6], const T area[3][3], T state[kState], T stress[6]) {
    T e[6];
    CDEM_UNROLL for (int i = 0; i < 6; ++i) e[i] = strain[i] - state[i];
    Elastic::Stress(param, e, stress);
    return Judge(param, area, state + 6, stress);
  }
};

}  // namespace cdem
