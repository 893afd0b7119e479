// The way `assembled` on the GPU: a product of PETSc's matrix a step, and a kernel that moves the nodes.
#pragma once
#include "cuda/kernel_common.cuh"
#include "forces/assembled.hpp"

#include "cuda/device_array.cuh"

namespace cdem {

class CudaAssembledWay {
 public:
  CudaAssembledWay() = default;
  CudaAssembledWay(const CudaAssembledWay &) = delete;
  CudaAssembledWay &operator=(const CudaAssembledWay &) = delete;
  ~CudaAssembledWay();
  /// Errors: a scene that cannot go this way. [in] u: [n_owned][3] of the device.
  PetscErrorCode Create(const Tables &tables, bool audited, double *u);
  /// All steps of a batch, on PETSc's stream.
  PetscErrorCode Run(const NodeView &nodes, const Batch &batch, BatchState *state);
  const Way &way() const { return way_; }
  std::size_t Bytes() const { return StiffnessBytes(stiffness_) + f_.bytes() + damped_.bytes(); }

 private:
  void (*kernel_)(NodeView, StepArgs, const double *, BatchState *, int) = nullptr;
  Mat stiffness_ = nullptr;
  Vec vec_u_ = nullptr, vec_damped_ = nullptr, vec_f_ = nullptr;
  DeviceArray<double> f_, damped_;  // damped_: u + beta v; empty without beta
  double beta_ = 0;
  Way way_;
};

}  // namespace cdem
