// The step of a node of a quiet boundary: its dashpots act on the mean of the half-step velocities before and after.
#pragma once
#include "core/small.hpp"

namespace cdem {

/// x of A x = b for a symmetric, positive definite A, in the order of small.hpp; by elimination, so without roots.
CDEM_HD void SolveSymmetric(const double a[6], const double b[3], double x[3]) {
  const double l10 = a[kXY] / a[kXX], l20 = a[kXZ] / a[kXX];
  const double d1 = a[kYY] - l10 * a[kXY], e = a[kYZ] - l20 * a[kXY];
  const double l21 = e / d1, d2 = a[kZZ] - l20 * a[kXZ] - l21 * e;
  const double y1 = b[1] - l10 * b[0], y2 = b[2] - l20 * b[0] - l21 * y1;
  x[2] = y2 / d2;
  x[1] = y1 / d1 - l21 * x[2];
  x[0] = b[0] / a[kXX] - l10 * x[1] - l20 * x[2];
}

/// Puts dashpots into a half step: (M + h/2 (alpha M + C)) v = (M - h/2 (alpha M + C)) v_old + h F, which with
/// B = kick/(2 m) C and the velocity w = keep v_old + kick F/m of a node without dashpots is (1 + B) v = w - B v_old.
/// Prescribed components move as they do, and the others feel them: the solution is that of the free components.
/// [in] dashpot: C [N s/m], symmetric, in the order of small.hpp; scale: kick/(2 m) [s/kg]; kind: Prescribed of x, y, z,
/// two bits each; v_old: before [m/s]. [in,out] v: w, or what is prescribed; then the velocity after [m/s].
/// Source: Lysmer and Kuhlemeyer 1969 (C), centred like the damping by mass.
CDEM_HD void Absorb(const double dashpot[6], double scale, int kind, const double v_old[3], double v[3]) {
  constexpr int kPlace[3][3] = {{kXX, kXY, kXZ}, {kXY, kYY, kYZ}, {kXZ, kYZ, kZZ}};
  double a[6], back[3], b[3], x[3];
  for (int k = 0; k < 6; ++k) a[k] = scale * dashpot[k];
  Apply(a, v_old, back);
  for (int k = 0; k < 3; ++k) {
    a[kPlace[k][k]] += 1;
    b[k] = v[k] - back[k];
  }
  for (int p = 0; p < 3; ++p) {
    if (((kind >> (2 * p)) & 3) == 0) continue;
    for (int k = 0; k < 3; ++k) {
      if (k == p) continue;
      b[k] -= a[kPlace[k][p]] * v[p];
      a[kPlace[k][p]] = 0;
    }
    a[kPlace[p][p]] = 1;
    b[p] = v[p];
  }
  SolveSymmetric(a, b, x);
  for (int k = 0; k < 3; ++k)
    if (((kind >> (2 * k)) & 3) == 0) v[k] = x[k];
}

}  // namespace cdem
