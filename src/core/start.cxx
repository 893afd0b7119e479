#include "core/start.hpp"

#if defined(OPEN_MPI)
#include <mpi-ext.h>
#endif

namespace cdem {

PetscErrorCode PrepareGpuMpi() {
  PetscFunctionBeginUser;
#ifdef CDEM_HAVE_CUDA
  bool aware = false;
#if defined(MPIX_CUDA_AWARE_SUPPORT) && MPIX_CUDA_AWARE_SUPPORT
  aware = MPIX_Query_cuda_support() == 1;
#endif
  if (!aware) PetscCall(PetscOptionsSetValue(nullptr, "-use_gpu_aware_mpi", "0"));
#endif
  PetscFunctionReturn(PETSC_SUCCESS);
}

}  // namespace cdem
