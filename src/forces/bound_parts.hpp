// What the bound of the critical step and the scaling of masses share: the highest frequency of an element and of the springs
// of a node, from above. For step_bound.cxx and scale_masses.cxx only.
#pragma once
#include "forces/bodies.hpp"
#include "forces/tables.hpp"
#include "mesh/geometry.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace cdem {

/// An element moved to its first corner and rounded to 2^-32 of its size: congruent elements become equal to the last
/// bit, on any rank, and are looked at once. What the rounding can change is covered by kRoundingMargin.
struct Canonical {
  double x[8][3];
  double lambda, mu, density;
};
constexpr double kRoundingMargin = 1 + 1e-7;

void MakeCanonical(const Tables &tables, const ElementTable &t, const std::vector<Material> &materials, int e,
                   Canonical *c);
/// The same for elements that are congruent.
std::uint64_t Hash(const Canonical &c, int corners);

/// ||A||_F^2 of a matrix of lanes.
template <int n>
Lanes Norm2(const Lanes (*a)[n]) {
  Lanes sum{};
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) sum += a[i][j] * a[i][j];
  return sum;
}

/// A^16 of A = M_e^(-1/2) K_e M_e^(-1/2) over its trace, of kLanes elements: rows of lanes. [out] trace: of A. NULL where
/// a lower power shows already that no bound of LanesBound will be above floor [1/s^2]: they fall from power to power.
template <class Form>
Lanes (*Power16(const Canonical *batch, Lanes *trace, double floor = 0))[3 * Form::kCorners] {
  constexpr int corners = Form::kCorners, n = 3 * corners;
  Lanes x[corners][3], param[kMaxParams], scale[corners], u[corners][3] = {}, f[corners][3];
  for (int p = 0; p < kMaxParams; ++p) param[p] = Lanes{};
  for (int l = 0; l < kLanes; ++l) {
    double volume[8];
    CornerVolumes(Form::kShape, batch[l].x, volume);
    for (int a = 0; a < corners; ++a) {
      for (int k = 0; k < 3; ++k) x[a][k][l] = batch[l].x[a][k];
      scale[a][l] = 1 / std::sqrt(batch[l].density * volume[a]);
    }
    param[Elastic::kLambda][l] = batch[l].lambda;
    param[Elastic::kMu][l] = batch[l].mu;
  }
  static thread_local Lanes a[n][n], b[n][n];
  *trace = Lanes{};
  for (int j = 0; j < n; ++j) {
    u[j / 3][j % 3] = scale[j / 3];
    ElementForce<Form, Elastic, false, Lanes>(x, u, param, f, nullptr);
    u[j / 3][j % 3] = Lanes{};
    for (int i = 0; i < n; ++i) a[i][j] = f[i / 3][i % 3] * scale[i / 3];
    *trace += a[j][j];
  }
  for (auto &row : a)
    for (Lanes &entry : row) entry /= *trace;  // all eigenvalues in [0, 1]: the powers stay in range
  Lanes enough = floor / (kRoundingMargin * (1 + 1e-9) * *trace);  // for ||A^k||_F^(1/k)
  for (int power = 0; power < 4; ++power) {
    enough *= enough;
    if (floor > 0 && !Any(Norm2<n>(a) > enough)) return nullptr;
    for (int i = 0; i < n; ++i)
      for (int j = i; j < n; ++j) {
        Lanes sum{};
        for (int k = 0; k < n; ++k) sum += a[i][k] * a[j][k];
        b[i][j] = b[j][i] = sum;
      }
    std::copy(&b[0][0], &b[0][0] + n * n, &a[0][0]);
  }
  return a;
}

/// Upper bounds of lambda_max(K_e, M_e) of kLanes elements; 0 where it is clear before that none is above floor.
template <class Form>
Lanes LanesBound(const Canonical *batch, double floor = 0) {
  constexpr int n = 3 * Form::kCorners;
  Lanes trace, bound{};
  const Lanes(*a)[n] = Power16<Form>(batch, &trace, floor);
  if (!a) return bound;
  const Lanes sum = Norm2<n>(a);
  for (int l = 0; l < kLanes; ++l) bound[l] = trace[l] * std::pow(sum[l], 1.0 / 32) * kRoundingMargin;
  return bound;
}

/// lambda_max of a symmetric 3x3 matrix from above: ||A^256||_F^(1/256), at most 0.3 % too large.
/// [out] mode: the longest column of A^256, of length 1; may be NULL.
double LargestEigenvalue(const std::array<double, 6> &s, double *mode = nullptr);
/// The same of kLanes matrices, none of them 0.
Lanes LargestEigenvalues(const std::array<double, 6> *s);
/// S_a of every owned node: the sum over its springs of K_n n n^T + K_s (1 - n n^T) [N/m], in the order of small.hpp.
std::vector<std::array<double, 6>> SpringStiffness(const Tables &tables);
/// The same of one owned node.
std::array<double, 6> SpringStiffness(const Tables &tables, int node);

}  // namespace cdem
