// The 8-node hexahedron of springs along its edges: at each corner the three edges that meet there give the displacement
// gradient. Taken plainly that fails the patch test on distorted shapes; here the corners' gradients are shifted, all by
// the same, so that their mean is the exact mean of grad N.
#pragma once
#include "physics/element_hex.hpp"
#include "physics/hex_volume.hpp"

namespace cdem {

struct HexSpring : FormDefaults {
  static constexpr const char *kName = "spring";
  static constexpr Shape kShape = Shape::kHex;
  static constexpr int kCorners = 8;
  static constexpr int kPoints = 8;
  static constexpr bool kAtCorners = true;

  /// The corner at an end (0 or 1) of an edge: along xi at (eta, zeta), along eta at (xi, zeta), along zeta at (xi, eta).
  static CDEM_HD int Corner(int along, int edge, int end) {
    const int low = edge & 1, high = edge >> 1;
    const int xi = along == 0 ? end : low, eta = along == 0 ? low : along == 1 ? end : high;
    return 4 * (along == 2 ? end : high) + (eta ? 3 - xi : xi);
  }
  template <class T>
  static CDEM_HD void Edges(const T q[8][3], T edge[3][4][3]) {
    CDEM_UNROLL for (int d = 0; d < 3; ++d) CDEM_UNROLL for (int e = 0; e < 4; ++e)
        CDEM_UNROLL for (int k = 0; k < 3; ++k) edge[d][e][k] = q[Corner(d, e, 1)][k] - q[Corner(d, e, 0)][k];
  }

  /// Internal forces f [8][3] [N] of displacements u [8][3] [m] at corners x [8][3] [m]. point(g, strain, volume, area,
  /// stress) gives the stress of a corner; area are vectors along the normals of its three faces, of any length.
  template <class T, class Point>
  static CDEM_HD void Forces(const T x[8][3], const T u[8][3], const Point &point, T f[8][3]) {
    T shift[6][3], ratio, shift_strain[6];  // mean of grad N less that of the corners, by modes
    {
      T m[7][3], mean[6][3];
      CDEM_UNROLL for (int k = 0; k < 3; ++k) HexFull::Modes(x, k, m);
      const HexVolume<T> parts(m);
      T volume = parts.Gradient(1.0 / 3.0, mean), corners = parts.Gradient(1.0, shift);
      T of_volume = 1.0 / volume, of_corners = 1.0 / corners;
      ratio = volume * of_corners * 0.125;  // a corner's share of the volume over the determinant of its edges
      CDEM_UNROLL for (int i = 0; i < 6; ++i) CDEM_UNROLL for (int k = 0; k < 3; ++k) shift[i][k] =
          mean[i][k] * of_volume - shift[i][k] * of_corners;
    }
    {
      T m[7][3], first[6], second[6];
      CDEM_UNROLL for (int k = 0; k < 3; ++k) HexFull::Modes(u, k, m);
      StrainOf(m[0], m[1], m[2], shift[0], shift[1], shift[2], T{} + 1.0, first);
      StrainOf(m[3], m[4], m[5], shift[3], shift[4], shift[5], T{} + 1.0, second);
      CDEM_UNROLL for (int i = 0; i < 6; ++i) shift_strain[i] = first[i] + second[i];
    }
    T j[3][4][3], d[3][4][3], p[3][4][3] = {}, sum[6] = {};
    Edges(x, j);
    Edges(u, d);
    CDEM_UNROLL for (int g = 0; g < 8; ++g) {
      const int xi = g & 1, eta = (g >> 1) & 1, zeta = g >> 2;
      const int a = eta + 2 * zeta, b = xi + 2 * zeta, c = xi + 2 * eta;
      T area[3][3], strain[6], stress[6];
      Cross(j[1][b], j[2][c], area[0]);
      Cross(j[2][c], j[0][a], area[1]);
      Cross(j[0][a], j[1][b], area[2]);
      T det = Dot(j[0][a], area[0]), volume = det * ratio;
      StrainOf(d[0][a], d[1][b], d[2][c], area[0], area[1], area[2], 1.0 / det, strain);
      CDEM_UNROLL for (int i = 0; i < 6; ++i) strain[i] += shift_strain[i];
      point(g, strain, volume, area, stress);
      CDEM_UNROLL for (int i = 0; i < 6; ++i) sum[i] += volume * stress[i];
      ApplyAdd(stress, area[0], p[0][a]);
      ApplyAdd(stress, area[1], p[1][b]);
      ApplyAdd(stress, area[2], p[2][c]);
    }
    T m[7][3] = {};
    CDEM_UNROLL for (int i = 0; i < 6; ++i) Apply(sum, shift[i], m[i]);
    CDEM_UNROLL for (int k = 0; k < 3; ++k) HexFull::FromModes(m, k, 1.0, f);
    CDEM_UNROLL for (int i = 0; i < 3; ++i) CDEM_UNROLL for (int e = 0; e < 4; ++e)
        CDEM_UNROLL for (int k = 0; k < 3; ++k) {
      T along = p[i][e][k] * ratio;
      f[Corner(i, e, 1)][k] += along;
      f[Corner(i, e, 0)][k] -= along;
    }
  }
};

}  // namespace cdem
