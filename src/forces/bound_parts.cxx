#include "forces/bound_parts.hpp"

namespace cdem {

void MakeCanonical(const Tables &tables, const ElementTable &t, const std::vector<Material> &materials, int e,
                   Canonical *c) {
  double size = 0;
  const double *x0 = &tables.x[3 * static_cast<std::size_t>(t.node[e])];
  for (int a = 0; a < t.corners; ++a)
    for (int k = 0; k < 3; ++k) {
      c->x[a][k] =
          tables.x[3 * static_cast<std::size_t>(t.node[static_cast<std::size_t>(a) * t.n_pad + e]) + k] - x0[k];
      size = std::max(size, std::fabs(c->x[a][k]));
    }
  const double grid = std::ldexp(1.0, std::ilogb(size) - 32);
  for (int a = 0; a < t.corners; ++a)
    for (int k = 0; k < 3; ++k) c->x[a][k] = std::nearbyint(c->x[a][k] / grid) * grid + 0.0;
  const double *param = &tables.block_param[static_cast<std::size_t>(kMaxParams) * t.material[e]];
  c->lambda = param[0];
  c->mu = param[1];
  if (t.averages) c->lambda = tables.layer_bulk[t.layer[e]] - 2.0 / 3 * c->mu;
  c->density = materials[t.region[e]].density;
}

std::uint64_t Hash(const Canonical &c, int corners) {
  std::uint64_t h = 0x9e3779b97f4a7c15ULL;
  auto mix = [&](double value) {
    std::uint64_t bits;
    __builtin_memcpy(&bits, &value, sizeof bits);
    h = (h ^ bits) * 0xff51afd7ed558ccdULL;
    h ^= h >> 32;
  };
  for (int a = 0; a < corners; ++a)
    for (int k = 0; k < 3; ++k) mix(c.x[a][k]);
  for (double value : {c.lambda, c.mu, c.density}) mix(value);
  return h;
}

/// ||A^256||_F^(1/256) of a symmetric matrix that is not 0. [out] a: A^256 times some number.
template <class T>
static T PowerNorm(const T s[6], T a[3][3]) {
  constexpr int squarings = 8;
  T norm[squarings + 1], b[3][3];
  a[0][0] = s[kXX], a[1][1] = s[kYY], a[2][2] = s[kZZ];
  a[0][1] = a[1][0] = s[kXY], a[1][2] = a[2][1] = s[kYZ], a[0][2] = a[2][0] = s[kXZ];
  for (int power = 0;; ++power) {
    T sum{};
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) sum += a[i][j] * a[i][j];
    norm[power] = Sqrt(sum);
    if (power == squarings) break;
    const T scale = 1 / norm[power];
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) a[i][j] *= scale;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) b[i][j] = a[i][0] * a[0][j] + a[i][1] * a[1][j] + a[i][2] * a[2][j];
    std::copy(&b[0][0], &b[0][0] + 9, &a[0][0]);
  }
  T root = norm[squarings];
  for (int power = squarings; power-- > 0;) root = norm[power] * Sqrt(root);
  return root * (1 + 1e-12);
}

double LargestEigenvalue(const std::array<double, 6> &s, double *mode) {
  if (s[kXX] + s[kYY] + s[kZZ] <= 0) return 0;
  double a[3][3];
  const double largest = PowerNorm(s.data(), a);
  if (mode) {
    int j = 0;
    for (int k = 1; k < 3; ++k)
      if (a[k][k] > a[j][j]) j = k;
    const double length = std::sqrt(Dot(a[j], a[j]));
    for (int k = 0; k < 3; ++k) mode[k] = a[j][k] / length;
  }
  return largest;
}

Lanes LargestEigenvalues(const std::array<double, 6> *s) {
  Lanes of_lanes[6], a[3][3];
  for (int k = 0; k < 6; ++k)
    for (int l = 0; l < kLanes; ++l) of_lanes[k][l] = s[l][k];
  return PowerNorm(of_lanes, a);
}

/// Adds K_n n n^T + K_s (1 - n n^T) of a spring.
static void AddSpring(const SpringTable &t, int i, std::array<double, 6> *sum) {
  double n[3];
  for (int k = 0; k < 3; ++k) n[k] = t.normal[static_cast<std::size_t>(k) * t.n_pad + i];
  const double extra = t.kn[i] - t.ks[i];
  const double s[6] = {t.ks[i] + extra * n[0] * n[0], t.ks[i] + extra * n[1] * n[1], t.ks[i] + extra * n[2] * n[2],
                       extra * n[0] * n[1],           extra * n[1] * n[2],           extra * n[0] * n[2]};
  for (int k = 0; k < 6; ++k) (*sum)[k] += s[k];
}

std::vector<std::array<double, 6>> SpringStiffness(const Tables &tables) {
  std::vector<std::array<double, 6>> sum(tables.n_owned, std::array<double, 6>{});
  for (const SpringTable &t : tables.springs)
    for (int i = 0; i < t.n; ++i)
      for (int end : {t.a[i], t.b[i]})
        if (end < tables.n_owned) AddSpring(t, i, &sum[end]);
  return sum;
}

std::array<double, 6> SpringStiffness(const Tables &tables, int node) {
  std::array<double, 6> sum{};
  for (const SpringTable &t : tables.springs)
    for (int i = 0; i < t.n; ++i)
      if (t.a[i] == node || t.b[i] == node) AddSpring(t, i, &sum);
  return sum;
}

}  // namespace cdem
