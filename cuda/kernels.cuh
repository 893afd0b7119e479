// The loops on the GPU: one thread an element, a spring, a node. Elements and springs write their forces to slots of
// three doubles; nodes sum their slots in the order of the CPU's scatter, so no two threads write one value and the sums
// do not depend on the launch.
#pragma once
#include "forces/bodies.hpp"
#include "forces/observe.hpp"

#include <climits>
#include <cub/block/block_reduce.cuh>

namespace cdem {

inline constexpr int kBlock = 128;       ///< threads of spring and node kernels, and of all observing ones
inline constexpr int kNoSlot = INT_MAX;  ///< padding of the slot lists
inline constexpr int kElementSums = 3, kSpringSums = 5, kNodeSums = 9;  ///< columns of partial sums

struct ElementView {
  int n, n_pad;
  const int *node, *material;
  const double *param, *x, *u, *v;
  double beta;
  double *slot;                 ///< first slot of this table
  const std::uint8_t *counted;  ///< for observations
};

struct SpringView {
  int n, n_pad;
  const int *a, *b, *joint;
  const double *normal, *area, *kn, *ks, *param, *u, *v;
  double beta;
  std::uint8_t *state;
  double *slip, *slot;
  const std::uint8_t *counted;
};

/// Which slots a node sums: slices of 32 nodes, entry k of node i at entry[start[i / 32] + 32 k + i % 32]; s >= 0 adds
/// slot s, s < 0 subtracts slot ~s, kNoSlot adds nothing.
struct SlotLists {
  const int *start, *entry;
  const double *slot;
};

/// What the kernels of a batch share: the step within the batch and the first failure (step << 32 | node).
struct BatchState {
  int step;
  unsigned long long failure;
};

template <class Form, class Law, bool kBeta, bool kObserve>
__device__ __forceinline__ void ElementThread(const ElementView &t, int e, ElementSums<double> *sums,
                                              double (*force)[3]) {
  constexpr int corners = Form::kCorners;
  double x[corners][3], w[corners][3], param[kMaxParams];
#pragma unroll
  for (int a = 0; a < corners; ++a) {
    const long long node = 3ll * t.node[static_cast<long long>(a) * t.n_pad + e];
#pragma unroll
    for (int k = 0; k < 3; ++k) {
      x[a][k] = t.x[node + k];
      w[a][k] = t.u[node + k];
      if (kBeta) w[a][k] += t.beta * t.v[node + k];
    }
  }
  const double *row = t.param + kMaxParams * t.material[e];
#pragma unroll
  for (int p = 0; p < Law::kParams; ++p) param[p] = row[p];
  ElementForce<Form, Law, kObserve, double>(x, w, param, force, sums);
#pragma unroll
  for (int a = 0; a < corners; ++a)
#pragma unroll
    for (int k = 0; k < 3; ++k) t.slot[3 * (static_cast<long long>(a) * t.n_pad + e) + k] = force[a][k];
}

/// [in] batch: advances its step when not NULL (the first kernel of a step does).
template <class Form, class Law, bool kBeta>
__global__ void __launch_bounds__(256) ElementKernel(ElementView t, BatchState *batch) {
  const int e = blockIdx.x * blockDim.x + threadIdx.x;
  if (batch && e == 0) ++batch->step;
  if (e >= t.n) return;
  double force[Form::kCorners][3];
  ElementThread<Form, Law, kBeta, false>(t, e, nullptr, force);
}

/// Sums of each block's threads, one row of partial [blocks][n].
template <int n>
__device__ void BlockSums(const double (&value)[n], double *partial) {
  using Reduce = cub::BlockReduce<double, kBlock>;
  __shared__ typename Reduce::TempStorage storage;
  for (int k = 0; k < n; ++k) {
    const double sum = Reduce(storage).Sum(value[k]);
    if (threadIdx.x == 0) partial[static_cast<long long>(blockIdx.x) * n + k] = sum;
    __syncthreads();
  }
}

template <class Form, class Law>
__global__ void __launch_bounds__(kBlock) ElementObserveKernel(ElementView t, double *partial) {
  const int e = blockIdx.x * blockDim.x + threadIdx.x;
  double value[kElementSums] = {0, 0, 0};
  if (e < t.n) {
    ElementSums<double> sums;
    double force[Form::kCorners][3];
    ElementThread<Form, Law, false, true>(t, e, &sums, force);
    if (t.counted[e]) {
      value[0] = sums.energy;
      for (int a = 0; a < Form::kCorners; ++a)
        for (int k = 0; k < 3; ++k) value[1] += fabs(force[a][k]);
      value[2] = 3 * Form::kCorners;
    }
  }
  BlockSums(value, partial);
}

/// One spring: writes its force to its slot; commits state and slip with kCommit. Returns the state it would leave.
template <class Law, bool kBeta, bool kCommit>
__device__ __forceinline__ std::uint8_t SpringThread(const SpringView &t, int i, double (&normal)[3],
                                                     double (&force)[3]) {
  Spring<double> s;
  double param[kMaxParams];
  const long long a = 3ll * t.a[i], b = 3ll * t.b[i];
  std::uint8_t state = 0;
#pragma unroll
  for (int k = 0; k < 3; ++k) {
    s.d[k] = t.u[b + k] - t.u[a + k];
    s.beta_rate[k] = kBeta ? t.beta * (t.v[b + k] - t.v[a + k]) : 0.0;
    s.normal[k] = normal[k] = t.normal[static_cast<long long>(k) * t.n_pad + i];
  }
  s.kn = t.kn[i];
  s.ks = t.ks[i];
  bool opens = false, slides = false;
  if constexpr (Law::kHistory) {
    s.area = t.area[i];
    const double *row = t.param + kMaxParams * t.joint[i];
#pragma unroll
    for (int p = 0; p < Law::kParams; ++p) param[p] = row[p];
    s.param = param;
    state = t.state[i];
    s.tension_lost = state & kTensionLost ? 1.0 : 0.0;
    s.cohesion_lost = state & kCohesionLost ? 1.0 : 0.0;
#pragma unroll
    for (int k = 0; k < 3; ++k) s.slip[k] = state ? t.slip[static_cast<long long>(k) * t.n_pad + i] : 0.0;
  }
  SpringForce<Law, kBeta>(s, force, &opens, &slides);
  std::uint8_t next = 0;
  if constexpr (Law::kHistory) {
    next = NextState(state, opens, slides, param[Law::kKeepTension] != 0);
    if (kCommit) {
      if (next != state) t.state[i] = next;
      if (opens || slides)
#pragma unroll
        for (int k = 0; k < 3; ++k) t.slip[static_cast<long long>(k) * t.n_pad + i] = s.slip[k];
    }
  }
#pragma unroll
  for (int k = 0; k < 3; ++k) t.slot[3ll * i + k] = force[k];
  return next;
}

template <class Law, bool kBeta>
__global__ void __launch_bounds__(kBlock) SpringKernel(SpringView t) {
  const int i = blockIdx.x * blockDim.x + threadIdx.x;
  if (i >= t.n) return;
  double normal[3], force[3];
  SpringThread<Law, kBeta, true>(t, i, normal, force);
}

template <class Law, bool kBeta>
__global__ void __launch_bounds__(kBlock) SpringObserveKernel(SpringView t, double *partial) {
  const int i = blockIdx.x * blockDim.x + threadIdx.x;
  double value[kSpringSums] = {0, 0, 0, 0, 0};
  if (i < t.n) {
    double normal[3], force[3];
    const std::uint8_t next = SpringThread<Law, kBeta, false>(t, i, normal, force);
    if (t.counted[i]) {
      value[0] = SpringEnergy(normal, t.kn[i], t.ks[i], force);
      for (int k = 0; k < 3; ++k) value[1] += fabs(force[k]);
      value[2] = 3;
      value[3] = next & kCohesionLost ? 1 : 0;
      value[4] = 1;
    }
  }
  BlockSums(value, partial);
}

/// Internal force of node i: its slots, in order.
__device__ __forceinline__ void SumSlots(const SlotLists &lists, int i, double f[3]) {
  const int slice = i >> 5, end = lists.start[slice + 1];
  f[0] = f[1] = f[2] = 0;
  for (int at = lists.start[slice] + (i & 31); at < end; at += 32) {
    const int entry = lists.entry[at];
    if (entry == kNoSlot) continue;
    const double *s = lists.slot + 3ll * (entry < 0 ? ~entry : entry);
    const double sign = entry < 0 ? -1.0 : 1.0;
#pragma unroll
    for (int k = 0; k < 3; ++k) f[k] += sign * s[k];
  }
}

template <bool kRecords>
__global__ void __launch_bounds__(kBlock) NodeKernel(NodeView n, StepArgs args, SlotLists lists, BatchState *batch) {
  const int i = blockIdx.x * blockDim.x + threadIdx.x;
  if (i >= n.n_owned) return;
  double f[3];
  SumSlots(lists, i, f);
  const int step = batch->step;
  if (!NodeStep<kRecords>(n, args, i, step, f))
    atomicMin(&batch->failure, static_cast<unsigned long long>(step) << 32 | static_cast<unsigned>(i));
}

/// Keeps the sums of the slots of an undamped evaluation.
__global__ inline void __launch_bounds__(kBlock) SumKernel(int n_owned, SlotLists lists, double *f) {
  const int i = blockIdx.x * blockDim.x + threadIdx.x;
  if (i < n_owned) SumSlots(lists, i, f + 3ll * i);
}

/// [in] f: undamped internal forces, or NULL when there is no damping: then the slots hold them.
template <bool kRecords>
__global__ void __launch_bounds__(kBlock) NodeObserveKernel(NodeView n, StepArgs args, SlotLists lists,
                                                            const double *mass, const double *f, double *partial) {
  const int i = blockIdx.x * blockDim.x + threadIdx.x;
  double value[kNodeSums] = {0, 0, 0, 0, 0, 0, 0, 0, 0};
  if (i < n.n_owned) {
    double damped[3], v_now[3];
    SumSlots(lists, i, damped);
    const double *f_int = f ? f + 3ll * i : damped;
    const NodeSums s = ObserveNode<kRecords>(n, args, i, mass[i], f_int, damped, v_now);
    value[0] = s.kinetic;
    value[1] = s.form;
    for (int k = 0; k < 3; ++k) value[2 + k] = s.momentum[k];
    value[5] = s.residual;
    value[6] = s.free;
    value[7] = s.v2;
    value[8] = s.u2;
  }
  // the last two are maxima
  using Reduce = cub::BlockReduce<double, kBlock>;
  __shared__ typename Reduce::TempStorage storage;
  for (int k = 0; k < kNodeSums; ++k) {
    const double r = k < 7 ? Reduce(storage).Sum(value[k])
                           : Reduce(storage).Reduce(value[k], [](double p, double q) { return p > q ? p : q; });
    if (threadIdx.x == 0) partial[static_cast<long long>(blockIdx.x) * kNodeSums + k] = r;
    __syncthreads();
  }
}

}  // namespace cdem
