// The 8-node hexahedron with one stress point and stiffness against hourglassing (Flanagan and Belytschko 1981): the mean
// gradient in closed form, and elastic forces on the four modes that it does not see, taken orthogonal to linear fields.
#pragma once
#include "physics/element_hex.hpp"
#include "physics/hex_volume.hpp"

namespace cdem {

struct HexOnePoint : FormDefaults {
  static constexpr const char *kName = "onepoint";
  static constexpr Shape kShape = Shape::kHex;
  static constexpr int kCorners = 8;
  static constexpr int kPoints = 1;

  /// Share kappa of the stiffness kappa 2 mu (B : B)/V of a mode h.u/sqrt(8), B the integral of grad N. With 1/9 a cube
  /// of Poisson's ratio 0 holds the exact energy of a beam in its six bending modes, where `full` holds 1.5 times it.
  static constexpr double kHourglass = 1.0 / 9.0;

  /// Internal forces f [8][3] [N] of displacements u [8][3] [m] at corners x [8][3] [m]; point as for HexFull.
  template <class T, class Point>
  static CDEM_HD void Forces(const T x[8][3], const T u[8][3], const Point &point, T f[8][3]) {
    T mean[6][3], mx[7][3], mu[7][3];
    CDEM_UNROLL for (int k = 0; k < 3; ++k) HexFull::Modes(x, k, mx);
    CDEM_UNROLL for (int k = 0; k < 3; ++k) HexFull::Modes(u, k, mu);
    T volume = HexVolume<T>(mx).Gradient(1.0 / 3.0, mean), scale = 1.0 / volume, square{};
    CDEM_UNROLL for (int i = 0; i < 6; ++i) CDEM_UNROLL for (int k = 0; k < 3; ++k) {
      mean[i][k] *= scale;
      square += mean[i][k] * mean[i][k];
    }
    T grad[3][3] = {};  // of u: [component][direction]
    CDEM_UNROLL for (int i = 0; i < 6; ++i) CDEM_UNROLL for (int k = 0; k < 3; ++k)
        CDEM_UNROLL for (int l = 0; l < 3; ++l) grad[k][l] += mu[i][k] * mean[i][l];
    T strain[6] = {grad[0][0], grad[1][1], grad[2][2]}, stress[6];
    strain[kXY] = 0.5 * (grad[0][1] + grad[1][0]);
    strain[kYZ] = 0.5 * (grad[1][2] + grad[2][1]);
    strain[kXZ] = 0.5 * (grad[0][2] + grad[2][0]);
    volume *= 1.0 / 64.0;
    point(0, strain, volume, stress);

    // V stress, less what makes the hourglass forces blind to linear fields
    T push[3][3] = {{volume * stress[kXX], volume * stress[kXY], volume * stress[kXZ]},
                    {volume * stress[kXY], volume * stress[kYY], volume * stress[kYZ]},
                    {volume * stress[kXZ], volume * stress[kYZ], volume * stress[kZZ]}};
    T stiffness = point.ShearModulus() * volume * square * (kHourglass * 2.0), twice_energy{}, m[7][3];
    CDEM_UNROLL for (int h = 3; h < 7; ++h) CDEM_UNROLL for (int k = 0; k < 3; ++k) {
      T q = mu[h][k] - (grad[k][0] * mx[h][0] + grad[k][1] * mx[h][1] + grad[k][2] * mx[h][2]);
      m[h][k] = stiffness * q;
      twice_energy += m[h][k] * q;
      CDEM_UNROLL for (int l = 0; l < 3; ++l) push[k][l] -= m[h][k] * mx[h][l];
    }
    point.Stored(0.5 * twice_energy);
    CDEM_UNROLL for (int i = 0; i < 6; ++i) CDEM_UNROLL for (int k = 0; k < 3; ++k) {
      T force = push[k][0] * mean[i][0] + push[k][1] * mean[i][1] + push[k][2] * mean[i][2];
      m[i][k] = i < 3 ? force : m[i][k] + force;
    }
    CDEM_UNROLL for (int k = 0; k < 3; ++k) HexFull::FromModes(m, k, 1.0, f);
  }
};

}  // namespace cdem
