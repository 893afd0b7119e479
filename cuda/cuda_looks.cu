// The part of the GPU backend that looks at the state.
#include "core/error.hpp"
#include "cuda/cuda_backend.cuh"

#include <petscdevice_cuda.h>

namespace cdem {

template <class Look>
PetscErrorCode CudaBackend::WithState(const double *schedule, Look &&look) {
  PetscFunctionBeginUser;
  const PetscScalar *u, *v;
  PetscCall(VecCUDAGetArrayRead(vec_u_, &u));
  PetscCall(VecCUDAGetArrayRead(vec_v_, &v));
  PetscCall(Reserve(1));
  if (schedule_.size() > 0)
    CdemCuda(cudaMemcpy(schedule_.get(), schedule, 3 * sizeof(double) * t_.n_tables, cudaMemcpyHostToDevice));
  PetscCall(Halo());
  CdemCuda(cudaDeviceSynchronize());
  PetscCall(look());
  PetscCall(VecCUDARestoreArrayRead(vec_u_, &u));
  PetscCall(VecCUDARestoreArrayRead(vec_v_, &v));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CudaBackend::Observe(const StepArgs &next, const double *schedule, Observed *observed) {
  PetscFunctionBeginUser;
  PetscCall(WithState(schedule, [&] { return tables_.Observe(View(), next, launch_.stream, observed); }));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CudaBackend::LookAtBalance(const StepArgs &next, const double *schedule, Observed *observed,
                                          BalanceTerms *terms) {
  PetscFunctionBeginUser;
  PetscCall(WithState(schedule, [&] { return tables_.LookAtBalance(View(), next, launch_.stream, observed, terms); }));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CudaBackend::KeepLook() {
  PetscFunctionBeginUser;
  PetscCall(tables_.KeepLook(u_.get(), launch_.stream));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CudaBackend::DownloadBalance(const BalanceMemory **memory) {
  PetscFunctionBeginUser;
  CdemCuda(cudaDeviceSynchronize());
  PetscCall(tables_.DownloadBalance(&host_balance_));
  *memory = &host_balance_;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CudaBackend::UploadBalance(const BalanceMemory &memory) {
  PetscFunctionBeginUser;
  PetscCall(tables_.UploadBalance(memory));
  CdemCuda(cudaDeviceSynchronize());
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CudaBackend::Kinetic(double *energy) {
  const PetscScalar *v;
  PetscFunctionBeginUser;
  PetscCall(VecCUDAGetArrayRead(vec_v_, &v));
  CdemCuda(cudaDeviceSynchronize());
  PetscCall(tables_.Kinetic(v, launch_.stream, energy));
  PetscCall(VecCUDARestoreArrayRead(vec_v_, &v));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CudaBackend::Audit(const StepArgs &next, const double *schedule, AuditSums *sums) {
  PetscFunctionBeginUser;
  PetscCheck(tables_.audited(), PETSC_COMM_SELF, PETSC_ERR_ORDER, "the energy audit is off");
  scheduled_ = 0;
  *state_.get() = BatchState{0, 0, ~0ull, 0, 0, 0};
  CdemCuda(cudaMemcpy(batch_.get(), state_.get(), sizeof(BatchState), cudaMemcpyHostToDevice));
  LaunchArgs plain = launch_;
  plain.overlap = plain.timed = false;
  PetscCall(WithState(schedule, [&] { return tables_.Audit(View(), next, batch_.get(), plain, sums); }));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CudaBackend::DownloadAudit(const AuditArrays **arrays) {
  PetscFunctionBeginUser;
  CdemCuda(cudaDeviceSynchronize());
  PetscCall(tables_.DownloadAudit(&host_audit_));
  *arrays = &host_audit_;
  PetscFunctionReturn(PETSC_SUCCESS);
}
PetscErrorCode CudaBackend::UploadAudit(const AuditArrays &arrays) {
  PetscFunctionBeginUser;
  PetscCall(tables_.UploadAudit(arrays));
  CdemCuda(cudaDeviceSynchronize());
  PetscFunctionReturn(PETSC_SUCCESS);
}

}  // namespace cdem
