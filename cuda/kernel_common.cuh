// What the kernels share: sizes, the state of a batch, sums of a block.
#pragma once
#include "core/host_device.hpp"

#include <climits>
#include <cub/block/block_reduce.cuh>

namespace cdem {

inline constexpr int kBlock = 128;       ///< threads of spring and node kernels, and of all observing ones
inline constexpr int kNodeBlock = 64;    ///< threads of the stepping node kernel: it has few blocks in small scenes
inline constexpr int kNoSlot = INT_MAX;  ///< padding of the slot lists
inline constexpr int kElementSums = 4, kSpringSums = 5, kNodeSums = 10;  ///< columns of partial sums

/// What the kernels of a batch share. The first element kernel of a step sets step from next, the node kernel sets next
/// from step: no kernel reads what it writes.
struct BatchState {
  int next, step;              ///< within the batch: for element kernels; for node kernels
  unsigned long long failure;  ///< the first one: step << 32 | node
  double base, dt;             ///< of the time of a step, see StepEnd
  long long offset;
};

/// Waits for the kernel before, where this one was allowed to begin early; until then only constant data may be touched.
/// Then lets the next one begin early too. [in] early: kernels of this step were launched so; in large scenes the wait
/// of every block costs more than the overlap gains.
__device__ __forceinline__ void WaitForPrevious(bool early) {
#if __CUDA_ARCH__ >= 900
  if (early) {
    cudaGridDependencySynchronize();
    cudaTriggerProgrammaticLaunchCompletion();
  }
#endif
}

/// Copies n numbers, behind what the kernel before wrote.
static __global__ void __launch_bounds__(kBlock) CopyKernel(int n, bool early, const double *from, double *to) {
  const int i = blockIdx.x * blockDim.x + threadIdx.x;
  WaitForPrevious(early);
  if (i < n) to[i] = from[i];
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

}  // namespace cdem
