// Equal steps recorded once and replayed, so that the host has little to launch.
#pragma once
#include "core/petsc.hpp"
#include "forces/node_step.hpp"

#include <cuda_runtime.h>
#include <functional>

namespace cdem {

/// The graphs of equal steps, a short and a long one. (One that repeats itself by a conditional node was tried: it takes
/// 28 ms to make, and 8,000 steps of 1,000 hexahedra do not gain that back.)
class StepGraphs {
 public:
  StepGraphs() = default;
  StepGraphs(const StepGraphs &) = delete;
  StepGraphs &operator=(const StepGraphs &) = delete;
  ~StepGraphs() { Drop(); }

  /// Launches n equal steps. [in] args: a change of them makes the graphs anew; of addresses, see Drop. step: launches one
  /// on the stream.
  PetscErrorCode Run(const StepArgs &args, cudaStream_t stream, int n, const std::function<PetscErrorCode()> &step);
  /// Steps that are launched one by one before the graphs, which hold an even number of them.
  static int Singles(int n) { return n % kShort; }
  /// Forgets the graphs, which hold the addresses they were made with.
  void Drop();

 private:
  static constexpr int kShort = 8, kLong = 64;  ///< steps
  static constexpr int kWorthwhile = 200;       ///< steps of new args from which on graphs are made at once
  PetscErrorCode Capture(int steps, cudaStream_t stream, const std::function<PetscErrorCode()> &step,
                         cudaGraphExec_t *exec);

  cudaGraphExec_t short_ = nullptr, long_ = nullptr;
  StepArgs args_;
};

}  // namespace cdem
