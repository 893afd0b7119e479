// The kernel of a step that moves the nodes. Compiled without contraction (CMakeLists.txt): a rank has the instance for
// what its own nodes carry, and all of them, with the audit and without it, must round alike.
#include "cuda/device_tables.cuh"

namespace cdem {

PetscErrorCode DeviceTables::LaunchNodes(const NodeView &nodes, const StepArgs &args, BatchState *batch,
                                         const LaunchArgs &launch) {
  PetscFunctionBeginUser;
  const int blocks = Blocks(t_->n_owned, kNodeBlock);
  const double *mass = mass_.get();
  if (audited_) {
    // what the coming step needs of this one, before the nodes move
    const int speeds = static_cast<int>(speed_.size()), means = static_cast<int>(averages_.before.size());
    if (speeds > 0)
      PetscCall(Launch(CopyKernel, Blocks(speeds, kBlock), kBlock, launch, speeds, launch.overlap,
                       static_cast<const double *>(nodes.v), speed_.get()));
    if (means > 0)
      PetscCall(Launch(CopyKernel, Blocks(means, kBlock), kBlock, launch, means, launch.overlap,
                       static_cast<const double *>(averages_.dilatation.get()), averages_.before.get()));
    auto kernel = VisitNodes(*t_, [](auto has) { return AuditedNodeKernel<decltype(has)>; });
    PetscCall(Launch(kernel, blocks, kNodeBlock, launch, nodes, args, Lists(launch.overlap), batch, mass, Works()));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  auto kernel = VisitNodes(*t_, [](auto has) { return NodeKernel<decltype(has)>; });
  PetscCall(Launch(kernel, blocks, kNodeBlock, launch, nodes, args, Lists(launch.overlap), batch));
  PetscFunctionReturn(PETSC_SUCCESS);
}

}  // namespace cdem
