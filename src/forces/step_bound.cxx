#include "forces/step_bound.hpp"

#include "core/events.hpp"
#include "forces/bound_parts.hpp"

#include <limits>
#include <unordered_set>

namespace cdem {

double CriticalStep(double w2, double beta) {
  if (w2 <= 0) return std::numeric_limits<double>::infinity();
  const double w = std::sqrt(w2), x = 0.5 * beta * w;
  return 2 / w * (std::sqrt(1 + x * x) - x);
}

namespace {

/// The largest upper bound of lambda_max(K_e, M_e) so far, and the first element that has it.
struct Top {
  double w2 = 0;
  int element = -1;
};

/// Looks at kLanes elements.
template <class Form>
void LookAt(const Canonical *batch, const int *element, Top *top) {
  const Lanes bound = LanesBound<Form>(batch, top->w2);
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

/// The largest sum of |entries| of a row of a symmetric matrix: no eigenvalue is above it.
double LargestRow(const std::array<double, 6> &s) {
  const double xy = std::fabs(s[kXY]), yz = std::fabs(s[kYZ]), xz = std::fabs(s[kXZ]);
  return std::max({s[kXX] + xy + xz, s[kYY] + xy + yz, s[kZZ] + xz + yz});
}
constexpr double kAboveRows = 1.0022;  ///< LargestEigenvalue is at most 3^(1/512) too large

/// The largest 2 lambda_max(S_a)/m_a of the owned nodes, and the first node that has it.
double SpringBound(const Tables &tables, int *node) {
  *node = -1;
  if (tables.springs.empty()) return 0;
  const std::vector<std::array<double, 6>> sum = SpringStiffness(tables);
  double largest = 0;
  std::array<double, 6> batch[kLanes];
  int at[kLanes], filled = 0;
  const auto look = [&] {
    std::fill(batch + filled, batch + kLanes, batch[0]);
    const Lanes lambda = LargestEigenvalues(batch);
    for (int l = 0; l < filled; ++l) {
      const double w2 = 2 * lambda[l] * tables.inverse_mass[at[l]];
      if (w2 > largest) largest = w2, *node = at[l];
    }
    filled = 0;
  };
  for (int i = 0; i < tables.n_owned; ++i) {
    if (2 * kAboveRows * LargestRow(sum[i]) * tables.inverse_mass[i] <= largest) continue;  // most nodes end here
    batch[filled] = sum[i];
    at[filled++] = i;
    if (filled == kLanes) look();
  }
  if (filled > 0) look();
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
  LargestEigenvalue(SpringStiffness(tables, node), mode);
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

}  // namespace cdem
