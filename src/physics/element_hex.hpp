// The 8-node hexahedron with 2x2x2 Gauss points, factored: a column of the Jacobian does not depend on its own
// coordinate, and the trilinear modes of a field are sums of its corners with signs +-1. Nothing is scaled until the end:
// columns are 8 times, cofactors 64 times and determinants 512 times their size.
#pragma once
#include "physics/form.hpp"

namespace cdem {

struct HexFull : FormDefaults {
  static constexpr const char *kName = "full";
  static constexpr Shape kShape = Shape::kHex;
  static constexpr int kCorners = 8;
  static constexpr int kPoints = 8;
  static constexpr double kGauss = 0.57735026918962576451;

  // modes: xi, eta, zeta, xi eta, eta zeta, xi zeta, xi eta zeta
  template <class T>
  static CDEM_HD void Modes(const T q[8][3], int k, T m[7][3]) {
    T s01 = q[0][k] + q[1][k], d01 = q[1][k] - q[0][k], s32 = q[3][k] + q[2][k], d32 = q[2][k] - q[3][k];
    T s45 = q[4][k] + q[5][k], d45 = q[5][k] - q[4][k], s76 = q[7][k] + q[6][k], d76 = q[6][k] - q[7][k];
    T sb = s01 + s32, eb = s32 - s01, db = d01 + d32, xb = d32 - d01;
    T st = s45 + s76, et = s76 - s45, dt = d45 + d76, xt = d76 - d45;
    m[0][k] = db + dt;
    m[1][k] = eb + et;
    m[2][k] = st - sb;
    m[3][k] = xb + xt;
    m[4][k] = et - eb;
    m[5][k] = dt - db;
    m[6][k] = xt - xb;
  }
  // f[corner] = scale * sum over modes of sign(corner, mode) m[mode]
  template <class T>
  static CDEM_HD void FromModes(const T m[7][3], int k, double scale, T f[8][3]) {
    T zb = m[2][k] * scale;
    T ab = (m[0][k] - m[5][k]) * scale, at = (m[0][k] + m[5][k]) * scale;
    T bb = (m[1][k] - m[4][k]) * scale, bt = (m[1][k] + m[4][k]) * scale;
    T cb = (m[3][k] - m[6][k]) * scale, ct = (m[3][k] + m[6][k]) * scale;
    T pb = ab + bb, mb = ab - bb, pt = at + bt, mt = at - bt;
    f[0][k] = (cb - pb) - zb;
    f[1][k] = (mb - cb) - zb;
    f[2][k] = (pb + cb) - zb;
    f[3][k] = -(mb + cb) - zb;
    f[4][k] = (ct - pt) + zb;
    f[5][k] = (mt - ct) + zb;
    f[6][k] = (pt + ct) + zb;
    f[7][k] = zb - (mt + ct);
  }
  // column c at the four points of the two other coordinates (first, second): [0] --, [1] +-, [2] -+, [3] ++
  template <class T>
  static CDEM_HD void Columns(const T m[7][3], int own, int with_first, int with_second, T c[4][3]) {
    CDEM_UNROLL for (int k = 0; k < 3; ++k) {
      T lo = m[own][k] - kGauss * m[with_second][k], hi = m[own][k] + kGauss * m[with_second][k];
      T dlo = kGauss * m[with_first][k] - (kGauss * kGauss) * m[6][k];
      T dhi = kGauss * m[with_first][k] + (kGauss * kGauss) * m[6][k];
      c[0][k] = lo - dlo;
      c[1][k] = lo + dlo;
      c[2][k] = hi - dhi;
      c[3][k] = hi + dhi;
    }
  }
  // the transpose of Columns, adding to the modes
  template <class T>
  static CDEM_HD void ColumnsBack(const T c[4][3], int own, int with_first, int with_second, T m[7][3]) {
    CDEM_UNROLL for (int k = 0; k < 3; ++k) {
      T slo = c[0][k] + c[1][k], dlo = c[1][k] - c[0][k], shi = c[2][k] + c[3][k], dhi = c[3][k] - c[2][k];
      m[own][k] += slo + shi;
      m[with_second][k] += kGauss * (shi - slo);
      m[with_first][k] += kGauss * (dlo + dhi);
      m[6][k] += (kGauss * kGauss) * (dhi - dlo);
    }
  }

  /// Internal forces f [8][3] [N] of displacements u [8][3] [m] at corners x [8][3] [m]. point(strain, volume, stress)
  /// gives the stress of each Gauss point; volume is its share of the element's [m^3].
  template <class T, class Point>
  static CDEM_HD void Forces(const T x[8][3], const T u[8][3], const Point &point, T f[8][3]) {
    T jx[4][3], je[4][3], jz[4][3], ux[4][3], ue[4][3], uz[4][3];
    {
      T m[7][3];
      CDEM_UNROLL for (int k = 0; k < 3; ++k) Modes(x, k, m);
      Columns(m, 0, 3, 5, jx);  // d/dxi at (eta, zeta)
      Columns(m, 1, 3, 4, je);  // d/deta at (xi, zeta)
      Columns(m, 2, 5, 4, jz);  // d/dzeta at (xi, eta)
    }
    {
      T m[7][3];
      CDEM_UNROLL for (int k = 0; k < 3; ++k) Modes(u, k, m);
      Columns(m, 0, 3, 5, ux);
      Columns(m, 1, 3, 4, ue);
      Columns(m, 2, 5, 4, uz);
    }
    T px[4][3] = {}, pe[4][3] = {}, pz[4][3] = {};
    CDEM_UNROLL for (int g = 0; g < 8; ++g) {
      const int xi = g & 1, eta = (g >> 1) & 1, zeta = g >> 2;
      const int a = eta + 2 * zeta, b = xi + 2 * zeta, c = xi + 2 * eta;
      T ca[3], cb[3], cc[3], strain[6], stress[6];
      Cross(je[b], jz[c], ca);
      Cross(jz[c], jx[a], cb);
      Cross(jx[a], je[b], cc);
      T det = Dot(jx[a], ca);
      StrainOf(ux[a], ue[b], uz[c], ca, cb, cc, 1.0 / det, strain);
      point(g, strain, det * (1.0 / 512.0), stress);
      ApplyAdd(stress, ca, px[a]);
      ApplyAdd(stress, cb, pe[b]);
      ApplyAdd(stress, cc, pz[c]);
    }
    T m[7][3] = {};
    ColumnsBack(px, 0, 3, 5, m);
    ColumnsBack(pe, 1, 3, 4, m);
    ColumnsBack(pz, 2, 5, 4, m);
    CDEM_UNROLL for (int k = 0; k < 3; ++k) FromModes(m, k, 1.0 / 512.0, f);
  }
};

}  // namespace cdem
