#include "cuda/rows_way.cuh"

#include "core/error.hpp"

#include <cooperative_groups.h>

#include <algorithm>
#include <type_traits>
#include <utility>

namespace cdem {
namespace {

constexpr int kRowThreads = RowPlan::kLanes * RowPlan::kNodes;

__device__ __forceinline__ std::uint32_t Address(const void *shared) {
  return static_cast<std::uint32_t>(__cvta_generic_to_shared(shared));
}

/// The same place in another block of the cluster.
__device__ __forceinline__ std::uint32_t InBlock(std::uint32_t address, int block) {
  std::uint32_t there;
  asm("mapa.shared::cluster.u32 %0, %1, %2;" : "=r"(there) : "r"(address), "r"(block));
  return there;
}

/// Stores a number in a block and counts its bytes on a barrier there. [in] to: block << 16 | slot; place, arrived: of slot
/// 0 and of the barrier in this block.
__device__ __forceinline__ void Send(int to, std::uint32_t place, std::uint32_t arrived, double w) {
  asm volatile("st.async.shared::cluster.mbarrier::complete_tx::bytes.f64 [%0], %1, [%2];" ::"r"(
                   InBlock(place + 8 * (to & 0xffff), to >> 16)),
               "d"(w), "r"(InBlock(arrived, to >> 16))
               : "memory");
}

/// By address: so a coupling costs one register, and no arithmetic.
template <int kOffset>
__device__ __forceinline__ double Load(std::uint32_t from) {
  double x;
  asm volatile("ld.shared.f64 %0, [%1 + %2];" : "=d"(x) : "r"(from), "n"(kOffset) : "memory");
  return x;
}

__device__ __forceinline__ void Store(std::uint32_t to, double x) {
  asm volatile("st.shared.f64 [%0], %1;" ::"r"(to), "d"(x) : "memory");
}

__device__ __forceinline__ void Expect(std::uint32_t arrived, int bytes) {
  asm volatile("mbarrier.arrive.expect_tx.shared::cta.b64 _, [%0], %1;" ::"r"(arrived), "r"(bytes) : "memory");
}

/// (At the scope of the block: at that of the cluster it would empty the first-level cache, every step.)
__device__ __forceinline__ void Await(std::uint32_t arrived, int parity) {
  std::uint32_t done = 0;
  while (!done)
    asm volatile(
        "{\n .reg .pred p;\n mbarrier.try_wait.parity.shared::cta.b64 p, [%1], %2;\n selp.u32 %0, 1, "
        "0, p;\n}"
        : "=r"(done)
        : "r"(arrived), "r"(parity)
        : "memory");
}

/// What the record of one component of a node asks for, and its row, in one number, so that a step reads no more of it than
/// it needs.
enum RecordBits { kKind = 3, kStill = 4, kLoaded = 8, kWatched = 16, kRowShift = 5 };

__device__ __forceinline__ int RecordOf(const NodeView &n, int row, int k) {
  const int kind = n.kind[row] >> (2 * k) & 3, watched = n.watch[row] >= 0 ? kWatched : 0;
  // prescribed as 0: no need to look at tables, nor at loads
  if (kind == kVelocity && n.value[3 * row + k] == 0) return watched ? row << kRowShift | watched | kStill : kStill;
  const int asks = kind | watched | (n.load_start[row + 1] > n.load_start[row] ? kLoaded : 0);
  return asks ? row << kRowShift | asks : 0;
}

/// Sum over the four lanes of a node of three numbers each; lane k < 3 gets that of number k.
__device__ __forceinline__ double SumOfLanes(const double f[3], int lane) {
  const bool odd = lane & 1, high = lane & 2;
  // lanes 0 and 1, 2 and 3: the even one keeps numbers 0 and 2, the odd one number 1
  const double mine = odd ? f[1] : f[0], other = odd ? f[0] : f[1];
  const double first = mine + __shfl_xor_sync(0xffffffffu, other, 1),
               third = f[2] + __shfl_xor_sync(0xffffffffu, f[2], 1);
  // the lower two keep numbers 0 and 1, the upper two number 2
  return (high ? third : first) + __shfl_xor_sync(0xffffffffu, high ? first : third, 2);
}

constexpr int kComponent = 8 * RowPlan::kSlots;  ///< bytes from one component of a buffer to the next
constexpr int kBuffer = 3 * kComponent;          ///< from the first buffer to the second

/// Forces of the couplings of one lane, from a buffer.
template <int kFrom, int... j>
__device__ __forceinline__ void Couple(const double (&k)[sizeof...(j)][9], const std::uint32_t (&at)[sizeof...(j)],
                                       std::integer_sequence<int, j...>, double (&f)[3]) {
  auto one = [&f](const double *k, double x, double y, double z) {
#pragma unroll
    for (int c = 0; c < 3; ++c) f[c] = fma(k[3 * c + 2], z, fma(k[3 * c + 1], y, fma(k[3 * c], x, f[c])));
  };
  (one(k[j], Load<kFrom>(at[j]), Load<kFrom + kComponent>(at[j]), Load<kFrom + 2 * kComponent>(at[j])), ...);
}

/// Steps first to first + n - 1 of a batch. A thread holds up to kCouplings of one node; its four lanes sum their forces, and
/// lane k < 3 updates component k and sends it to the blocks that read it. What a block reads stands in two buffers by turns;
/// values from other blocks arrive on a barrier of the buffer. No block waits for all, only for those that it reads. Two
/// buffers are enough because who reads is read: a block sends values of step s + 2 only after it has those of step s + 1 from
/// every node that reads its own, and such a node sends them after it has read those of step s.
template <bool kRecords, bool kBeta>
__global__ void __launch_bounds__(kRowThreads, 1)
    RowsKernel(RowView r, NodeView n, StepArgs args, double beta, BatchState *batch, int first, int steps) {
#if __CUDA_ARCH__ >= 900
  constexpr int kCouplings = RowPlan::kCouplings, kTargets = RowPlan::kTargets, kNodes = RowPlan::kNodes;
  __shared__ double memory[2][3][RowPlan::kSlots];
  __shared__ std::uint64_t arrived[2];
  __shared__ __align__(16) int target[kNodes][kTargets];
  const int block = blockIdx.x, t = threadIdx.x, lane = t % RowPlan::kLanes, own = t / RowPlan::kLanes;
  const int node = r.node[block * r.threads + t];
  const int n_halo = r.halo[block];
  const std::uint32_t here = Address(memory), arrived_here = Address(arrived), target_here = Address(target[own]);

  double k[kCouplings][9];
  std::uint32_t at[kCouplings];
#pragma unroll
  for (int j = 0; j < kCouplings; ++j) {
    at[j] = here + 8 * r.slot[(static_cast<long long>(block) * kCouplings + j) * r.threads + t];
#pragma unroll
    for (int m = 0; m < 9; ++m)
      k[j][m] = r.coefficient[(static_cast<long long>(block) * kCouplings * 9 + 9 * j + m) * r.threads + t];
  }
  for (int i = t; i < kTargets * kNodes; i += r.threads)
    target[i / kTargets][i % kTargets] = r.target[block * kTargets * kNodes + i];
  const bool moves = node >= 0 && lane < 3;  // this thread has a component
  int record = 0;
  if (kRecords && moves && n.record[node] >= 0) record = RecordOf(n, n.record[node], lane);
  const double inverse_mass = moves ? n.inverse_mass[node] : 0;
  const double gravity = lane == 0 ? args.gravity[0] : lane == 1 ? args.gravity[1] : args.gravity[2];
  double u = moves ? n.u[3 * node + lane] : 0, v = moves ? n.v[3 * node + lane] : 0;
  if (moves) memory[0][lane][own] = kBeta ? u + beta * v : u;
  // what stands still does so in both buffers
  for (int i = t; i < 3 * (r.far_start[block + 1] - r.far_start[block]); i += r.threads) {
    const int far = 3 * r.far[r.far_start[block] + i / 3] + i % 3, place = r.own[block] + i / 3;
    memory[0][i % 3][place] = memory[1][i % 3][place] = kBeta ? n.u[far] + beta * n.v[far] : n.u[far];
  }
  if (t == 0) {
    for (int b = 0; b < 2; ++b) asm volatile("mbarrier.init.shared::cta.b64 [%0], 1;" ::"r"(arrived_here + 8 * b));
    asm volatile("fence.mbarrier_init.release.cluster;" ::: "memory");
    for (int b = 0; b < 2; ++b) Expect(arrived_here + 8 * b, 24 * n_halo);
  }
  cooperative_groups::this_cluster().sync();
  const bool sends = node >= 0 && target[own][0] >= 0;

  auto advance = [&](auto buffer, int s) {
    constexpr int kNow = decltype(buffer)::value, kNext = 1 - kNow;
    double f[3] = {0, 0, 0};
    Couple<kNow * kBuffer>(k, at, std::make_integer_sequence<int, kCouplings>{}, f);
    const double force = SumOfLanes(f, lane);
    if (moves) {
      double a = AccelerationOf<false, false>(n, gravity, node, -1, lane, nullptr, inverse_mass, force);
      const double v_old = v;
      v = args.keep * v_old + args.kick * a;
      if (kRecords && record & kStill) v = 0;
      if (kRecords && record & ~kStill) {
        asm volatile("" : "+r"(record));  // registers are for the couplings, not for addresses of records
        const int row = record >> kRowShift, kind = record & kKind, step = first + s;
        // where every table is constant, one row of the schedule serves all steps
        const double *table = n.schedule + (n.n_tables > 1 ? 3ll * step * n.n_tables : 0);
        if (record & kLoaded) {
          a = AccelerationOf<true, false>(n, gravity, node, row, lane, table, inverse_mass, force);
          v = args.keep * v_old + args.kick * a;
        }
        if (kind != kFree)
          v = PrescribedVelocity(kind, n.value[3 * row + lane], table + 3 * n.table[3 * row + lane], u, args.dt);
        if (record & kWatched) WriteHistory(n, args, row, lane, step, u, v_old, v);
      }
      u += args.dt * v;
      if (!(fabs(v) < 1e100))
        atomicMin(&batch->failure, static_cast<unsigned long long>(first + s) << 32 | static_cast<unsigned>(node));
      const double w = kBeta ? u + beta * v : u;
      const std::uint32_t place = here + kNext * kBuffer + kComponent * lane;
      Store(place + 8 * own, w);
      if (sends && s + 1 < steps)
#pragma unroll
        for (int half = 0; half < kTargets; half += 4) {
          int to[4];
          asm volatile("ld.shared.v4.s32 {%0, %1, %2, %3}, [%4];"
                       : "=r"(to[0]), "=r"(to[1]), "=r"(to[2]), "=r"(to[3])
                       : "r"(target_here + 4 * half)
                       : "memory");
#pragma unroll
          for (int j = 0; j < 4; ++j)
            if (to[j] >= 0) Send(to[j], place, arrived_here + 8 * kNext, w);
          if (to[3] < 0) break;
        }
    }
    // one thread waits for what comes from other blocks, on barrier (s + 1) % 2 for the s / 2-th time, and all for that one:
    // more of them asking the barrier again and again would slow down what arrives
    if (t == 0 && n_halo > 0 && s + 1 < steps) {
      Await(arrived_here + 8 * kNext, s / 2 & 1);
      if (s + 3 < steps) Expect(arrived_here + 8 * kNext, 24 * n_halo);
    }
    __syncthreads();
  };
  for (int s = 0; s < steps; s += 2) {
    advance(std::integral_constant<int, 0>{}, s);
    if (s + 1 < steps) advance(std::integral_constant<int, 1>{}, s + 1);
  }
  if (moves) n.u[3 * node + lane] = u, n.v[3 * node + lane] = v;
  if (block == 0 && t == 0) batch->next = first + steps;
  cooperative_groups::this_cluster().sync();
#else
  (void)r, (void)n, (void)args, (void)beta, (void)batch, (void)first, (void)steps;
#endif
}

using Kernel = void (*)(RowView, NodeView, StepArgs, double, BatchState *, int, int);

/// The largest cluster of such blocks that this device runs at once, up to 16; 0: none.
int LargestCluster(Kernel kernel, int threads) {
  int device = 0, major = 0;
  cudaGetDevice(&device);
  cudaDeviceGetAttribute(&major, cudaDevAttrComputeCapabilityMajor, device);
  if (major < 9) return 0;
  if (cudaFuncSetAttribute(kernel, cudaFuncAttributeNonPortableClusterSizeAllowed, 1) != cudaSuccess) {
    (void)cudaGetLastError();
    return 0;
  }
  for (int size = 16; size > 0; size /= 2) {
    cudaLaunchAttribute cluster = {};
    cluster.id = cudaLaunchAttributeClusterDimension;
    cluster.val.clusterDim.x = size;
    cluster.val.clusterDim.y = cluster.val.clusterDim.z = 1;
    cudaLaunchConfig_t config = {};
    config.gridDim = dim3(size);
    config.blockDim = dim3(threads);
    config.attrs = &cluster;
    config.numAttrs = 1;
    int clusters = 0;
    if (cudaOccupancyMaxActiveClusters(&clusters, kernel, &config) == cudaSuccess && clusters > 0) return size;
    (void)cudaGetLastError();
  }
  return 0;
}

}  // namespace

PetscErrorCode RowsWay::Create(const Tables &tables, std::string *why) {
  PetscFunctionBeginUser;
  *why = NoRows(tables);
  if (!why->empty()) PetscFunctionReturn(PETSC_SUCCESS);
  const std::vector<char> still = StillNodes(tables);
  bool records = false;  // of nodes that move
  for (int i = 0; i < tables.n_owned && tables.records.n > 0; ++i)
    records = records || (!still[i] && tables.records.of_node[i] >= 0);
  beta_ = tables.beta;
  kernel_ = beta_ != 0 ? (records ? RowsKernel<true, true> : RowsKernel<false, true>)
                       : (records ? RowsKernel<true, false> : RowsKernel<false, false>);
  const int largest = LargestCluster(kernel_, kRowThreads);
  if (largest == 0)
    *why = "a GPU without clusters of blocks";
  else if (std::count(still.begin(), still.end(), 0) > largest * RowPlan::kNodes)  // before rows are made of them
    *why = "more than " + std::to_string(largest * RowPlan::kNodes) + " nodes that move";
  if (!why->empty()) PetscFunctionReturn(PETSC_SUCCESS);
  RowPlan plan;
  *why = PlanRows(AssembleRows(tables), tables.x, still, largest, &plan);
  if (!why->empty()) PetscFunctionReturn(PETSC_SUCCESS);
  n_blocks_ = plan.n_blocks;
  threads_ = plan.threads;
  PetscCall(node_.Upload(plan.node));
  PetscCall(coefficient_.Upload(plan.coefficient));
  PetscCall(slot_.Upload(plan.slot));
  PetscCall(target_.Upload(plan.target));
  PetscCall(own_.Upload(plan.own));
  PetscCall(halo_.Upload(plan.halo));
  PetscCall(far_start_.Upload(plan.far_start));
  PetscCall(far_.Upload(plan.far));
  PetscFunctionReturn(PETSC_SUCCESS);
}

std::size_t RowsWay::Bytes() const {
  return node_.bytes() + coefficient_.bytes() + slot_.bytes() + target_.bytes() + own_.bytes() + halo_.bytes() +
         far_start_.bytes() + far_.bytes();
}

PetscErrorCode RowsWay::Run(const NodeView &nodes, const StepArgs &args, BatchState *batch, int first, int n,
                            cudaStream_t stream) {
  PetscFunctionBeginUser;
  if (n == 0) PetscFunctionReturn(PETSC_SUCCESS);
  cudaLaunchAttribute cluster = {};
  cluster.id = cudaLaunchAttributeClusterDimension;
  cluster.val.clusterDim.x = n_blocks_;
  cluster.val.clusterDim.y = cluster.val.clusterDim.z = 1;
  cudaLaunchConfig_t config = {};
  config.gridDim = dim3(n_blocks_);
  config.blockDim = dim3(threads_);
  config.stream = stream;
  config.attrs = &cluster;
  config.numAttrs = 1;
  const RowView view{threads_,   node_.get(), coefficient_.get(), slot_.get(), target_.get(),
                     own_.get(), halo_.get(), far_start_.get(),   far_.get()};
  CdemCuda(cudaLaunchKernelEx(&config, kernel_, view, nodes, args, beta_, batch, first, n));
  PetscFunctionReturn(PETSC_SUCCESS);
}

}  // namespace cdem
