// What must happen before PetscInitialize.
#pragma once
#include "core/petsc.hpp"

namespace cdem {

/// Tells PETSc whether this MPI can read device memory, so that a build with CUDA starts with any MPI: without it the
/// halo goes through the host. -use_gpu_aware_mpi on the command line still wins.
PetscErrorCode PrepareGpuMpi();

}  // namespace cdem
