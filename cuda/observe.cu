// Sums over the state for observations.
#include "cuda/device_tables.cuh"

#include <algorithm>

namespace cdem {

namespace {

constexpr int kAddBlock = 1024;

/// Sums (the last columns: maxima) over the rows of partial [rows][columns], a block a column, in one order.
__global__ void __launch_bounds__(kAddBlock)
    AddRowsKernel(int rows, int columns, int maxima, const double *partial, double *sums) {
  const int k = blockIdx.x;
  const bool adds = k < columns - maxima;
  double value = 0;
  for (int row = threadIdx.x; row < rows; row += kAddBlock) {
    const double one = partial[static_cast<long long>(row) * columns + k];
    value = adds ? value + one : (one > value ? one : value);
  }
  using Reduce = cub::BlockReduce<double, kAddBlock>;
  __shared__ typename Reduce::TempStorage storage;
  value = adds ? Reduce(storage).Sum(value)
               : Reduce(storage).Reduce(value, [](double p, double q) { return p > q ? p : q; });
  if (threadIdx.x == 0) sums[k] = value;
}

}  // namespace

/// Sums the rows of partial_ into row `to` of the results of an observation.
PetscErrorCode DeviceTables::AddPartial(int blocks, int columns, int maxima, std::size_t to, cudaStream_t stream) {
  PetscFunctionBeginUser;
  AddRowsKernel<<<columns, kAddBlock, 0, stream>>>(blocks, columns, maxima, partial_.get(),
                                                   observed_.get() + to * kNodeSums);
  CdemCuda(cudaGetLastError());
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
    PetscCall(observed_.Allocate((1 + elements_.size() + springs_.size()) * kNodeSums));
    if (t_->beta != 0) PetscCall(undamped_.Allocate(3 * static_cast<std::size_t>(t_->n_owned)));
  }
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
    PetscCall(AddPartial(blocks, kElementSums, 0, 1 + (&e - elements_.data()), stream));
  }
  PetscCall(LaunchPressure(launch));
  for (const Springs &s : springs_) {
    const int blocks = Blocks(s.host->n, kBlock);
    JointLaws::Visit(s.host->law, [&](auto law) {
      SpringObserveKernel<decltype(law), false>
          <<<blocks, kBlock, 0, stream>>>(View(s, nodes.u, nodes.v, 0), partial_.get(), s.each.get());
    });
    PetscCall(AddPartial(blocks, kSpringSums, 0, 1 + elements_.size() + (&s - springs_.data()), stream));
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
    PetscCall(AddPartial(node_blocks, kNodeSums, 2, 0, stream));
  }
  std::vector<double> rows(observed_.size());
  CdemCuda(cudaMemcpyAsync(rows.data(), observed_.get(), observed_.bytes(), cudaMemcpyDeviceToHost, stream));
  CdemCuda(cudaStreamSynchronize(stream));
  const double *node = rows.data();
  double element[kElementSums] = {}, spring[kSpringSums] = {};
  for (std::size_t g = 0; g < elements_.size(); ++g)
    for (int k = 0; k < kElementSums; ++k) element[k] += rows[(1 + g) * kNodeSums + k];
  for (std::size_t g = 0; g < springs_.size(); ++g)
    for (int k = 0; k < kSpringSums; ++k) spring[k] += rows[(1 + elements_.size() + g) * kNodeSums + k];
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
