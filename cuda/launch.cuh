// Launching kernels.
#pragma once
#include "core/error.hpp"
#include "cuda/device_array.cuh"

namespace cdem {

/// How the kernels of a step are launched.
struct LaunchArgs {
  int block = 32;        ///< threads of the element kernels
  bool overlap = false;  ///< a kernel may begin while the one before it ends
  bool timed = false;    ///< every phase in its log event, waited for
  bool single = false;   ///< arithmetic of elements in single precision
  bool load = false;     ///< nothing is launched: the code of the kernels is brought to the GPU, which takes a while
  cudaStream_t stream = nullptr;
};

inline int Blocks(int n, int block) { return (n + block - 1) / block; }

/// Launches a kernel; with overlap it may begin while the one before it in the stream ends (WaitForPrevious).
template <class... Params, class... Args>
PetscErrorCode Launch(void (*kernel)(Params...), int blocks, int block, const LaunchArgs &launch, const Args &...args) {
  PetscFunctionBeginUser;
  if (launch.load) {
    cudaFuncAttributes unused;
    CdemCuda(cudaFuncGetAttributes(&unused, kernel));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  cudaLaunchAttribute early;
  early.id = cudaLaunchAttributeProgrammaticStreamSerialization;
  early.val.programmaticStreamSerializationAllowed = 1;
  cudaLaunchConfig_t config = {};
  config.gridDim = dim3(blocks);
  config.blockDim = dim3(block);
  config.stream = launch.stream;
  config.attrs = &early;
  config.numAttrs = launch.overlap ? 1 : 0;
  CdemCuda(cudaLaunchKernelEx(&config, kernel, static_cast<Params>(args)...));
  PetscFunctionReturn(PETSC_SUCCESS);
}

}  // namespace cdem
