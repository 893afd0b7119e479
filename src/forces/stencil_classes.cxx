#include "forces/stencil_classes.hpp"

#include "forces/stencil.hpp"

#include <algorithm>

namespace cdem {
namespace {

constexpr double kShift = 0.25;

/// A power of two near a length; lengths that people choose are not at its edges.
double SizeNear(double length) {
  int exponent = 0;
  std::frexp(1.37 * length, &exponent);
  return std::ldexp(1.0, exponent);
}

template <class SignOf>
AlikeElements Find(int n, int stride, SignOf &&sign_of) {
  AlikeElements alike;
  BySign<int> classes;
  for (int i = 0; i < n; i += stride) {
    const auto [at, fresh] = classes.emplace(sign_of(i), static_cast<int>(alike.first.size()));
    if (fresh) alike.first.push_back(i);
    alike.of.push_back(at->second);
  }
  return alike;
}

}  // namespace

std::int64_t Steps(double x, double size) {
  return static_cast<std::int64_t>(std::floor(x / (size * kCongruent) + kShift));
}

std::int64_t RelativeSteps(double x) {
  if (x == 0) return 0;
  const double size = SizeNear(std::fabs(x));
  int exponent = 0;
  std::frexp(size, &exponent);
  return Steps(x, size) + (std::int64_t{1} << 48) * exponent;
}

AlikeElements FindAlike(const Tables &tables, const ElementTable &t, int stride) {
  return Find(t.n, stride, [&](int e) {
    Sign128 sign;
    sign.Add(t.material[e]);
    const double *x0 = &tables.x[3 * static_cast<std::size_t>(t.Node(0, e))];
    double edge[24], longest = 0;
    for (int a = 1; a < t.corners; ++a) {
      const double *x = &tables.x[3 * static_cast<std::size_t>(t.Node(a, e))];
      for (int k = 0; k < 3; ++k) {
        edge[3 * a + k] = x[k] - x0[k];
        longest = std::max(longest, std::fabs(edge[3 * a + k]));
      }
    }
    const double size = SizeNear(longest);
    for (int k = 3; k < 3 * t.corners; ++k) sign.Add(Steps(edge[k], size));
    return sign;
  });
}

AlikeElements FindAlike(const SpringTable &t) {
  const std::size_t stride = t.n_pad;
  return Find(t.n, 1, [&](int i) {
    Sign128 sign;
    sign.Add(RelativeSteps(t.kn[i]));
    sign.Add(RelativeSteps(t.ks[i]));
    for (int k = 0; k < 3; ++k) sign.Add(Steps(t.normal[k * stride + i], 1));
    return sign;
  });
}

}  // namespace cdem
