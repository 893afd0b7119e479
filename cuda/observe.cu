// Sums over the state for observations.
#include "cuda/device_tables.cuh"

#include <algorithm>

namespace cdem {

PetscErrorCode DeviceTables::AddPartial(int blocks, int columns, double *sums, int maxima) const {
  PetscFunctionBeginUser;
  std::vector<double> rows(static_cast<std::size_t>(blocks) * columns);
  CdemCuda(cudaGetLastError());
  CdemCuda(cudaMemcpy(rows.data(), partial_.get(), rows.size() * sizeof(double), cudaMemcpyDeviceToHost));
  for (int b = 0; b < blocks; ++b)
    for (int k = 0; k < columns; ++k) {
      const double value = rows[static_cast<std::size_t>(b) * columns + k];
      sums[k] = k < columns - maxima ? sums[k] + value : std::max(sums[k], value);
    }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode DeviceTables::Observe(const NodeView &nodes, const StepArgs &args, cudaStream_t stream,
                                     Observed *observed) {
  PetscFunctionBeginUser;
  if (partial_.size() == 0) {
    int most = Blocks(t_->n_owned, kBlock) * kNodeSums;
    for (const Elements &e : elements_) most = std::max(most, Blocks(e.host->n, kBlock) * kElementSums);
    for (const Springs &s : springs_) most = std::max(most, Blocks(s.host->n, kBlock) * kSpringSums);
    PetscCall(partial_.Allocate(most));
    if (t_->beta != 0) PetscCall(undamped_.Allocate(3 * static_cast<std::size_t>(t_->n_owned)));
    CdemCuda(cudaDeviceSynchronize());  // the zeroing runs on another stream than the kernels below
  }
  double element[kElementSums] = {}, spring[kSpringSums] = {}, node[kNodeSums] = {};
  const int node_blocks = Blocks(t_->n_owned, kBlock);
  LaunchArgs launch;
  launch.stream = stream;
  PetscCall(LaunchDilatation(nodes.u, nodes.v, 0, launch));
  for (const Elements &e : elements_) {
    const int blocks = Blocks(e.host->n, kBlock);
    VisitBlock(e.host->shape, e.host->form, e.host->law, [&](auto form, auto law) {
      ElementObserveKernel<decltype(form), decltype(law), false>
          <<<blocks, kBlock, 0, stream>>>(View(e, nodes.u, nodes.v, 0), partial_.get(), e.each.get());
    });
    CdemCuda(cudaStreamSynchronize(stream));
    PetscCall(AddPartial(blocks, kElementSums, element, 0));
  }
  PetscCall(LaunchPressure(launch));
  for (const Springs &s : springs_) {
    const int blocks = Blocks(s.host->n, kBlock);
    JointLaws::Visit(s.host->law, [&](auto law) {
      SpringObserveKernel<decltype(law), false>
          <<<blocks, kBlock, 0, stream>>>(View(s, nodes.u, nodes.v, 0), partial_.get(), s.each.get());
    });
    CdemCuda(cudaStreamSynchronize(stream));
    PetscCall(AddPartial(blocks, kSpringSums, spring, 0));
  }
  if (t_->beta != 0) PetscCall(LaunchDilatation(nodes.u, nodes.v, t_->beta, launch));
  if (t_->beta != 0 && t_->n_owned > 0) {
    // the kick of the coming step includes the damping forces: a second evaluation, its other sums dropped
    SumKernel<<<node_blocks, kBlock, 0, stream>>>(t_->n_owned, Lists(), undamped_.get());
    for (const Elements &e : elements_)
      VisitBlock(e.host->shape, e.host->form, e.host->law, [&](auto form, auto law) {
        ElementObserveKernel<decltype(form), decltype(law), true><<<Blocks(e.host->n, kBlock), kBlock, 0, stream>>>(
            View(e, nodes.u, nodes.v, t_->beta), partial_.get(), nullptr);
      });
    for (const Springs &s : springs_)
      JointLaws::Visit(s.host->law, [&](auto law) {
        SpringObserveKernel<decltype(law), true><<<Blocks(s.host->n, kBlock), kBlock, 0, stream>>>(
            View(s, nodes.u, nodes.v, t_->beta), partial_.get(), nullptr);
      });
  }
  if (t_->beta != 0) PetscCall(LaunchPressure(launch));
  if (t_->n_owned > 0) {
    const double *f = t_->beta != 0 ? undamped_.get() : nullptr;
    auto kernel = VisitNodes(*t_, [](auto has) { return NodeObserveKernel<decltype(has)>; });
    NodeView seen = nodes;
    seen.last = nullptr;  // the host's observations know no acceleration of the step before either
    kernel<<<node_blocks, kBlock, 0, stream>>>(seen, args, Lists(), mass_.get(), f, partial_.get());
    CdemCuda(cudaStreamSynchronize(stream));
    PetscCall(AddPartial(node_blocks, kNodeSums, node, 2));
  }
  *observed = Observed{node[0],
                       element[0],
                       spring[0],
                       node[1],
                       {node[2], node[3], node[4]},
                       node[5],
                       node[6],
                       element[1] + spring[1],
                       element[2] + spring[2],
                       spring[3],
                       spring[4],
                       node[8],
                       node[9]};
  observed->load_u = node[7];
  observed->broken_elements = element[3];
  PetscFunctionReturn(PETSC_SUCCESS);
}

}  // namespace cdem
