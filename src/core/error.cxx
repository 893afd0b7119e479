#include "core/error.hpp"

#include <cstdio>
#include <cstdlib>

namespace cdem {

static PetscErrorCode HandleError(MPI_Comm comm, int line, const char *function, const char *file, PetscErrorCode code,
                                  PetscErrorType type, const char *message, void *ctx) {
  static bool user_error = false;  // the calls on the way out report the same code: they stay silent
  PetscBool started = PETSC_FALSE;
  PetscInitialized(&started);
  if (type == PETSC_ERROR_INITIAL && (code == PETSC_ERR_USER_INPUT || !started)) {
    user_error = true;
    int rank = 0;
    MPI_Comm_rank(comm, &rank);
    if (rank == 0) {
      std::fflush(stdout);
      std::fprintf(stderr, "cdem: error: %s\n", message);
      std::fflush(stderr);
    }
    return code;
  }
  if (user_error) return code;
  return PetscTraceBackErrorHandler(comm, line, function, file, code, type, message, ctx);
}

PetscErrorCode InstallErrorHandler() {
  PetscFunctionBeginUser;
  PetscCall(PetscPushErrorHandler(HandleError, nullptr));
  PetscFunctionReturn(PETSC_SUCCESS);
}

void ExitOnError() {
  int size = 1, mpi = 0;
  MPI_Initialized(&mpi);
  if (mpi) MPI_Comm_size(MPI_COMM_WORLD, &size);
  std::fflush(nullptr);
  if (size > 1) MPI_Abort(MPI_COMM_WORLD, 1);
  std::_Exit(1);  // the state of MPI and the device is unknown here: destructors must not run
}

}  // namespace cdem
