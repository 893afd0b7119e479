// The 4-node tetrahedron: one constant strain.
#pragma once
#include "physics/form.hpp"

namespace cdem {

struct TetFull : FormDefaults {
  static constexpr const char *kName = "full";
  static constexpr Shape kShape = Shape::kTet;
  static constexpr int kCorners = 4;
  static constexpr int kPoints = 1;

  /// Internal forces f [4][3] [N] of displacements u [4][3] [m] at corners x [4][3] [m]; point as for HexFull.
  template <class T, class Point>
  static CDEM_HD void Forces(const T x[4][3], const T u[4][3], const Point &point, T f[4][3]) {
    T a[3][3], d[3][3], ca[3], cb[3], cc[3], strain[6], stress[6];
    CDEM_UNROLL for (int i = 0; i < 3; ++i) CDEM_UNROLL for (int k = 0; k < 3; ++k) {
      a[i][k] = x[i + 1][k] - x[0][k];
      d[i][k] = u[i + 1][k] - u[0][k];
    }
    Cross(a[1], a[2], ca);
    Cross(a[2], a[0], cb);
    Cross(a[0], a[1], cc);
    T det = Dot(a[0], ca);
    StrainOf(d[0], d[1], d[2], ca, cb, cc, 1.0 / det, strain);
    point(0, strain, det * (1.0 / 6.0), stress);
    T p[3][3];
    Apply(stress, ca, p[0]);
    Apply(stress, cb, p[1]);
    Apply(stress, cc, p[2]);
    CDEM_UNROLL for (int k = 0; k < 3; ++k) {
      f[1][k] = p[0][k] * (1.0 / 6.0);
      f[2][k] = p[1][k] * (1.0 / 6.0);
      f[3][k] = p[2][k] * (1.0 / 6.0);
      f[0][k] = -(f[1][k] + f[2][k] + f[3][k]);
    }
  }
};

}  // namespace cdem
