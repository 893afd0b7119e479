#include "forces/host_audit.hpp"

#include "core/order_free_sum.hpp"
#include "forces/element_audit.hpp"
#include "forces/node_audit.hpp"
#include "forces/observe.hpp"
#include "forces/release.hpp"
#include "forces/spring_audit.hpp"

namespace cdem {

namespace {

/// The parts of the sums that lie at nodes.
struct AtNodes {
  std::vector<double> kinetic, weight;  // [n_owned]
};

template <class Has>
void OfNodes(const Tables &t, const NodeView &view, const StepArgs &next, const std::vector<double> &f,
             AuditArrays *arrays, AtNodes *at) {
  const NodeWorks works = {arrays->node.data(), arrays->row.data(), t.records.n};
  for (int i = 0; i < t.n_owned; ++i) {
    double now[3];
    const double *force = &f[3 * static_cast<std::size_t>(i)];
    at->kinetic[i] =
        ObserveNode<Has::kRecords, Has::kQuiet, Has::kDamped>(view, next, i, t.mass[i], force, force, now).half;
    AuditNode<Has::kRecords, Has::kQuiet, Has::kDamped>(view, next, i, 0, t.mass[i], force, true, works);
    const double mass = t.weight.empty() ? t.mass[i] : t.mass[i] * t.weight[i];
    at->weight[i] = mass * Dot(next.gravity, view.u + 3 * static_cast<std::ptrdiff_t>(i));
  }
}

}  // namespace

PetscErrorCode AuditOnHost(const Tables &t, int n_owned_cells, const NodeView &nodes, const Histories &history,
                           const AuditArrays &arrays, const StepArgs &next, AuditSums *sums) {
  PetscFunctionBeginUser;
  Histories after = history;
  AuditArrays sum = arrays;
  const AuditPass pass{&sum, next.dt_old, next.dt, true};
  std::vector<double> f(3 * static_cast<std::size_t>(t.n_local), 0.0), unused(f);
  HostElements(t, nodes.u, nodes.v, t.beta, 0, after.elements, f.data(), &pass);
  if (t.releases) {
    std::vector<std::uint8_t> released;
    PetscCall(ReleaseSprings(t, after.elements, &released, &after.springs));
  }
  std::vector<double> strain(n_owned_cells, 0.0);
  ElementResults elements;
  SpringResults springs;
  elements.each = strain.data();
  springs.want_energies = true;
  HostElementsObserve(t, n_owned_cells, nodes.u, nodes.v, 0, history.elements, unused.data(), &elements);
  HostSpringsObserve(t, nodes.u, nodes.v, 0, after.springs, unused.data(), &springs);
  HostSprings(t, nodes.u, nodes.v, t.beta, after.springs, f.data(), &pass);
  AtNodes at;
  at.kinetic.resize(t.n_owned);
  at.weight.resize(t.n_owned);
  VisitNodes(t, [&](auto has) { OfNodes<decltype(has)>(t, nodes, next, f, &sum, &at); });

  std::vector<std::vector<Summands>> terms(kAuditTerms);
  const std::size_t owned = static_cast<std::size_t>(t.n_owned), rows = static_cast<std::size_t>(t.records.n);
  terms[kKineticSum].push_back({at.kinetic.data(), nullptr, owned});
  terms[kStrainSum].push_back({strain.data(), nullptr, strain.size()});
  terms[kWeightSum].push_back({at.weight.data(), nullptr, owned});
  std::vector<std::vector<std::uint8_t>> counted(t.elements.size());
  for (std::size_t g = 0; g < t.elements.size(); ++g) {
    const ElementTable &table = t.elements[g];
    for (int e = 0; e < table.n; ++e) counted[g].push_back(table.cell[e] < n_owned_cells);
    for (int k = 0; k < kElementWorks && !sum.element[g].empty(); ++k)
      terms[kElementSums0 + k].push_back(
          {&sum.element[g][static_cast<std::size_t>(k) * table.n_pad], counted[g].data(), counted[g].size()});
  }
  for (std::size_t g = 0; g < t.springs.size(); ++g) {
    const SpringTable &table = t.springs[g];
    const std::size_t n = static_cast<std::size_t>(table.n);
    terms[kSpringSum].push_back({springs.each[g].data(), table.counted.data(), n});
    for (int k = 0; k < kSpringWorks && !sum.spring[g].empty(); ++k)
      terms[kSpringSums0 + k].push_back(
          {&sum.spring[g][static_cast<std::size_t>(k) * table.n_pad], table.counted.data(), n});
  }
  for (int k = 0; k < kNodeWorks; ++k) terms[kNodeSums0 + k].push_back({sum.node.data() + k * owned, nullptr, owned});
  for (int k = 0; k < kRowWorks; ++k) terms[kRowSums0 + k].push_back({sum.row.data() + k * rows, nullptr, rows});
  std::vector<double> s;
  PetscCall(SumInAnyOrder(t.comm, terms, &s));
  *sums = AuditSums::Of(s);
  PetscFunctionReturn(PETSC_SUCCESS);
}

}  // namespace cdem
