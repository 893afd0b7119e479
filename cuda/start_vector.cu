// The start vector of the sharp critical step on the GPU: on the host it would take longer than all that follows.
#include "forces/start_vector.hpp"

#include "cuda/kernel_common.cuh"
#include "cuda/launch.cuh"

#include <petscdevice_cuda.h>

namespace cdem {

namespace {

__global__ void __launch_bounds__(kBlock)
    RandomKernel(int n, std::uint64_t key, double size, const std::int64_t *node, double *x) {
  const int i = blockIdx.x * blockDim.x + threadIdx.x;
  if (i < n) RandomComponents(key, size, node[i], x + 3ll * i);
}

/// One thread, one after the other: components may come twice, and there are a few dozen at most.
__global__ void AddKernel(int n, const long long *at, const double *added, double *x) {
  for (int i = 0; i < n; ++i) x[at[i]] += added[i];
}

}  // namespace

PetscErrorCode FillCudaStart(const std::vector<std::int64_t> &global, const StartParts &parts, Vec start) {
  PetscFunctionBeginUser;
  const int n = static_cast<int>(global.size()), n_added = static_cast<int>(parts.at.size());
  DeviceArray<std::int64_t> node;
  DeviceArray<long long> at;
  DeviceArray<double> added;
  PetscCall(node.Upload(global));
  PetscCall(at.Upload(parts.at));
  PetscCall(added.Upload(parts.added));
  LaunchArgs launch;
  launch.stream = PetscDefaultCudaStream;
  PetscScalar *x;
  PetscCall(VecCUDAGetArrayWrite(start, &x));
  if (n > 0)
    PetscCall(Launch(RandomKernel, Blocks(n, kBlock), kBlock, launch, n, parts.key, parts.size, node.get(), x));
  if (n_added > 0) PetscCall(Launch(AddKernel, 1, 1, launch, n_added, at.get(), added.get(), x));
  PetscCall(VecCUDARestoreArrayWrite(start, &x));
  PetscFunctionReturn(PETSC_SUCCESS);  // freeing the arrays waits for the kernels
}

}  // namespace cdem
