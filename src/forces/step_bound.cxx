#include "forces/step_bound.hpp"

#include "core/events.hpp"
#include "forces/bodies.hpp"
#include "mesh/geometry.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <unordered_map>
#include <unordered_set>

namespace cdem {

double CriticalStep(double w2, double beta) {
  if (w2 <= 0) return std::numeric_limits<double>::infinity();
  const double w = std::sqrt(w2), x = 0.5 * beta * w;
  return 2 / w * (std::sqrt(1 + x * x) - x);
}

namespace {

/// An element moved to its first corner and rounded to 2^-32 of its size: congruent elements become equal to the last
/// bit, on any rank, and are looked at once. What the rounding can change is covered by kRoundingMargin.
struct Canonical {
  double x[8][3];
  double lambda, mu, density;
};
constexpr double kRoundingMargin = 1 + 1e-7;

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

/// Upper bounds of lambda_max(K_e, M_e) of kLanes elements [out, if wanted]; returns the largest.
template <class Form>
double LanesBound(const Canonical *batch, double *each = nullptr) {
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
  Lanes trace{};
  for (int j = 0; j < n; ++j) {
    u[j / 3][j % 3] = scale[j / 3];
    ElementForce<Form, Elastic, false, Lanes>(x, u, param, f, nullptr);
    u[j / 3][j % 3] = Lanes{};
    for (int i = 0; i < n; ++i) a[i][j] = f[i / 3][i % 3] * scale[i / 3];
    trace += a[j][j];
  }
  for (auto &row : a)
    for (Lanes &entry : row) entry /= trace;  // all eigenvalues in [0, 1]: the powers stay in range
  for (int power = 0; power < 4; ++power) {
    for (int i = 0; i < n; ++i)
      for (int j = i; j < n; ++j) {
        Lanes sum{};
        for (int k = 0; k < n; ++k) sum += a[i][k] * a[j][k];
        b[i][j] = b[j][i] = sum;
      }
    std::copy(&b[0][0], &b[0][0] + n * n, &a[0][0]);
  }
  double largest = 0;
  for (int l = 0; l < kLanes; ++l) {
    double sum = 0;
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j) sum += a[i][j][l] * a[i][j][l];
    const double one = trace[l] * std::pow(sum, 1.0 / 32);
    if (each) each[l] = one * kRoundingMargin;
    largest = std::max(largest, one);
  }
  return largest * kRoundingMargin;
}

/// Forms that average their dilatation are bounded as if they did not, with the largest bulk modulus of those that they
/// average with: averaging is a contraction in the norm that volumes weigh, and so the energy only falls.
template <class Form>
double TableBound(const Tables &tables, const ElementTable &t, const std::vector<Material> &materials) {
  std::unordered_set<std::uint64_t> seen;
  Canonical batch[kLanes];
  int filled = 0;
  double largest = 0;
  for (int e = 0; e < t.n; ++e) {
    MakeCanonical(tables, t, materials, e, &batch[filled]);
    // a mesh without congruent elements soon shows it, and then needs no memory of what was seen
    const bool remember = e < 50000 || seen.size() < 25000;
    if (remember && !seen.insert(Hash(batch[filled], t.corners)).second) continue;
    if (++filled < kLanes) continue;
    largest = std::max(largest, LanesBound<Form>(batch));
    filled = 0;
  }
  if (filled > 0) {
    std::fill(batch + filled, batch + kLanes, batch[filled - 1]);
    largest = std::max(largest, LanesBound<Form>(batch));
  }
  return largest;
}

/// The bound of every element of a table [1/s^2]; congruent ones are looked at once.
template <class Form>
std::vector<double> EachBound(const Tables &tables, const ElementTable &t, const std::vector<Material> &materials) {
  std::unordered_map<std::uint64_t, int> classes;
  std::vector<int> of_element(t.n);
  std::vector<Canonical> kind;
  for (int e = 0; e < t.n; ++e) {
    Canonical c;
    MakeCanonical(tables, t, materials, e, &c);
    const auto [at, fresh] = classes.emplace(Hash(c, t.corners), static_cast<int>(kind.size()));
    if (fresh) kind.push_back(c);
    of_element[e] = at->second;
  }
  std::vector<double> bound(Padded(static_cast<int>(kind.size()))), each(t.n);
  kind.resize(bound.size(), kind.back());
  for (std::size_t i = 0; i < bound.size(); i += kLanes) LanesBound<Form>(&kind[i], &bound[i]);
  for (int e = 0; e < t.n; ++e) each[e] = bound[of_element[e]];
  return each;
}

/// lambda_max of a symmetric 3x3 matrix from above: ||A^256||_F^(1/256), at most 0.3 % too large.
double LargestEigenvalue(const std::array<double, 6> &s) {
  const double trace = s[kXX] + s[kYY] + s[kZZ];
  double a[3][3] = {{s[kXX], s[kXY], s[kXZ]}, {s[kXY], s[kYY], s[kYZ]}, {s[kXZ], s[kYZ], s[kZZ]}}, b[3][3],
         log_scale = 0;
  if (trace <= 0) return 0;
  double power = 1;
  for (int squaring = 0; squaring <= 8; ++squaring) {
    double norm2 = 0;
    for (auto &row : a)
      for (double entry : row) norm2 += entry * entry;
    const double norm = std::sqrt(norm2);
    log_scale += std::log(norm) / power;
    if (squaring == 8) break;
    for (auto &row : a)
      for (double &entry : row) entry /= norm;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) b[i][j] = a[i][0] * a[0][j] + a[i][1] * a[1][j] + a[i][2] * a[2][j];
    std::copy(&b[0][0], &b[0][0] + 9, &a[0][0]);
    power *= 2;
  }
  return std::exp(log_scale) * (1 + 1e-12);
}

/// S_a of every owned node [N/m].
std::vector<std::array<double, 6>> SpringStiffness(const Tables &tables) {
  std::vector<std::array<double, 6>> sum(tables.n_owned, std::array<double, 6>{});
  for (const SpringTable &t : tables.springs)
    for (int i = 0; i < t.n; ++i) {
      double n[3];
      for (int k = 0; k < 3; ++k) n[k] = t.normal[static_cast<std::size_t>(k) * t.n_pad + i];
      const double extra = t.kn[i] - t.ks[i];
      const double s[6] = {t.ks[i] + extra * n[0] * n[0], t.ks[i] + extra * n[1] * n[1], t.ks[i] + extra * n[2] * n[2],
                           extra * n[0] * n[1],           extra * n[1] * n[2],           extra * n[0] * n[2]};
      for (int node : {t.a[i], t.b[i]})
        if (node < tables.n_owned)
          for (int k = 0; k < 6; ++k) sum[node][k] += s[k];
    }
  return sum;
}

double SpringBound(const Tables &tables) {
  if (tables.springs.empty()) return 0;
  const std::vector<std::array<double, 6>> sum = SpringStiffness(tables);
  double largest = 0;
  for (int i = 0; i < tables.n_owned; ++i) {
    const double trace = sum[i][kXX] + sum[i][kYY] + sum[i][kZZ];
    if (2 * trace * tables.inverse_mass[i] > largest)  // the trace bounds the eigenvalue: most nodes end here
      largest = std::max(largest, 2 * LargestEigenvalue(sum[i]) * tables.inverse_mass[i]);
  }
  return largest;
}

}  // namespace

PetscErrorCode ComputeStepBound(const Tables &tables, const std::vector<Material> &materials, StepBound *bound) {
  PetscFunctionBeginUser;
  PetscCall(PetscLogEventBegin(events.bound, nullptr, nullptr, nullptr, nullptr));
  double w2[2] = {0, SpringBound(tables)};
  for (const ElementTable &t : tables.elements)
    VisitElement(t.shape, t.form,
                 [&](auto form) { w2[0] = std::max(w2[0], TableBound<decltype(form)>(tables, t, materials)); });
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, w2, 2, MPI_DOUBLE, MPI_MAX, tables.comm));
  bound->element_w2 = w2[0];
  bound->spring_w2 = w2[1];
  bound->dt = CriticalStep(w2[0] + w2[1], tables.beta);
  PetscCall(PetscLogEventEnd(events.bound, nullptr, nullptr, nullptr, nullptr));
  PetscFunctionReturn(PETSC_SUCCESS);
}

void ScaleMasses(const std::vector<Material> &materials, double w2, Tables *tables) {
  std::vector<double> scaled(tables->n_owned, 0.0);
  for (const ElementTable &t : tables->elements)
    VisitElement(t.shape, t.form, [&](auto form) {
      const std::vector<double> each = EachBound<decltype(form)>(*tables, t, materials);
      for (int e = 0; e < t.n; ++e) {
        double x[kMaxCorners][3], volume[kMaxCorners];
        for (int a = 0; a < t.corners; ++a)
          std::copy_n(&tables->x[3 * static_cast<std::size_t>(t.Node(a, e))], 3, x[a]);
        CornerVolumes(t.shape, x, volume);
        for (int a = 0; a < t.corners; ++a)
          if (t.Node(a, e) < tables->n_owned)
            scaled[t.Node(a, e)] += each[e] / w2 * materials[t.region[e]].density * volume[a];
      }
    });
  if (!tables->springs.empty()) {
    const std::vector<std::array<double, 6>> sum = SpringStiffness(*tables);
    for (int i = 0; i < tables->n_owned; ++i) scaled[i] += 2 * LargestEigenvalue(sum[i]) / w2;
  }
  tables->weight.assign(tables->n_owned, 0.0);
  for (int i = 0; i < tables->n_owned; ++i) {
    if (tables->mass[i] == 0) continue;
    tables->weight[i] = tables->mass[i] / scaled[i];
    tables->mass[i] = scaled[i];
    tables->inverse_mass[i] = 1 / scaled[i];
  }
}

}  // namespace cdem
