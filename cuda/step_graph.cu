#include "cuda/step_graph.cuh"

#include "core/error.hpp"

#include <utility>

namespace cdem {

void StepGraphs::Drop() {
  for (cudaGraphExec_t *exec : {&short_, &long_})
    if (*exec) cudaGraphExecDestroy(std::exchange(*exec, nullptr));
}

PetscErrorCode StepGraphs::Run(DeviceTables *tables, const NodeView &nodes, const StepArgs &args, BatchState *batch,
                               const LaunchArgs &launch, int n) {
  PetscFunctionBeginUser;
  if (!(args == args_)) {
    Drop();
    args_ = args;
    if (n < kWorthwhile) {  // such as a relaxation whose damping changes at every check
      for (int i = 0; i < n; ++i) PetscCall(tables->LaunchStep(nodes, args, batch, launch));
      PetscFunctionReturn(PETSC_SUCCESS);
    }
  }
  // the few steps first: a long graph takes the host long to launch, and so the GPU already works while it does
  for (int i = 0; i < n % kShort; ++i) PetscCall(tables->LaunchStep(nodes, args, batch, launch));
  const int shorts = n % kLong / kShort;
  if (shorts > 0 && !short_) PetscCall(Capture(kShort, tables, nodes, args, batch, launch, &short_));
  for (int i = 0; i < shorts; ++i) CdemCuda(cudaGraphLaunch(short_, launch.stream));
  if (n >= kLong && !long_) PetscCall(Capture(kLong, tables, nodes, args, batch, launch, &long_));
  for (int i = 0; i < n / kLong; ++i) CdemCuda(cudaGraphLaunch(long_, launch.stream));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode StepGraphs::Capture(int steps, DeviceTables *tables, const NodeView &nodes, const StepArgs &args,
                                   BatchState *batch, const LaunchArgs &launch, cudaGraphExec_t *exec) {
  PetscFunctionBeginUser;
  cudaGraph_t graph;
  CdemCuda(cudaStreamBeginCapture(launch.stream, cudaStreamCaptureModeThreadLocal));
  for (int i = 0; i < steps; ++i) PetscCall(tables->LaunchStep(nodes, args, batch, launch));
  CdemCuda(cudaStreamEndCapture(launch.stream, &graph));
  CdemCuda(cudaGraphInstantiate(exec, graph, 0));
  CdemCuda(cudaGraphUpload(*exec, launch.stream));
  CdemCuda(cudaGraphDestroy(graph));
  PetscFunctionReturn(PETSC_SUCCESS);
}

}  // namespace cdem
