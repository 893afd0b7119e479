#include "cuda/stencil_way.cuh"

#include "forces/stencil_body.hpp"

namespace cdem {
namespace {

constexpr int kWarp = 32;

/// Nodes of a thread in large scenes: the more, the fewer loads of blocks of the stiffness a node.
constexpr int kMany = 4;
constexpr int kUnroll = 9;  ///< neighbours of a node: so many displacements are on their way at a time

/// A block of the stiffness; the same for the whole warp.
__device__ __forceinline__ void LoadBlock(const StencilEntry *from, double block[9]) {
  const double2 *p = reinterpret_cast<const double2 *>(from);
#pragma unroll
  for (int k = 0; k < 4; ++k) {
    const double2 two = __ldg(p + k);
    block[2 * k] = two.x;
    block[2 * k + 1] = two.y;
  }
  block[8] = __ldg(from->block + 8);
}

/// One step of all nodes that move. A warp has kNodes tiles of 32 positions with one row. [in] now: buffer that is read.
template <bool kBeta, int kNodes>
__global__ void __launch_bounds__(kBlock)
    StencilKernel(StencilView s, NodeView n, StepArgs args, double beta, int now, bool early, BatchState *batch) {
  const int thread = blockIdx.x * blockDim.x + threadIdx.x, tile = thread / kWarp, lane = thread % kWarp;
  if (tile >= s.n_tiles) return;
  const StencilTile t = s.tile[tile];
  int place[kNodes];
#pragma unroll
  for (int m = 0; m < kNodes; ++m) place[m] = s.position[(tile * kNodes + m) * kWarp + lane];
  WaitForPrevious(early);
  const double *__restrict__ from = s.w[now];
  double *to = s.w[1 - now];
  double f[kNodes][3] = {};
  if (t.list < 0) {
    const double *at[kNodes];
#pragma unroll
    for (int m = 0; m < kNodes; ++m) at[m] = from + max(place[m], s.position[tile * kNodes * kWarp]);
    // the lanes read the offsets of 32 neighbours together, so that their displacements are asked for at once
    for (int first = 0; first < t.count; first += kWarp) {
      const int n_here = min(kWarp, t.count - first);
      const int mine = lane < n_here ? static_cast<int>(__ldg(&s.entry[t.first + first + lane].offset)) : 0;
#pragma unroll kUnroll
      for (int k = 0; k < n_here; ++k) {
        const int offset = __shfl_sync(0xffffffff, mine, k);
        double block[9];
        LoadBlock(s.entry + t.first + first + k, block);
#pragma unroll
        for (int m = 0; m < kNodes; ++m) {
          const double *x = at[m] + offset;
          AddCoupling(block, __ldg(x), __ldg(x + s.stride), __ldg(x + 2 * s.stride), f[m]);
        }
      }
    }
  } else {
    const int *list = s.list + t.list + lane;
#pragma unroll kUnroll
    for (int k = 0; k < t.count; ++k) {
      double block[9];
      LoadBlock(s.entry + t.first + k, block);
#pragma unroll
      for (int m = 0; m < kNodes; ++m) {
        const double *x = from + list[(k * kNodes + m) * kWarp];
        AddCoupling(block, __ldg(x), __ldg(x + s.stride), __ldg(x + 2 * s.stride), f[m]);
      }
    }
  }
  const int step = s.step[now];
  if (thread == 0) s.step[1 - now] = step + 1;
#pragma unroll
  for (int m = 0; m < kNodes; ++m) {
    const int i = place[m];
    if (i < 0) continue;
    double u[3], v[3];
#pragma unroll
    for (int k = 0; k < 3; ++k) {
      u[k] = (kBeta ? s.u : from)[k * s.stride + i];
      v[k] = s.v[k * s.stride + i];
    }
    if (t.records)
      MoveRecorded(n, args, n.record[s.node[i]], step, t.inverse_mass, f[m], u, v);
    else
      MoveFree(args, t.inverse_mass, f[m], u, v);
#pragma unroll
    for (int k = 0; k < 3; ++k) {
      s.v[k * s.stride + i] = v[k];
      if (kBeta) s.u[k * s.stride + i] = u[k];
      to[k * s.stride + i] = kBeta ? u[k] + beta * v[k] : u[k];
    }
    if (!(fabs(v[0]) + fabs(v[1]) + fabs(v[2]) < 1e100))
      atomicMin(&batch->failure, static_cast<unsigned long long>(step) << 32 | static_cast<unsigned>(s.node[i]));
  }
}

/// The state from the order of nodes to that of places. [in] now: the buffer that is read first.
__global__ void __launch_bounds__(kBlock)
    ToPlaces(StencilView s, NodeView n, double beta, int places, int now, int first) {
  const int i = blockIdx.x * blockDim.x + threadIdx.x;
  if (i == 0) s.step[now] = first;
  if (i >= places) return;
  const long long node = s.node[i];
  for (int k = 0; k < 3; ++k) {
    const double u = n.u[3 * node + k], v = n.v[3 * node + k];
    s.v[k * s.stride + i] = v;
    if (s.u) s.u[k * s.stride + i] = u;
    s.w[0][k * s.stride + i] = s.w[1][k * s.stride + i] = s.u ? u + beta * v : u;
  }
}

/// And back, from the first buffer.
__global__ void __launch_bounds__(kBlock)
    FromPlaces(StencilView s, NodeView n, int places, int last, BatchState *batch) {
  const int i = blockIdx.x * blockDim.x + threadIdx.x;
  if (i == 0) batch->next = last;
  if (i >= places) return;
  const long long node = s.node[i];
  for (int k = 0; k < 3; ++k) {
    n.u[3 * node + k] = (s.u ? s.u : s.w[0])[k * s.stride + i];
    n.v[3 * node + k] = s.v[k * s.stride + i];
  }
}

/// Positions up to which a thread has one node, so that all multiprocessors have some.
constexpr int kFew = 400000;

}  // namespace

PetscErrorCode StencilWay::Create(const Tables &tables, bool any, std::string *why) {
  PetscFunctionBeginUser;
  StencilPlan plan;
  const int nodes = tables.n_owned > kFew ? kMany : 1;
  *why = PlanStencil(tables, nodes * kWarp, any, &plan);
  if (!why->empty()) PetscFunctionReturn(PETSC_SUCCESS);
  text_ = StencilText(plan);
  beta_ = tables.beta;
  places_ = static_cast<int>(plan.node.size());
  std::vector<StencilTile> tiles;
  for (const StencilClass &c : plan.classes)
    for (int p = c.begin; p < c.end; p += nodes * kWarp)
      tiles.push_back({c.first, c.count, c.list < 0 ? -1 : c.list + static_cast<std::int64_t>(p - c.begin) * c.count,
                       c.inverse_mass, c.records, nodes});
  tiles_ = static_cast<int>(tiles.size());
  PetscCall(tile_.Upload(tiles));
  PetscCall(position_.Upload(plan.position));
  PetscCall(list_.Upload(plan.list));
  PetscCall(node_.Upload(plan.node));
  PetscCall(entry_.Upload(plan.entry));
  PetscCall(step_.Allocate(2));
  PetscCall(state_.Allocate((beta_ != 0 ? 4 : 3) * 3 * Padded(plan.node.size())));
  PetscFunctionReturn(PETSC_SUCCESS);
}

std::size_t StencilWay::Bytes() const {
  return tile_.bytes() + position_.bytes() + list_.bytes() + node_.bytes() + entry_.bytes() + state_.bytes();
}

StencilView StencilWay::View() const {
  const long long stride = static_cast<long long>(Padded(static_cast<std::size_t>(places_))), all = 3 * stride;
  double *state = state_.get();
  return {tiles_,
          tile_.get(),
          position_.get(),
          list_.get(),
          node_.get(),
          entry_.get(),
          beta_ != 0 ? state + 3 * all : nullptr,
          state,
          {state + all, state + 2 * all},
          stride,
          step_.get()};
}

PetscErrorCode StencilWay::Run(const NodeView &nodes, const StepArgs &args, BatchState *batch, int first, int n,
                               const LaunchArgs &launch) {
  PetscFunctionBeginUser;
  if (n == 0) PetscFunctionReturn(PETSC_SUCCESS);
  const StencilView view = View();
  const bool many = places_ > kFew;
  int now = StepGraphs::Singles(n) % 2;  // so that graphs, of an even number of steps, begin at buffer 0
  LaunchArgs plain = launch;
  plain.overlap = false;
  PetscCall(Launch(ToPlaces, Blocks(places_, kBlock), kBlock, plain, view, nodes, beta_, places_, now, first));
  auto kernel = beta_ != 0 ? (many ? StencilKernel<true, kMany> : StencilKernel<true, 1>)
                           : (many ? StencilKernel<false, kMany> : StencilKernel<false, 1>);
  const int block = many ? kBlock : kNodeBlock;
  PetscCall(graphs_.Run(args, launch.stream, n, [&] {
    PetscFunctionBeginUser;
    PetscCall(Launch(kernel, Blocks(tiles_ * kWarp, block), block, launch, view, nodes, args, beta_, now,
                     launch.overlap, batch));
    now = 1 - now;
    PetscFunctionReturn(PETSC_SUCCESS);
  }));
  // n steps on, the buffer to be read is 0 again
  PetscCall(Launch(FromPlaces, Blocks(places_, kBlock), kBlock, plain, view, nodes, places_, first + n, batch));
  PetscFunctionReturn(PETSC_SUCCESS);
}

}  // namespace cdem
