// Principal values and directions of a symmetric tensor by cyclic Jacobi rotations: only + - * / and square roots, right
// where values coincide. A lane rotates only while its own tensor asks for it, so its bits do not depend on the others'.
#pragma once
#include "core/lanes.hpp"
#include "core/small.hpp"

namespace cdem {

/// Principal values, the largest first, and their unit directions.
template <class T>
struct Principal {
  T value[3], axis[3][3];
};

/// One rotation in the plane of components p and q; of_q (of_p) stand for the third component with q (p). Returns the
/// lanes that needed it: those whose off-diagonal component is above the square root of limit.
template <bool kAxes, class T>
CDEM_HD MaskOf<T> JacobiRotate(T limit, int p, int q, T a[3], T &between, T &of_p, T &of_q, T axis[3][3]) {
  const MaskOf<T> turn = between * between > limit;
  if (!Any(turn)) return turn;
  const T zero = T{}, apart = a[q] - a[p];
  const T size = apart < zero ? -apart : apart;
  const T sum = size + Sqrt(apart * apart + 4.0 * between * between);
  const T tangent = 2.0 * (apart < zero ? -between : between) / (sum > zero ? sum : sum + 1.0);
  const T c = 1.0 / Sqrt(1.0 + tangent * tangent), s = tangent * c;
  const T third = of_p;
  a[p] = turn ? a[p] - tangent * between : a[p];
  a[q] = turn ? a[q] + tangent * between : a[q];
  of_p = turn ? c * third - s * of_q : third;
  of_q = turn ? s * third + c * of_q : of_q;
  between = turn ? zero : between;
  if (kAxes) CDEM_UNROLL for (int k = 0; k < 3; ++k) {
      const T old = axis[p][k];
      axis[p][k] = turn ? c * old - s * axis[q][k] : old;
      axis[q][k] = turn ? s * old + c * axis[q][k] : axis[q][k];
    }
  return turn;
}

template <bool kAxes, class T>
CDEM_HD void PutInOrder(int i, int j, Principal<T> *out) {
  const MaskOf<T> swap = out->value[i] < out->value[j];
  const T larger = swap ? out->value[j] : out->value[i];
  out->value[j] = swap ? out->value[i] : out->value[j];
  out->value[i] = larger;
  if (kAxes) CDEM_UNROLL for (int k = 0; k < 3; ++k) {
      const T first = swap ? out->axis[j][k] : out->axis[i][k];
      out->axis[j][k] = swap ? out->axis[i][k] : out->axis[j][k];
      out->axis[i][k] = first;
    }
}

/// Without kAxes the directions are left out.
template <bool kAxes, class T>
CDEM_HD void FindPrincipal(const T tensor[6], Principal<T> *out) {
  T *a = out->value, xy = tensor[kXY], yz = tensor[kYZ], xz = tensor[kXZ];
  CDEM_UNROLL for (int i = 0; i < 3; ++i) {
    a[i] = tensor[i];
    if (kAxes) CDEM_UNROLL for (int k = 0; k < 3; ++k) out->axis[i][k] = T{} + (i == k ? 1.0 : 0.0);
  }
  const T limit = 1e-34 * Contract(tensor, tensor);
  for (int sweep = 0; sweep < 8; ++sweep) {  // four or five do
    MaskOf<T> turned = JacobiRotate<kAxes>(limit, 0, 1, a, xy, xz, yz, out->axis);
    turned = turned | JacobiRotate<kAxes>(limit, 0, 2, a, xz, xy, yz, out->axis);
    turned = turned | JacobiRotate<kAxes>(limit, 1, 2, a, yz, xy, xz, out->axis);
    if (!Any(turned)) break;
  }
  PutInOrder<kAxes>(0, 1, out);
  PutInOrder<kAxes>(1, 2, out);
  PutInOrder<kAxes>(0, 1, out);
}

/// The values alone, the largest first.
template <class T>
CDEM_HD_CALL void PrincipalValues(const T *tensor, T *value) {
  Principal<T> principal;
  FindPrincipal<false>(tensor, &principal);
  CDEM_UNROLL for (int i = 0; i < 3; ++i) value[i] = principal.value[i];
}

/// J2 of a stress. [in] mean: a third of its trace.
template <class T>
CDEM_HD T SecondInvariant(const T stress[6], T mean) {
  const T x = stress[kXX] - mean, y = stress[kYY] - mean, z = stress[kZZ] - mean;
  return 0.5 * (x * x + y * y + z * z) + stress[kXY] * stress[kXY] + stress[kYZ] * stress[kYZ] +
         stress[kXZ] * stress[kXZ];
}

}  // namespace cdem
