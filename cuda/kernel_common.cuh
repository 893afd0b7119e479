// What the kernels share: sizes, the state of a batch, sums of a block.
#pragma once
#include "core/host_device.hpp"

#include <climits>
#include <cub/block/block_reduce.cuh>

namespace cdem {

inline constexpr int kBlock = 128;       ///< threads of spring and node kernels, and of all observing ones
inline constexpr int kNoSlot = INT_MAX;  ///< padding of the slot lists
inline constexpr int kElementSums = 3, kSpringSums = 5, kNodeSums = 9;  ///< columns of partial sums

/// What the kernels of a batch share: the step within the batch and the first failure (step << 32 | node).
struct BatchState {
  int step;
  unsigned long long failure;
};

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
