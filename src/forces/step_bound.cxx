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

/// A^16 of A = M_e^(-1/2) K_e M_e^(-1/2) over its trace, of kLanes elements: rows of lanes. [out] trace: of A.
template <class Form>
Lanes (*Power16(const Canonical *batch, Lanes *trace))[3 * Form::kCorners] {
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
  for (int power = 0; power < 4; ++power) {
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

/// The largest upper bound of lambda_max(K_e, M_e) so far, and the first element that has it.
struct Top {
  double w2 = 0;
  int element = -1;
};

/// Upper bounds of lambda_max(K_e, M_e) of kLanes elements.
template <class Form>
Lanes LanesBound(const Canonical *batch) {
  constexpr int n = 3 * Form::kCorners;
  Lanes trace, bound;
  const Lanes(*a)[n] = Power16<Form>(batch, &trace);
  for (int l = 0; l < kLanes; ++l) {
    double sum = 0;
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j) sum += a[i][j][l] * a[i][j][l];
    bound[l] = trace[l] * std::pow(sum, 1.0 / 32) * kRoundingMargin;
  }
  return bound;
}

/// Looks at kLanes elements.
template <class Form>
void LookAt(const Canonical *batch, const int *element, Top *top) {
  const Lanes bound = LanesBound<Form>(batch);
  for (int l = 0; l < kLanes; ++l)
    if (bound[l] > top->w2) *top = {bound[l], element[l]};
}

/// Forms that average their dilatation are bounded as if they did not, with the largest bulk modulus of those that they
/// average with: averaging is a contraction in the norm that volumes weigh, and so the energy only falls.
template <class Form>
Top TableBound(const Tables &tables, const ElementTable &t, const std::vector<Material> &materials) {
  std::unordered_set<std::uint64_t> seen;
  Canonical batch[kLanes];
  int filled = 0, element[kLanes];
  Top top;
  for (int e = 0; e < t.n; ++e) {
    MakeCanonical(tables, t, materials, e, &batch[filled]);
    // a mesh without congruent elements soon shows it, and then needs no memory of what was seen
    const bool remember = e < 50000 || seen.size() < 25000;
    if (remember && !seen.insert(Hash(batch[filled], t.corners)).second) continue;
    element[filled] = e;
    if (++filled < kLanes) continue;
    LookAt<Form>(batch, element, &top);
    filled = 0;
  }
  if (filled > 0) {
    std::fill(batch + filled, batch + kLanes, batch[filled - 1]);
    std::fill(element + filled, element + kLanes, element[filled - 1]);
    LookAt<Form>(batch, element, &top);
  }
  return top;
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
  for (std::size_t i = 0; i < bound.size(); i += kLanes) {
    const Lanes w2 = LanesBound<Form>(&kind[i]);
    for (int l = 0; l < kLanes; ++l) bound[i + l] = w2[l];
  }
  for (int e = 0; e < t.n; ++e) each[e] = bound[of_element[e]];
  return each;
}

/// lambda_max of a symmetric 3x3 matrix from above: ||A^256||_F^(1/256), at most 0.3 % too large.
/// [out] mode: the longest column of A^256, of length 1; may be NULL.
double LargestEigenvalue(const std::array<double, 6> &s, double *mode = nullptr) {
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
  if (mode) {
    int j = 0;
    for (int k = 1; k < 3; ++k)
      if (a[k][k] > a[j][j]) j = k;
    const double length = std::sqrt(Dot(a[j], a[j]));
    for (int k = 0; k < 3; ++k) mode[k] = a[j][k] / length;
  }
  return std::exp(log_scale) * (1 + 1e-12);
}

/// Adds K_n n n^T + K_s (1 - n n^T) of a spring.
void AddSpring(const SpringTable &t, int i, std::array<double, 6> *sum) {
  double n[3];
  for (int k = 0; k < 3; ++k) n[k] = t.normal[static_cast<std::size_t>(k) * t.n_pad + i];
  const double extra = t.kn[i] - t.ks[i];
  const double s[6] = {t.ks[i] + extra * n[0] * n[0], t.ks[i] + extra * n[1] * n[1], t.ks[i] + extra * n[2] * n[2],
                       extra * n[0] * n[1],           extra * n[1] * n[2],           extra * n[0] * n[2]};
  for (int k = 0; k < 6; ++k) (*sum)[k] += s[k];
}

/// The largest 2 lambda_max(S_a)/m_a of the owned nodes, and the first node that has it.
double SpringBound(const Tables &tables, int *node) {
  *node = -1;
  if (tables.springs.empty()) return 0;
  std::vector<std::array<double, 6>> sum(tables.n_owned, std::array<double, 6>{});
  for (const SpringTable &t : tables.springs)
    for (int i = 0; i < t.n; ++i)
      for (int end : {t.a[i], t.b[i]})
        if (end < tables.n_owned) AddSpring(t, i, &sum[end]);
  double largest = 0;
  for (int i = 0; i < tables.n_owned; ++i) {
    const double trace = sum[i][kXX] + sum[i][kYY] + sum[i][kZZ];
    if (2 * trace * tables.inverse_mass[i] <= largest) continue;  // it bounds the eigenvalue: most nodes end here
    const double w2 = 2 * LargestEigenvalue(sum[i]) * tables.inverse_mass[i];
    if (w2 > largest) largest = w2, *node = i;
  }
  return largest;
}

}  // namespace

void ElementMode(const Tables &tables, const std::vector<Material> &materials, const ElementTable &t, int e,
                 double (*mode)[3]) {
  Canonical batch[kLanes];
  MakeCanonical(tables, t, materials, e, &batch[0]);
  std::fill(batch + 1, batch + kLanes, batch[0]);
  VisitElement(t.shape, t.form, [&](auto form) {
    using Form = decltype(form);
    constexpr int n = 3 * Form::kCorners;
    Lanes trace;
    const Lanes(*a)[n] = Power16<Form>(batch, &trace);
    int j = 0;
    for (int i = 1; i < n; ++i)
      if (a[i][i][0] > a[j][j][0]) j = i;
    double length2 = 0;
    for (int i = 0; i < n; ++i) length2 += a[j][i][0] * a[j][i][0];
    for (int i = 0; i < n; ++i) mode[i / 3][i % 3] = a[j][i][0] / std::sqrt(length2);
  });
}

void SpringMode(const Tables &tables, int node, double mode[3]) {
  std::array<double, 6> sum{};
  for (const SpringTable &t : tables.springs)
    for (int i = 0; i < t.n; ++i)
      for (int end : {t.a[i], t.b[i]})
        if (end == node) AddSpring(t, i, &sum);
  LargestEigenvalue(sum, mode);
}

PetscErrorCode ComputeStepBound(const Tables &tables, const std::vector<Material> &materials, StepBound *bound) {
  PetscFunctionBeginUser;
  PetscCall(PetscLogEventBegin(events.bound, nullptr, nullptr, nullptr, nullptr));
  *bound = StepBound();
  double here[2] = {0, SpringBound(tables, &bound->node)};
  std::vector<Top> top(tables.elements.size());
  for (std::size_t g = 0; g < top.size(); ++g) {
    const ElementTable &t = tables.elements[g];
    VisitElement(t.shape, t.form, [&](auto form) { top[g] = TableBound<decltype(form)>(tables, t, materials); });
    here[0] = std::max(here[0], top[g].w2);
  }
  double w2[2];
  PetscCallMPI(MPI_Allreduce(here, w2, 2, MPI_DOUBLE, MPI_MAX, tables.comm));
  bound->element_w2 = w2[0];
  bound->spring_w2 = w2[1];
  bound->dt = CriticalStep(bound->w2(), tables.beta);
  for (const Top &t : top) bound->element.push_back(t.w2 == w2[0] ? t.element : -1);
  if (here[1] < w2[1]) bound->node = -1;
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
    std::vector<std::array<double, 6>> sum(tables->n_owned, std::array<double, 6>{});
    for (const SpringTable &t : tables->springs)
      for (int i = 0; i < t.n; ++i)
        for (int end : {t.a[i], t.b[i]})
          if (end < tables->n_owned) AddSpring(t, i, &sum[end]);
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
