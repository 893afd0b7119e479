// Closed forms of the trilinear hexahedron in its modes m (sums of the corners with signs +-1, HexFull::Modes): the
// volume, and its derivative by the corners, which is the integral of grad N. With the weight 1/3 they are the exact
// integrals, with 1 the sums over the corners instead of the integral; the seventh mode drops out of both.
#pragma once
#include "core/small.hpp"

namespace cdem {

/// The parts of the derivative of the volume by the modes: d(64 V)/dm_i = a_i + weight c_i, where a_i = 0 from i = 3 on.
template <class T>
struct HexVolume {
  T a[3][3], c[6][3];
  T plain, coupled;  ///< 64 V = plain + weight coupled

  CDEM_HD explicit HexVolume(const T m[7][3]) {
    T p[3], q[3];
    Cross(m[1], m[2], a[0]);
    Cross(m[2], m[0], a[1]);
    Cross(m[0], m[1], a[2]);
    Cross(m[3], m[5], c[0]);
    Cross(m[4], m[3], c[1]);
    Cross(m[5], m[4], c[2]);
    Cross(m[5], m[0], p);
    Cross(m[1], m[4], q);
    Add(p, q, c[3]);
    Cross(m[3], m[1], p);
    Cross(m[2], m[5], q);
    Add(p, q, c[4]);
    Cross(m[0], m[3], p);
    Cross(m[4], m[2], q);
    Add(p, q, c[5]);
    plain = Dot(m[0], a[0]);
    coupled = Dot(m[0], c[0]) + Dot(m[4], c[4]);
  }

  /// 64 V and its derivative g [6][3] by the modes.
  CDEM_HD T Gradient(double weight, T g[6][3]) const {
    CDEM_UNROLL for (int i = 0; i < 3; ++i) CDEM_UNROLL for (int k = 0; k < 3; ++k) {
      g[i][k] = a[i][k] + weight * c[i][k];
      g[3 + i][k] = weight * c[3 + i][k];
    }
    return plain + weight * coupled;
  }

 private:
  static CDEM_HD void Add(const T p[3], const T q[3], T sum[3]) {
    CDEM_UNROLL for (int k = 0; k < 3; ++k) sum[k] = p[k] + q[k];
  }
};

}  // namespace cdem
