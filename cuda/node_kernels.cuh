// The loop over nodes on the GPU: one thread a node, which sums its slots in the order of the CPU's scatter, so no two
// threads write one value and the sums do not depend on the launch.
#pragma once
#include "cuda/kernel_common.cuh"
#include "forces/node_audit.hpp"
#include "forces/observe.hpp"

namespace cdem {

/// Which slots a node sums: slices of 32 nodes, entry k of node i at entry[start[i / 32] + 32 k + i % 32]; s >= 0 adds
/// slot s, s < 0 subtracts slot ~s, kNoSlot adds nothing.
struct SlotLists {
  const int *start, *entry;
  const double *slot;
  bool early;  ///< see WaitForPrevious
};

/// The head of a node's list, read early: it is constant, while the slots are not.
struct SlotHead {
  static constexpr int kSize = 8;  // a hexahedral mesh has no longer lists, but for springs
  int at, end, entry[kSize];

  __device__ __forceinline__ SlotHead(const SlotLists &lists, int i) {
    at = lists.start[i >> 5] + (i & 31);
    end = lists.start[(i >> 5) + 1];
#pragma unroll
    for (int k = 0; k < kSize; ++k) entry[k] = at + 32 * k < end ? lists.entry[at + 32 * k] : kNoSlot;
  }
};

__device__ __forceinline__ void AddSlot(const SlotLists &lists, int entry, double f[3]) {
  if (entry == kNoSlot) return;
  const double *s = lists.slot + 3ll * (entry < 0 ? ~entry : entry);
  const double sign = entry < 0 ? -1.0 : 1.0;
#pragma unroll
  for (int k = 0; k < 3; ++k) f[k] += sign * s[k];
}

/// Internal force of a node: its slots, in order.
__device__ __forceinline__ void SumSlots(const SlotLists &lists, const SlotHead &head, double f[3]) {
  f[0] = f[1] = f[2] = 0;
#pragma unroll
  for (int k = 0; k < SlotHead::kSize; ++k) AddSlot(lists, head.entry[k], f);
  for (int at = head.at + 32 * SlotHead::kSize; at < head.end; at += 32) AddSlot(lists, lists.entry[at], f);
}

template <class Has>
__global__ void __launch_bounds__(kNodeBlock)
    NodeKernel(NodeView n, StepArgs args, SlotLists lists, BatchState *batch) {
  const int i = blockIdx.x * blockDim.x + threadIdx.x;
  if (i >= n.n_owned) return;
  double f[3];
  const SlotHead head(lists, i);
  WaitForPrevious(lists.early);
  SumSlots(lists, head, f);
  const int step = batch->step;
  if (i == 0) batch->next = step + 1;
  if (!NodeStep<Has::kRecords, Has::kQuiet, Has::kDamped>(n, args, i, step, f))
    atomicMin(&batch->failure, static_cast<unsigned long long>(step) << 32 | static_cast<unsigned>(i));
}

/// NodeKernel with the energy audit.
template <class Has>
__global__ void __launch_bounds__(kNodeBlock)
    AuditedNodeKernel(NodeView n, StepArgs args, SlotLists lists, BatchState *batch, const double *mass,
                      NodeWorks works) {
  const int i = blockIdx.x * blockDim.x + threadIdx.x;
  if (i >= n.n_owned) return;
  double f[3];
  const SlotHead head(lists, i);
  WaitForPrevious(lists.early);
  SumSlots(lists, head, f);
  const int step = batch->step;
  if (i == 0) batch->next = step + 1;
  AuditNode<Has::kRecords, Has::kQuiet, Has::kDamped>(n, args, i, step, mass[i], f, false, works);
  if (!NodeStep<Has::kRecords, Has::kQuiet, Has::kDamped>(n, args, i, step, f))
    atomicMin(&batch->failure, static_cast<unsigned long long>(step) << 32 | static_cast<unsigned>(i));
}

/// A node's share of the balance: what its works are by now, its kinetic energy, its weight times u.
template <class Has>
__global__ void __launch_bounds__(kBlock)
    NodeBalanceKernel(NodeView n, StepArgs args, SlotLists lists, const double *mass, NodeWorks works, double *half,
                      double *weight_u) {
  const int i = blockIdx.x * blockDim.x + threadIdx.x;
  if (i >= n.n_owned) return;
  double f[3], now[3];
  SumSlots(lists, SlotHead(lists, i), f);
  half[i] = ObserveNode<Has::kRecords, Has::kQuiet, Has::kDamped>(n, args, i, mass[i], f, f, now).half;
  AuditNode<Has::kRecords, Has::kQuiet, Has::kDamped>(n, args, i, 0, mass[i], f, true, works);
  const double true_mass = n.weight ? mass[i] * n.weight[i] : mass[i];
  weight_u[i] = true_mass * Dot(args.gravity, n.u + 3ll * i);
}

/// Keeps the sums of the slots of an undamped evaluation.
__global__ inline void __launch_bounds__(kBlock) SumKernel(int n_owned, SlotLists lists, double *f) {
  const int i = blockIdx.x * blockDim.x + threadIdx.x;
  if (i < n_owned) SumSlots(lists, SlotHead(lists, i), f + 3ll * i);
}

/// [in] f: undamped internal forces, or NULL when there is no damping: then the slots hold them.
template <class Has>
__global__ void __launch_bounds__(kBlock) NodeObserveKernel(NodeView n, StepArgs args, SlotLists lists,
                                                            const double *mass, const double *f, double *partial) {
  const int i = blockIdx.x * blockDim.x + threadIdx.x;
  double value[kNodeSums] = {0, 0, 0, 0, 0, 0, 0, 0, 0, 0};
  if (i < n.n_owned) {
    double damped[3], v_now[3];
    SumSlots(lists, SlotHead(lists, i), damped);
    const double *f_int = f ? f + 3ll * i : damped;
    const NodeSums s = ObserveNode<Has::kRecords, Has::kQuiet, Has::kDamped>(n, args, i, mass[i], f_int, damped, v_now);
    value[0] = s.kinetic;
    value[1] = s.form;
    for (int k = 0; k < 3; ++k) value[2 + k] = s.momentum[k];
    value[5] = s.residual;
    value[6] = s.free;
    value[7] = s.load_u;
    value[8] = s.v2;
    value[9] = s.u2;
  }
  // the last two are maxima
  using Reduce = cub::BlockReduce<double, kBlock>;
  __shared__ typename Reduce::TempStorage storage;
  for (int k = 0; k < kNodeSums; ++k) {
    const double r = k < 8 ? Reduce(storage).Sum(value[k])
                           : Reduce(storage).Reduce(value[k], [](double p, double q) { return p > q ? p : q; });
    if (threadIdx.x == 0) partial[static_cast<long long>(blockIdx.x) * kNodeSums + k] = r;
    __syncthreads();
  }
}

}  // namespace cdem
