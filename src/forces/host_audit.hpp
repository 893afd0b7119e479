// The balance of energies at a moment, on the CPU.
#pragma once
#include "forces/backend.hpp"

namespace cdem {

/// Sums over all ranks in no order (collective). [in] nodes: u and v with ghosts, at u(n); history, arrays: as the steps
/// before left them. Takes the coming evaluation on copies, since what it dissipates belongs to the step that ended.
PetscErrorCode AuditOnHost(const Tables &tables, int n_owned_cells, const NodeView &nodes, const Histories &history,
                           const AuditArrays &arrays, const StepArgs &next, AuditSums *sums);

}  // namespace cdem
