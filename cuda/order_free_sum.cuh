// Sums of numbers on the device that do not depend on their order nor on the ranks: as on the CPU (core/order_free_sum.hpp).
#pragma once
#include "core/order_free_sum.hpp"
#include "cuda/launch.cuh"

namespace cdem {

/// Sums several terms; every number is read twice, once for the largest and once for the sum.
class OrderFreeSum {
 public:
  /// [in] terms: device pointers. sums[i] = the sum of terms[i] over all ranks (collective).
  PetscErrorCode Sum(MPI_Comm comm, cudaStream_t stream, const std::vector<std::vector<Summands>> &terms,
                     std::vector<double> *sums);

 private:
  DeviceArray<double> largest_;
  DeviceArray<long long> part_;
};

}  // namespace cdem
