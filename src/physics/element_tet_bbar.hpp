// The 4-node tetrahedron whose dilatation is averaged over its neighbours: element dilatations are averaged at the nodes,
// weighted by volume, and an element takes the mean of its four nodes; its pressure goes back the same way. An element
// alone cannot do that: forces/dilatation.hpp drives the parts below.
#pragma once
#include "physics/element_tet.hpp"

namespace cdem {

struct TetBbar : FormDefaults {
  static constexpr const char *kName = "bbar";
  static constexpr Shape kShape = Shape::kTet;
  static constexpr int kCorners = 4;
  static constexpr int kPoints = 1;
  static constexpr bool kAverages = true;

  /// Forces of an element alone, as in TetFull.
  template <class T, class Point>
  static CDEM_HD void Forces(const T x[4][3], const T u[4][3], const Point &point, T f[4][3]) {
    TetFull::Forces(x, u, point, f);
  }

  /// The integral of div u [m^3].
  template <class T>
  static CDEM_HD T Swelling(const T x[4][3], const T u[4][3]) {
    T a[3][3], c[3][3], sum{};
    Cofactors(x, a, c);
    CDEM_UNROLL for (int i = 0; i < 3; ++i) CDEM_UNROLL for (int k = 0; k < 3; ++k) sum +=
        (u[i + 1][k] - u[0][k]) * c[i][k];
    return sum * (1.0 / 6.0);
  }
  /// Changes u so that its dilatation is the mean of those of the four nodes, and nothing else of its gradient.
  template <class T>
  static CDEM_HD void Spread(const T x[4][3], const T of_node[4], T u[4][3]) {
    T mean = 0.25 * (of_node[0] + of_node[1] + of_node[2] + of_node[3]);
    T stretch = (mean - Swelling(x, u) / Volume(x)) * (1.0 / 3.0);
    CDEM_UNROLL for (int a = 1; a < 4; ++a) CDEM_UNROLL for (int k = 0; k < 3; ++k) u[a][k] +=
        stretch * (x[a][k] - x[0][k]);
  }
  /// The integral of the mean stress [N m] that corner forces carry.
  template <class T>
  static CDEM_HD T Pressure(const T x[4][3], const T f[4][3]) {
    T sum{};
    CDEM_UNROLL for (int a = 1; a < 4; ++a) CDEM_UNROLL for (int k = 0; k < 3; ++k) sum +=
        f[a][k] * (x[a][k] - x[0][k]);
    return sum * (1.0 / 3.0);
  }
  /// Changes corner forces so that their mean stress is the mean of those of the four nodes.
  template <class T>
  static CDEM_HD void Press(const T x[4][3], const T of_node[4], T f[4][3]) {
    T mean = 0.25 * (of_node[0] + of_node[1] + of_node[2] + of_node[3]), a[3][3], c[3][3];
    T change = (mean - Pressure(x, f) / Volume(x)) * (1.0 / 6.0);
    Cofactors(x, a, c);
    CDEM_UNROLL for (int i = 0; i < 3; ++i) CDEM_UNROLL for (int k = 0; k < 3; ++k) {
      T more = change * c[i][k];
      f[i + 1][k] += more;
      f[0][k] -= more;
    }
  }
  template <class T>
  static CDEM_HD T Volume(const T x[4][3]) {
    T a[3][3], c[3][3];
    Cofactors(x, a, c);
    return Dot(a[0], c[0]) * (1.0 / 6.0);
  }

 private:
  template <class T>
  static CDEM_HD void Cofactors(const T x[4][3], T a[3][3], T c[3][3]) {
    CDEM_UNROLL for (int i = 0; i < 3; ++i) CDEM_UNROLL for (int k = 0; k < 3; ++k) a[i][k] = x[i + 1][k] - x[0][k];
    Cross(a[1], a[2], c[0]);
    Cross(a[2], a[0], c[1]);
    Cross(a[0], a[1], c[2]);
  }
};

}  // namespace cdem
