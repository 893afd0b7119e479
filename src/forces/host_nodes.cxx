// Compiled without contraction (CMakeLists.txt): a rank has the instance for what its own nodes carry, and all of them
// must round alike.
#include "forces/host_passes.hpp"
#include "forces/node_audit.hpp"

namespace cdem {

int HostNodes(const Tables &tables, const NodeView &nodes, const StepArgs &args, int step, const double *f) {
  return VisitNodes(tables, [&](auto has) {
    int bad = -1;
    for (int i = 0; i < tables.n_owned; ++i)
      if (!NodeStep<has.kRecords, has.kQuiet, has.kDamped>(nodes, args, i, step,
                                                           f + 3 * static_cast<std::ptrdiff_t>(i)) &&
          bad < 0)
        bad = i;
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
