#include "cuda/kernel_common.cuh"
#include "cuda/order_free_sum.cuh"

#include <math_constants.h>

#include <algorithm>
#include <limits>

namespace cdem {

namespace {

constexpr int kMostBlocks = 1024;

int SumBlocks(std::size_t n) { return static_cast<int>(std::min<std::size_t>(kMostBlocks, (n + kBlock - 1) / kBlock)); }

/// The largest size of each block's numbers; infinity where one is not finite.
__global__ void __launch_bounds__(kBlock) LargestKernel(Summands s, double *largest) {
  double most = 0;
  for (std::size_t i = blockIdx.x * static_cast<std::size_t>(kBlock) + threadIdx.x; i < s.n;
       i += static_cast<std::size_t>(gridDim.x) * kBlock) {
    if (s.counted && !s.counted[i]) continue;
    const double size = fabs(s.value[i]);
    if (!(size <= most)) most = isfinite(size) ? size : CUDART_INF;
  }
  using Reduce = cub::BlockReduce<double, kBlock>;
  __shared__ typename Reduce::TempStorage storage;
  most = Reduce(storage).Reduce(most, [](double p, double q) { return p > q ? p : q; });
  if (threadIdx.x == 0) largest[blockIdx.x] = most;
}

__global__ void __launch_bounds__(kBlock) CutKernel(Summands s, SumUnit unit, long long *part) {
  long long sum[2] = {0, 0};
  for (std::size_t i = blockIdx.x * static_cast<std::size_t>(kBlock) + threadIdx.x; i < s.n;
       i += static_cast<std::size_t>(gridDim.x) * kBlock) {
    if (s.counted && !s.counted[i]) continue;
    long long cut[2];
    unit.Cut(s.value[i], cut);
    sum[0] += cut[0];
    sum[1] += cut[1];
  }
  using Reduce = cub::BlockReduce<long long, kBlock>;
  __shared__ typename Reduce::TempStorage storage;
  for (int k = 0; k < 2; ++k) {
    const long long all = Reduce(storage).Sum(sum[k]);
    if (threadIdx.x == 0) part[2 * blockIdx.x + k] = all;
    __syncthreads();
  }
}

}  // namespace

PetscErrorCode OrderFreeSum::Sum(MPI_Comm comm, cudaStream_t stream, const std::vector<std::vector<Summands>> &terms,
                                 std::vector<double> *sums) {
  PetscFunctionBeginUser;
  const int n = static_cast<int>(terms.size());
  std::size_t rows = 0;
  for (const auto &term : terms) rows += term.size();
  if (largest_.size() < rows * kMostBlocks) {
    PetscCall(largest_.Allocate(rows * kMostBlocks));
    PetscCall(part_.Allocate(2 * rows * kMostBlocks));
  }
  std::size_t row = 0;
  for (const auto &term : terms)
    for (const Summands &s : term) {
      if (s.n > 0) LargestKernel<<<SumBlocks(s.n), kBlock, 0, stream>>>(s, largest_.get() + row * kMostBlocks);
      ++row;
    }
  CdemCuda(cudaGetLastError());
  CdemCuda(cudaStreamSynchronize(stream));
  std::vector<double> of_block, largest(terms.size(), 0.0);
  PetscCall(largest_.Download(&of_block));
  row = 0;
  for (std::size_t t = 0; t < terms.size(); ++t)
    for (const Summands &s : terms[t]) {
      const auto first = of_block.begin() + static_cast<std::ptrdiff_t>(row++ * kMostBlocks);
      if (s.n > 0) largest[t] = std::max(largest[t], *std::max_element(first, first + SumBlocks(s.n)));
    }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, largest.data(), n, MPI_DOUBLE, MPI_MAX, comm));
  row = 0;
  for (std::size_t t = 0; t < terms.size(); ++t)
    for (const Summands &s : terms[t]) {
      if (s.n > 0 && std::isfinite(largest[t]))
        CutKernel<<<SumBlocks(s.n), kBlock, 0, stream>>>(s, SumUnit::Of(largest[t]),
                                                         part_.get() + 2 * row * kMostBlocks);
      ++row;
    }
  CdemCuda(cudaGetLastError());
  CdemCuda(cudaStreamSynchronize(stream));
  std::vector<long long> cut, part(2 * terms.size(), 0);
  PetscCall(part_.Download(&cut));
  row = 0;
  for (std::size_t t = 0; t < terms.size(); ++t)
    for (const Summands &s : terms[t]) {
      for (int b = 0; s.n > 0 && std::isfinite(largest[t]) && b < SumBlocks(s.n); ++b)
        for (int k = 0; k < 2; ++k) part[2 * t + k] += cut[2 * (row * kMostBlocks + b) + k];
      ++row;
    }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, part.data(), 2 * n, MPI_LONG_LONG, MPI_SUM, comm));
  sums->resize(terms.size());
  for (std::size_t t = 0; t < terms.size(); ++t)
    (*sums)[t] = std::isfinite(largest[t]) ? SumUnit::Of(largest[t]).Value(&part[2 * t])
                                           : std::numeric_limits<double>::quiet_NaN();
  PetscFunctionReturn(PETSC_SUCCESS);
}

}  // namespace cdem
