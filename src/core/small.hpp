// Three-vectors and symmetric tensors on any number type, as plain arrays.
#pragma once
#include "core/host_device.hpp"

namespace cdem {

/// Order of the components of a symmetric tensor, in memory and in files.
enum { kXX, kYY, kZZ, kXY, kYZ, kXZ };

template <class T>
CDEM_HD void Cross(const T a[3], const T b[3], T c[3]) {
  c[0] = a[1] * b[2] - a[2] * b[1];
  c[1] = a[2] * b[0] - a[0] * b[2];
  c[2] = a[0] * b[1] - a[1] * b[0];
}

template <class T>
CDEM_HD T Dot(const T a[3], const T b[3]) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/// out = s a for a symmetric tensor s.
template <class T>
CDEM_HD void Apply(const T s[6], const T a[3], T out[3]) {
  out[0] = s[kXX] * a[0] + s[kXY] * a[1] + s[kXZ] * a[2];
  out[1] = s[kXY] * a[0] + s[kYY] * a[1] + s[kYZ] * a[2];
  out[2] = s[kXZ] * a[0] + s[kYZ] * a[1] + s[kZZ] * a[2];
}

/// out += s a.
template <class T>
CDEM_HD void ApplyAdd(const T s[6], const T a[3], T out[3]) {
  out[0] += s[kXX] * a[0] + s[kXY] * a[1] + s[kXZ] * a[2];
  out[1] += s[kXY] * a[0] + s[kYY] * a[1] + s[kYZ] * a[2];
  out[2] += s[kXZ] * a[0] + s[kYZ] * a[1] + s[kZZ] * a[2];
}

/// s : e of two symmetric tensors, e with its true (not engineering) shears.
template <class T>
CDEM_HD T Contract(const T s[6], const T e[6]) {
  return s[kXX] * e[kXX] + s[kYY] * e[kYY] + s[kZZ] * e[kZZ] +
         2.0 * (s[kXY] * e[kXY] + s[kYZ] * e[kYZ] + s[kXZ] * e[kXZ]);
}

/// strain = sym(sum_i d[i] (x) a[i]) * scale, from three derivative columns d and cofactor columns a.
template <class T>
CDEM_HD void StrainOf(const T d0[3], const T d1[3], const T d2[3], const T a0[3], const T a1[3], const T a2[3], T scale,
                      T strain[6]) {
  T half = 0.5 * scale;
  strain[kXX] = (d0[0] * a0[0] + d1[0] * a1[0] + d2[0] * a2[0]) * scale;
  strain[kYY] = (d0[1] * a0[1] + d1[1] * a1[1] + d2[1] * a2[1]) * scale;
  strain[kZZ] = (d0[2] * a0[2] + d1[2] * a1[2] + d2[2] * a2[2]) * scale;
  strain[kXY] = (d0[0] * a0[1] + d1[0] * a1[1] + d2[0] * a2[1] + d0[1] * a0[0] + d1[1] * a1[0] + d2[1] * a2[0]) * half;
  strain[kYZ] = (d0[1] * a0[2] + d1[1] * a1[2] + d2[1] * a2[2] + d0[2] * a0[1] + d1[2] * a1[1] + d2[2] * a2[1]) * half;
  strain[kXZ] = (d0[0] * a0[2] + d1[0] * a1[2] + d2[0] * a2[2] + d0[2] * a0[0] + d1[2] * a1[0] + d2[2] * a2[0]) * half;
}

}  // namespace cdem
