// The 6-node wedge with 3 x 2 Gauss points: three points in the triangle, two along the axis.
#pragma once
#include "physics/form.hpp"

namespace cdem {

struct WedgeFull : FormDefaults {
  static constexpr const char *kName = "full";
  static constexpr Shape kShape = Shape::kWedge;
  static constexpr int kCorners = 6;
  static constexpr int kPoints = 6;
  static constexpr double kGauss = 0.57735026918962576451;

  /// Weights of the point g: of the triangles and of the axial edges.
  struct Weights {
    double bottom, top, l0, l1, l2;
    CDEM_HD explicit Weights(int g) {
      // barycentric coordinates of the point are (2/3, 1/6, 1/6) and its turns
      const double zeta = g < 3 ? -kGauss : kGauss;
      l1 = g % 3 == 1 ? 2.0 / 3.0 : 1.0 / 6.0;
      l2 = g % 3 == 2 ? 2.0 / 3.0 : 1.0 / 6.0;
      l0 = 1 - l1 - l2;
      bottom = 0.5 * (1 - zeta);
      top = 0.5 * (1 + zeta);
    }
  };
  /// Derivatives of a field q of the corners by the three coordinates.
  template <class T>
  static CDEM_HD void Columns(const Weights &w, const T q[6][3], T c[3][3]) {
    CDEM_UNROLL for (int k = 0; k < 3; ++k) {
      c[0][k] = w.bottom * (q[1][k] - q[0][k]) + w.top * (q[4][k] - q[3][k]);
      c[1][k] = w.bottom * (q[2][k] - q[0][k]) + w.top * (q[5][k] - q[3][k]);
      c[2][k] = 0.5 * (w.l0 * (q[3][k] - q[0][k]) + w.l1 * (q[4][k] - q[1][k]) + w.l2 * (q[5][k] - q[2][k]));
    }
  }
  /// The transpose of Columns, times a point's share of the reference volume, added to f.
  template <class T>
  static CDEM_HD void ColumnsBack(const Weights &w, const T p[3][3], T f[6][3]) {
    CDEM_UNROLL for (int k = 0; k < 3; ++k) {
      T in_plane = p[0][k] + p[1][k], axial = 0.5 * p[2][k];
      f[0][k] -= (w.bottom * in_plane + w.l0 * axial) * (1.0 / 6.0);
      f[1][k] += (w.bottom * p[0][k] - w.l1 * axial) * (1.0 / 6.0);
      f[2][k] += (w.bottom * p[1][k] - w.l2 * axial) * (1.0 / 6.0);
      f[3][k] += (w.l0 * axial - w.top * in_plane) * (1.0 / 6.0);
      f[4][k] += (w.top * p[0][k] + w.l1 * axial) * (1.0 / 6.0);
      f[5][k] += (w.top * p[1][k] + w.l2 * axial) * (1.0 / 6.0);
    }
  }
  template <class T>
  static CDEM_HD void Cofactors(const T a[3][3], T c[3][3]) {
    Cross(a[1], a[2], c[0]);
    Cross(a[2], a[0], c[1]);
    Cross(a[0], a[1], c[2]);
  }

  /// Internal forces f [6][3] [N] of displacements u [6][3] [m] at corners x [6][3] [m]; point as for HexFull.
  template <class T, class Point>
  static CDEM_HD void Forces(const T x[6][3], const T u[6][3], const Point &point, T f[6][3]) {
    CDEM_UNROLL for (int c = 0; c < 6; ++c) CDEM_UNROLL for (int k = 0; k < 3; ++k) f[c][k] = T{};
    CDEM_UNROLL for (int g = 0; g < 6; ++g) {
      const Weights w(g);
      T a[3][3], d[3][3], area[3][3], p[3][3], strain[6], stress[6];
      Columns(w, x, a);
      Columns(w, u, d);
      Cofactors(a, area);
      T det = Dot(a[0], area[0]);
      StrainOf(d[0], d[1], d[2], area[0], area[1], area[2], 1.0 / det, strain);
      point(g, strain, det * (1.0 / 6.0), stress);
      CDEM_UNROLL for (int i = 0; i < 3; ++i) Apply(stress, area[i], p[i]);
      ColumnsBack(w, p, f);
    }
  }
};

/// The same with mean dilatation: the strain of every point has the dilatation of the element's mean.
struct WedgeBbar : FormDefaults {
  static constexpr const char *kName = "bbar";
  static constexpr Shape kShape = Shape::kWedge;
  static constexpr int kCorners = 6;
  static constexpr int kPoints = 6;

  template <class T, class Point>
  static CDEM_HD void Forces(const T x[6][3], const T u[6][3], const Point &point, T f[6][3]) {
    T mean[6][3] = {}, volume{}, dilatation{}, pressure{};  // the integral, then the mean of grad N
    CDEM_UNROLL for (int g = 0; g < 6; ++g) {
      const WedgeFull::Weights w(g);
      T a[3][3], area[3][3];
      WedgeFull::Columns(w, x, a);
      WedgeFull::Cofactors(a, area);
      volume += Dot(a[0], area[0]) * (1.0 / 6.0);
      WedgeFull::ColumnsBack(w, area, mean);
    }
    T scale = 1.0 / volume;
    CDEM_UNROLL for (int c = 0; c < 6; ++c) CDEM_UNROLL for (int k = 0; k < 3; ++k) {
      mean[c][k] *= scale;
      dilatation += mean[c][k] * (u[c][k] - u[0][k]);  // a translation has none, to the last bit
      f[c][k] = T{};
    }
    CDEM_UNROLL for (int g = 0; g < 6; ++g) {
      const WedgeFull::Weights w(g);
      T a[3][3], d[3][3], area[3][3], p[3][3], strain[6], stress[6];
      WedgeFull::Columns(w, x, a);
      WedgeFull::Columns(w, u, d);
      WedgeFull::Cofactors(a, area);
      T det = Dot(a[0], area[0]), share = det * (1.0 / 6.0);
      StrainOf(d[0], d[1], d[2], area[0], area[1], area[2], 1.0 / det, strain);
      AddToDiagonal((dilatation - (strain[kXX] + strain[kYY] + strain[kZZ])) * (1.0 / 3.0), strain);
      point(g, strain, share, stress);
      T part = (stress[kXX] + stress[kYY] + stress[kZZ]) * (1.0 / 3.0);
      pressure += share * part;
      AddToDiagonal(-part, stress);
      CDEM_UNROLL for (int i = 0; i < 3; ++i) Apply(stress, area[i], p[i]);
      WedgeFull::ColumnsBack(w, p, f);
    }
    CDEM_UNROLL for (int c = 0; c < 6; ++c) CDEM_UNROLL for (int k = 0; k < 3; ++k) f[c][k] += pressure * mean[c][k];
  }
};

}  // namespace cdem
