// The 6-node wedge with 3 x 2 Gauss points: three points in the triangle, two along the axis.
#pragma once
#include "core/small.hpp"
#include "mesh/shapes.hpp"

namespace cdem {

struct WedgeFull {
  static constexpr const char *kName = "full";
  static constexpr Shape kShape = Shape::kWedge;
  static constexpr int kCorners = 6;
  static constexpr int kPoints = 6;
  static constexpr bool kAtCorners = false;
  static constexpr double kGauss = 0.57735026918962576451;

  /// Internal forces f [6][3] [N] of displacements u [6][3] [m] at corners x [6][3] [m]; point as for HexFull.
  template <class T, class Point>
  static CDEM_HD void Forces(const T x[6][3], const T u[6][3], const Point &point, T f[6][3]) {
    CDEM_UNROLL for (int c = 0; c < 6; ++c) CDEM_UNROLL for (int k = 0; k < 3; ++k) f[c][k] = T{};
    CDEM_UNROLL for (int g = 0; g < 6; ++g) {
      // barycentric coordinates of the point are (2/3, 1/6, 1/6) and its turns
      const double l1 = g % 3 == 1 ? 2.0 / 3.0 : 1.0 / 6.0, l2 = g % 3 == 2 ? 2.0 / 3.0 : 1.0 / 6.0;
      const double zeta = g < 3 ? -kGauss : kGauss;
      const double bottom = 0.5 * (1 - zeta), top = 0.5 * (1 + zeta), l0 = 1 - l1 - l2;
      T a[3][3], d[3][3], ca[3], cb[3], cc[3], strain[6], stress[6];
      CDEM_UNROLL for (int k = 0; k < 3; ++k) {
        a[0][k] = bottom * (x[1][k] - x[0][k]) + top * (x[4][k] - x[3][k]);
        a[1][k] = bottom * (x[2][k] - x[0][k]) + top * (x[5][k] - x[3][k]);
        a[2][k] = 0.5 * (l0 * (x[3][k] - x[0][k]) + l1 * (x[4][k] - x[1][k]) + l2 * (x[5][k] - x[2][k]));
        d[0][k] = bottom * (u[1][k] - u[0][k]) + top * (u[4][k] - u[3][k]);
        d[1][k] = bottom * (u[2][k] - u[0][k]) + top * (u[5][k] - u[3][k]);
        d[2][k] = 0.5 * (l0 * (u[3][k] - u[0][k]) + l1 * (u[4][k] - u[1][k]) + l2 * (u[5][k] - u[2][k]));
      }
      Cross(a[1], a[2], ca);
      Cross(a[2], a[0], cb);
      Cross(a[0], a[1], cc);
      T det = Dot(a[0], ca);
      StrainOf(d[0], d[1], d[2], ca, cb, cc, 1.0 / det, strain);
      point(g, strain, det * (1.0 / 6.0), stress);
      T p[3][3];
      Apply(stress, ca, p[0]);
      Apply(stress, cb, p[1]);
      Apply(stress, cc, p[2]);
      CDEM_UNROLL for (int k = 0; k < 3; ++k) {
        T in_plane = p[0][k] + p[1][k], axial = 0.5 * p[2][k];
        f[0][k] -= (bottom * in_plane + l0 * axial) * (1.0 / 6.0);
        f[1][k] += (bottom * p[0][k] - l1 * axial) * (1.0 / 6.0);
        f[2][k] += (bottom * p[1][k] - l2 * axial) * (1.0 / 6.0);
        f[3][k] += (l0 * axial - top * in_plane) * (1.0 / 6.0);
        f[4][k] += (top * p[0][k] + l1 * axial) * (1.0 / 6.0);
        f[5][k] += (top * p[1][k] + l2 * axial) * (1.0 / 6.0);
      }
    }
  }
};

}  // namespace cdem
