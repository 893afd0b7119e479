// The return to Mohr-Coulomb's surface with tension cut-off, for every law that ends on it. In principal stresses
// s1 >= s2 >= s3 (tension positive), with S = sin(phi), P = sin(psi) and the cut-off t not above the apex:
//   f = (1 + S) s1 - (1 - S) s3 - 2 c cos(phi) <= 0,  s1 <= t;    flow (1 + P, 0, -(1 - P)) on f, (1, 0, 0) on s1 = t.
#pragma once
#include "physics/block_elastic.hpp"
#include "physics/principal.hpp"

namespace cdem {

/// The surface's numbers: sin(phi), sin(psi), 2 c cos(phi) and the cut-off [Pa].
template <class T>
struct MohrCoulombSurface {
  T sin_phi, sin_psi, strength, tension;
};

/// Lanes that may have left the surface: a bound by the mean and J2 over all Lode angles, without principal values.
template <class T>
CDEM_HD MaskOf<T> MayHaveLeft(const MohrCoulombSurface<T> &m, const T stress[6]) {
  const T zero = T{}, mean = (stress[kXX] + stress[kYY] + stress[kZZ]) * (1.0 / 3.0);
  const T j2 = SecondInvariant(stress, mean);
  const T room = 0.5 * m.strength - m.sin_phi * mean, gap = m.tension - mean;
  const T shear = j2 * (1.0 + m.sin_phi * m.sin_phi * (1.0 / 3.0)), pull = j2 * (4.0 / 3.0);
  return (shear >= room * room) | (room <= zero) | (pull >= gap * gap) | (gap <= zero);
}

/// Principal stresses s brought back to the surface: Koiter's rule, each region in closed form.
template <class T>
CDEM_HD void ReturnPrincipal(const MohrCoulombSurface<T> &m, T lambda, T mu, const T s[3], T out[3]) {
  const T a = 1.0 + m.sin_phi, b = 1.0 - m.sin_phi, ap = 1.0 + m.sin_psi, bp = 1.0 - m.sin_psi;
  const T t = m.tension, swell = 2.0 * m.sin_psi * lambda, common = 2.0 * m.sin_phi * swell;
  // f alone: the plane, or an edge where the plane's return breaks the order: s1 = s2, or s2 = s3
  const T f = a * s[0] - b * s[2] - m.strength;
  const T plane = f / (common + 2.0 * mu * (a * ap + b * bp));
  T r1 = s[0] - plane * (swell + 2.0 * mu * ap), r2 = s[1] - plane * swell, r3 = s[2] - plane * (swell - 2.0 * mu * bp);
  const T upper = 0.5 * (s[0] + s[1]), lower = 0.5 * (s[1] + s[2]);
  const T first = (a * upper - b * s[2] - m.strength) / (common + mu * (a * ap + 2.0 * b * bp));
  const T e1 = upper - first * (swell + mu * ap), e3 = s[2] - first * (swell - 2.0 * mu * bp);
  const T second = (a * s[0] - b * lower - m.strength) / (common + mu * (2.0 * a * ap + b * bp));
  const T g1 = s[0] - second * (swell + 2.0 * mu * ap), g3 = lower - second * (swell - mu * bp);
  const MaskOf<T> on_first = (r1 < r2) & ((e1 >= e3) | (r2 >= r3)), on_second = (r2 < r3) & !on_first;
  r1 = on_first ? e1 : on_second ? g1 : r1;
  r2 = on_first ? e1 : on_second ? g3 : r2;
  r3 = on_first ? e3 : on_second ? g3 : r3;
  const MaskOf<T> by_shear = (f > T{}) & (r1 <= t);  // beyond the apex r1 is above it, and so above t
  // cut-off alone: one, two or three principal stresses at t
  const T one = lambda / (lambda + 2.0 * mu), two = 0.5 * lambda / (lambda + mu);
  T q2 = s[1] - one * (s[0] - t), q3 = s[2] - one * (s[0] - t);
  const MaskOf<T> pair = q2 > t;
  q3 = pair ? s[2] - two * ((s[0] - t) + (s[1] - t)) : q3;
  q2 = pair ? t : q2;
  q3 = q3 > t ? t : q3;
  const MaskOf<T> by_tension = (s[0] > t) & (a * t - b * q3 <= m.strength);
  // both: the line s1 = t, f = 0, and its ends, where s2 = s1 or s2 = s3
  const T c3 = (a * t - m.strength) / b;
  T c2 = s[1] - two * ((s[0] - t) + (s[2] - c3));
  c2 = c2 > t ? t : c2;
  c2 = c2 < c3 ? c3 : c2;
  out[0] = by_shear ? r1 : t;
  out[1] = by_shear ? r2 : by_tension ? q2 : c2;
  out[2] = by_shear ? r3 : by_tension ? q3 : c3;
}

/// Brings a trial stress back to the surface and adds to the plastic strain (true shears) and, in state[6], the plastic
/// shear strain. Returns the lanes of near that had left it; the others stay as they are.
template <class T>
CDEM_HD_CALL MaskOf<T> ReturnToMohrCoulomb(MohrCoulombSurface<T> m, T lambda, T mu, MaskOf<T> near, T stress[6],
                                           T state[7]) {
  Principal<T> principal;
  FindPrincipal<true>(stress, &principal);
  const T *s = principal.value;
  T out[3], drop[3], moved[6];
  ReturnPrincipal(m, lambda, mu, s, out);
  const MaskOf<T> left =
      near & ((s[0] > m.tension) | ((1.0 + m.sin_phi) * s[0] - (1.0 - m.sin_phi) * s[2] > m.strength));
  CDEM_UNROLL for (int i = 0; i < 3; ++i) drop[i] = s[i] - out[i];
  CDEM_UNROLL for (int k = 0; k < 6; ++k) {
    const int i = k < 3 ? k : k == kYZ ? 1 : 0, j = k < 3 ? k : k == kXY ? 1 : 2;
    moved[k] = drop[0] * principal.axis[0][i] * principal.axis[0][j] +
               drop[1] * principal.axis[1][i] * principal.axis[1][j] +
               drop[2] * principal.axis[2][i] * principal.axis[2][j];
  }
  const T sum = drop[0] + drop[1] + drop[2], mean = sum * (1.0 / 3.0), soft = 0.5 / mu;
  const T sideways = lambda / (3.0 * lambda + 2.0 * mu) * sum;
  CDEM_UNROLL for (int k = 0; k < 6; ++k) {
    stress[k] = left ? stress[k] - moved[k] : stress[k];
    state[k] = left ? state[k] + soft * (k < 3 ? moved[k] - sideways : moved[k]) : state[k];
  }
  T squares = T{};
  CDEM_UNROLL for (int i = 0; i < 3; ++i) squares += (drop[i] - mean) * (drop[i] - mean);
  state[6] = left ? state[6] + soft * Sqrt(2.0 * squares) : state[6];
  return left;
}

/// Stress [Pa] of a strain (true shears) with plastic strain in state [7], elastic up to the surface.
template <class T>
CDEM_HD MaskOf<T> MohrCoulombStress(const MohrCoulombSurface<T> &m, const T *elastic, const T strain[6], T state[7],
                                    T stress[6]) {
  T e[6];
  CDEM_UNROLL for (int k = 0; k < 6; ++k) e[k] = strain[k] - state[k];
  Elastic::Stress(elastic, e, stress);
  MaskOf<T> left = MayHaveLeft(m, stress);
  if (Any(left)) {
    T trial[6], plastic[7];  // copies, so that only they need an address
    CDEM_UNROLL for (int k = 0; k < 6; ++k) trial[k] = stress[k];
    CDEM_UNROLL for (int k = 0; k < 7; ++k) plastic[k] = state[k];
    left = ReturnToMohrCoulomb(m, elastic[Elastic::kLambda], elastic[Elastic::kMu], left, trial, plastic);
    CDEM_UNROLL for (int k = 0; k < 6; ++k) stress[k] = trial[k];
    CDEM_UNROLL for (int k = 0; k < 7; ++k) state[k] = plastic[k];
  }
  return left;
}

}  // namespace cdem
