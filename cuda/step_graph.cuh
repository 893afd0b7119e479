// Equal steps recorded once and replayed, so that the host has little to launch.
#pragma once
#include "cuda/device_tables.cuh"

namespace cdem {

/// The graphs of equal steps, a short and a long one. (One that repeats itself by a conditional node was tried: it takes
/// 28 ms to make, and 8,000 steps of 1,000 hexahedra do not gain that back.)
class StepGraphs {
 public:
  StepGraphs() = default;
  StepGraphs(const StepGraphs &) = delete;
  StepGraphs &operator=(const StepGraphs &) = delete;
  ~StepGraphs() { Drop(); }

  /// Launches n equal steps. [in] nodes, args: a change of args makes the graphs anew; of addresses, see Drop.
  PetscErrorCode Run(DeviceTables *tables, const NodeView &nodes, const StepArgs &args, BatchState *batch,
                     const LaunchArgs &launch, int n);
  /// Forgets the graphs, which hold the addresses they were made with.
  void Drop();

 private:
  static constexpr int kShort = 8, kLong = 64;  ///< steps
  static constexpr int kWorthwhile = 200;       ///< steps of new args from which on graphs are made at once
  PetscErrorCode Capture(int steps, DeviceTables *tables, const NodeView &nodes, const StepArgs &args,
                         BatchState *batch, const LaunchArgs &launch, cudaGraphExec_t *exec);

  cudaGraphExec_t short_ = nullptr, long_ = nullptr;
  StepArgs args_;
};

}  // namespace cdem
