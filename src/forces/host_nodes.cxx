// Compiled without contraction (CMakeLists.txt): a rank has the instance for what its own nodes carry, and all of them
// must round alike.
#include "forces/host_passes.hpp"
#include "forces/node_audit.hpp"

#include <cmath>
#include <utility>

namespace cdem {

namespace {

/// Whether none of the kLanes nodes from i on has a record.
bool AreFree(const NodeView &nodes, int i) {
  int all = -1;
  for (int l = 0; l < kLanes; ++l) all &= nodes.record[i + l];
  return all == -1;
}

/// Number kLanes c + l of three times kLanes ones belongs to node (kLanes c + l) / 3 of the lanes.
template <int c, int... l>
Lanes OfNodes(Lanes each, std::integer_sequence<int, l...>) {
  return __builtin_shuffle(each, decltype(LaneMask{}){(kLanes * c + l) / 3 ...});
}

/// NodeStep of kLanes nodes from i on that have neither records nor damping of their own, with its rounding. [in] gravity:
/// component by component. Returns false when a velocity may be of unreasonable size.
template <int... c>
bool FreeNodes(const NodeView &nodes, const StepArgs &args, int i, const double *f, const Lanes (&gravity)[3],
               std::integer_sequence<int, c...>) {
  constexpr auto lanes = std::make_integer_sequence<int, kLanes>{};
  const Lanes inverse_mass = LoadAs<Lanes>(nodes.inverse_mass + i);
  LaneMask fine = LaneMask{} == LaneMask{};
  const auto three = [&](int part, Lanes inverse) {
    const std::ptrdiff_t at = 3 * static_cast<std::ptrdiff_t>(i) + kLanes * part;
    const Lanes a = -LoadAs<Lanes>(f + at) * inverse + gravity[part];
    const Lanes v = args.keep * LoadAs<Lanes>(nodes.v + at) + args.kick * a;
    StoreAs(nodes.v + at, v);
    StoreAs(nodes.u + at, LoadAs<Lanes>(nodes.u + at) + args.dt * v);
    fine &= (v < 0 ? -v : v) < 1e99;
  };
  (three(c, OfNodes<c>(inverse_mass, lanes)), ...);
  return !Any(~fine);
}

bool IsReasonable(const double v[3]) { return std::fabs(v[0]) + std::fabs(v[1]) + std::fabs(v[2]) < 1e100; }

}  // namespace

int HostNodes(const Tables &tables, const NodeView &nodes, const StepArgs &args, int step, const double *f) {
  Lanes gravity[3];
  for (int c = 0; c < 3; ++c)
    for (int l = 0; l < kLanes; ++l) gravity[c][l] = args.gravity[(kLanes * c + l) % 3];
  return VisitNodes(tables, [&](auto has) {
    int bad = -1;
    for (int i = 0; i < tables.n_owned;) {
      if (!has.kDamped && i + kLanes <= tables.n_owned && (!has.kRecords || AreFree(nodes, i))) {
        const bool fine = FreeNodes(nodes, args, i, f, gravity, std::make_integer_sequence<int, 3>{});
        for (int l = 0; !fine && bad < 0 && l < kLanes; ++l)
          if (!IsReasonable(nodes.v + 3 * static_cast<std::ptrdiff_t>(i + l))) bad = i + l;
        i += kLanes;
        continue;
      }
      if (!NodeStep<has.kRecords, has.kQuiet, has.kDamped>(nodes, args, i, step,
                                                           f + 3 * static_cast<std::ptrdiff_t>(i)) &&
          bad < 0)
        bad = i;
      ++i;
    }
    return bad;
  });
}

void HostNodesWork(const Tables &tables, const NodeView &nodes, const StepArgs &args, int step, const double *f,
                   AuditArrays *audit) {
  const NodeWorks works = {audit->node.data(), audit->row.data(), tables.records.n};
  VisitNodes(tables, [&](auto has) {
    for (int i = 0; i < tables.n_owned; ++i)
      AuditNode<has.kRecords, has.kQuiet, has.kDamped>(nodes, args, i, step, tables.mass[i],
                                                       f + 3 * static_cast<std::ptrdiff_t>(i), false, works);
    return 0;
  });
}

}  // namespace cdem
