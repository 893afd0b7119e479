// The hexahedron of full integration where it is a parallelepiped: its Jacobian is the same at all points, the modes of a
// field have gradients that are orthogonal under the 2x2x2 points, and a linear law takes one stress for each of them.
// The result is that of HexFull but for rounding, at two fifths of the arithmetic.
#pragma once
#include "physics/element_hex.hpp"

namespace cdem {

struct HexAffine : HexFull {
  static constexpr bool kAffine = true;
  /// How far a corner may be from where the three edges of the first put it, in edges; the forces then differ from those of
  /// HexFull by about as much.
  static constexpr double kTolerance = 1e-12;

  /// Whether the form stands for HexFull in an element. [in] x: corners [m].
  static bool Serves(const double x[8][3]) {
    double edge[3][3], longest = 0;
    for (int k = 0; k < 3; ++k) {
      const int to[3] = {1, 3, 4};
      for (int i = 0; i < 3; ++i) {
        edge[i][k] = x[to[i]][k] - x[0][k];
        longest = longest < Size(edge[i][k]) ? Size(edge[i][k]) : longest;
      }
    }
    for (int k = 0; k < 3; ++k) {
      const double e0 = edge[0][k], e1 = edge[1][k], e2 = edge[2][k];
      const double off[4] = {x[2][k] - x[0][k] - e0 - e1, x[5][k] - x[0][k] - e0 - e2, x[7][k] - x[0][k] - e1 - e2,
                             x[6][k] - x[0][k] - e0 - e1 - e2};
      for (double by : off)
        if (!(Size(by) <= kTolerance * longest)) return false;
    }
    return true;
  }

  /// As HexFull's; points that want to be asked one by one are.
  template <class T, class Point>
  static CDEM_HD void Forces(const T x[8][3], const T u[8][3], const Point &point, T f[8][3]) {
    if constexpr (!kUniform<Point>) {
      HexFull::Forces(x, u, point, f);
    } else {
      T a[3][3], b[3][3], m[7][3], p[7][3] = {};  // cofactors; the same for strains; modes of u; of the forces
      {
        T e[3][3];
        CDEM_UNROLL for (int k = 0; k < 3; ++k) {
          e[0][k] = x[1][k] - x[0][k];
          e[1][k] = x[3][k] - x[0][k];
          e[2][k] = x[4][k] - x[0][k];
        }
        Cross(e[1], e[2], a[0]);
        Cross(e[2], e[0], a[1]);
        Cross(e[0], e[1], a[2]);
        const T scale =
            0.25 / Dot(e[0], a[0]);  // a mode is 8 times its amplitude, an edge twice its column of the Jacobian
        CDEM_UNROLL for (int i = 0; i < 3; ++i) CDEM_UNROLL for (int k = 0; k < 3; ++k) b[i][k] = scale * a[i][k];
      }
      CDEM_UNROLL for (int k = 0; k < 3; ++k) {
        Modes(u, k, m);
        CDEM_UNROLL for (int i = 3; i < 6; ++i) m[i][k] *= 1.0 / 3;  // means of xi^2 and of xi^2 eta^2
        m[6][k] *= 1.0 / 9;
      }
      T gradient[3][3], stress[6];
      Product(m[0], b[0], gradient);
      AddProduct(m[1], b[1], gradient);
      AddProduct(m[2], b[2], gradient);
      StressOf(point, gradient, stress);
      CDEM_UNROLL for (int i = 0; i < 3; ++i) ApplyAdd(stress, a[i], p[i]);
      // what grows with xi, with eta, with zeta: modes of it, and the two coordinates they are derived by
      constexpr int kWith[3][2][2] = {{{3, 1}, {5, 2}}, {{3, 0}, {4, 2}}, {{5, 0}, {4, 1}}};
      CDEM_UNROLL for (int g = 0; g < 3; ++g) {
        Product(m[kWith[g][0][0]], b[kWith[g][0][1]], gradient);
        AddProduct(m[kWith[g][1][0]], b[kWith[g][1][1]], gradient);
        StressOf(point, gradient, stress);
        CDEM_UNROLL for (int i = 0; i < 2; ++i) ApplyAdd(stress, a[kWith[g][i][1]], p[kWith[g][i][0]]);
      }
      CDEM_UNROLL for (int i = 0; i < 3; ++i) {  // and with the product of two of them
        Product(m[6], b[i], gradient);
        StressOf(point, gradient, stress);
        ApplyAdd(stress, a[i], p[6]);
      }
      CDEM_UNROLL for (int k = 0; k < 3; ++k) FromModes(p, k, 0.25, f);
    }
  }

 private:
  static double Size(double x) { return x < 0 ? -x : x; }
  template <class T>
  static CDEM_HD void Product(const T m[3], const T b[3], T h[3][3]) {
    CDEM_UNROLL for (int j = 0; j < 3; ++j) CDEM_UNROLL for (int k = 0; k < 3; ++k) h[j][k] = m[j] * b[k];
  }
  template <class T>
  static CDEM_HD void AddProduct(const T m[3], const T b[3], T h[3][3]) {
    CDEM_UNROLL for (int j = 0; j < 3; ++j) CDEM_UNROLL for (int k = 0; k < 3; ++k) h[j][k] += m[j] * b[k];
  }
  template <class T, class Point>
  static CDEM_HD void StressOf(const Point &point, const T h[3][3], T stress[6]) {
    T strain[6];
    CDEM_UNROLL for (int k = 0; k < 3; ++k) strain[k] = h[k][k];
    strain[kXY] = 0.5 * (h[0][1] + h[1][0]);
    strain[kYZ] = 0.5 * (h[1][2] + h[2][1]);
    strain[kXZ] = 0.5 * (h[0][2] + h[2][0]);
    point(0, strain, strain[0], stress);
  }
};

}  // namespace cdem
