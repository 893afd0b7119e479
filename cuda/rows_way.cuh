// A small linear scene on one cluster of thread blocks: assembled rows in registers, all steps of a batch in one launch.
#pragma once
#include "cuda/device_array.cuh"
#include "cuda/node_kernels.cuh"
#include "forces/rows.hpp"

namespace cdem {

/// Pointers of a RowPlan on the device, in its order.
struct RowView {
  int threads;
  const int *node;
  const double *coefficient;
  const unsigned short *slot;
  const int *target, *own, *halo, *far_start, *far;
};

class RowsWay {
 public:
  /// Prepares the way for a scene. [out] why: that it cannot be taken, or empty.
  PetscErrorCode Create(const Tables &tables, std::string *why);
  std::size_t Bytes() const;
  /// Launches n equal steps, the first of them step `first` of the batch.
  PetscErrorCode Run(const NodeView &nodes, const StepArgs &args, BatchState *batch, int first, int n,
                     cudaStream_t stream);
  int n_blocks() const { return n_blocks_; }

 private:
  void (*kernel_)(RowView, NodeView, StepArgs, double, BatchState *, int, int) = nullptr;
  double beta_ = 0;
  int n_blocks_ = 0, threads_ = 0;
  DeviceArray<int> node_, target_, own_, halo_, far_start_, far_;
  DeviceArray<double> coefficient_;
  DeviceArray<unsigned short> slot_;
};

}  // namespace cdem
