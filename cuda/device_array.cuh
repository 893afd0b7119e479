// Device memory with an owner, and CUDA errors as PETSc errors.
#pragma once
#include "core/petsc.hpp"

#include <cuda_runtime.h>

#include <utility>
#include <vector>

/// Calls CUDA and turns a failure into a PETSc error with CUDA's own text.
#define CdemCuda(call)                                                                           \
  do {                                                                                           \
    cudaError_t cdem_cuda_error_ = (call);                                                       \
    PetscCheck(cdem_cuda_error_ == cudaSuccess, PETSC_COMM_SELF, PETSC_ERR_GPU, "CUDA: %s (%s)", \
               cudaGetErrorString(cdem_cuda_error_), #call);                                     \
  } while (0)

namespace cdem {

/// An array on the device; moves but does not copy.
template <class T>
class DeviceArray {
 public:
  DeviceArray() = default;
  DeviceArray(const DeviceArray &) = delete;
  DeviceArray &operator=(const DeviceArray &) = delete;
  DeviceArray(DeviceArray &&o) noexcept : data_(std::exchange(o.data_, nullptr)), size_(std::exchange(o.size_, 0)) {}
  DeviceArray &operator=(DeviceArray &&o) noexcept {
    std::swap(data_, o.data_);
    std::swap(size_, o.size_);
    return *this;
  }
  ~DeviceArray() { cudaFree(data_); }

  /// Makes room for n values, all bytes zero.
  PetscErrorCode Allocate(std::size_t n) {
    PetscFunctionBeginUser;
    CdemCuda(cudaFree(data_));
    data_ = nullptr;
    size_ = n;
    if (n > 0) {
      CdemCuda(cudaMalloc(&data_, n * sizeof(T)));
      CdemCuda(cudaMemset(data_, 0, n * sizeof(T)));
      CdemCuda(
          cudaStreamSynchronize(nullptr));  // whoever uses it next may be on a stream that does not wait for this one
    }
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscErrorCode Upload(const std::vector<T> &host) {
    PetscFunctionBeginUser;
    PetscCall(Allocate(host.size()));
    if (size_ > 0) CdemCuda(cudaMemcpy(data_, host.data(), size_ * sizeof(T), cudaMemcpyHostToDevice));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  /// Writes over what is there; sizes must agree.
  PetscErrorCode Overwrite(const std::vector<T> &host) {
    PetscFunctionBeginUser;
    PetscCheck(host.size() == size_, PETSC_COMM_SELF, PETSC_ERR_PLIB, "%zu values for an array of %zu", host.size(),
               size_);
    if (size_ > 0) CdemCuda(cudaMemcpy(data_, host.data(), size_ * sizeof(T), cudaMemcpyHostToDevice));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscErrorCode Download(std::vector<T> *host) const {
    PetscFunctionBeginUser;
    host->resize(size_);
    if (size_ > 0) CdemCuda(cudaMemcpy(host->data(), data_, size_ * sizeof(T), cudaMemcpyDeviceToHost));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  T *get() const { return data_; }
  std::size_t size() const { return size_; }
  std::size_t bytes() const { return size_ * sizeof(T); }

 private:
  T *data_ = nullptr;
  std::size_t size_ = 0;
};

/// One value in page-locked host memory, which the device reads and writes without anybody waiting.
template <class T>
class PinnedValue {
 public:
  PinnedValue() = default;
  PinnedValue(const PinnedValue &) = delete;
  PinnedValue &operator=(const PinnedValue &) = delete;
  ~PinnedValue() { cudaFreeHost(data_); }
  PetscErrorCode Allocate() {
    PetscFunctionBeginUser;
    CdemCuda(cudaMallocHost(&data_, sizeof(T)));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  T *get() const { return data_; }

 private:
  T *data_ = nullptr;
};

}  // namespace cdem
