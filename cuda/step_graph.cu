#include "cuda/step_graph.cuh"

#include "core/error.hpp"
#include "cuda/device_array.cuh"

#include <utility>

namespace cdem {

void StepGraphs::Drop() {
  for (cudaGraphExec_t *exec : {&short_, &long_})
    if (*exec) cudaGraphExecDestroy(std::exchange(*exec, nullptr));
}

PetscErrorCode StepGraphs::Run(const StepArgs &args, cudaStream_t stream, int n,
                               const std::function<PetscErrorCode()> &step) {
  PetscFunctionBeginUser;
  if (!(args == args_)) {
    Drop();
    args_ = args;
    if (n < kWorthwhile) {  // such as a relaxation whose damping changes at every check
      for (int i = 0; i < n; ++i) PetscCall(step());
      PetscFunctionReturn(PETSC_SUCCESS);
    }
  }
  // the few steps first: a long graph takes the host long to launch, and so the GPU already works while it does
  for (int i = 0; i < Singles(n); ++i) PetscCall(step());
  const int shorts = n % kLong / kShort;
  if (shorts > 0 && !short_) PetscCall(Capture(kShort, stream, step, &short_));
  for (int i = 0; i < shorts; ++i) CdemCuda(cudaGraphLaunch(short_, stream));
  if (n >= kLong && !long_) PetscCall(Capture(kLong, stream, step, &long_));
  for (int i = 0; i < n / kLong; ++i) CdemCuda(cudaGraphLaunch(long_, stream));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode StepGraphs::Capture(int steps, cudaStream_t stream, const std::function<PetscErrorCode()> &step,
                                   cudaGraphExec_t *exec) {
  PetscFunctionBeginUser;
  cudaGraph_t graph;
  CdemCuda(cudaStreamBeginCapture(stream, cudaStreamCaptureModeThreadLocal));
  for (int i = 0; i < steps; ++i) PetscCall(step());
  CdemCuda(cudaStreamEndCapture(stream, &graph));
  CdemCuda(cudaGraphInstantiate(exec, graph, 0));
  CdemCuda(cudaGraphUpload(*exec, stream));
  CdemCuda(cudaGraphDestroy(graph));
  PetscFunctionReturn(PETSC_SUCCESS);
}

}  // namespace cdem
