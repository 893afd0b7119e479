#include "core/error.hpp"

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <thread>

namespace cdem {

static bool user_error = false;  // every rank stops at one; rank 0 says it
static std::string option_files;

static PetscErrorCode HandleError(MPI_Comm comm, int line, const char *function, const char *file, PetscErrorCode code,
                                  PetscErrorType type, const char *message, void *ctx) {
  PetscBool started = PETSC_FALSE;
  PetscInitialized(&started);
  if (type == PETSC_ERROR_INITIAL && (code == PETSC_ERR_USER_INPUT || !started)) {
    user_error = true;
    int rank = 0;
    MPI_Comm_rank(comm, &rank);
    if (rank == 0) {
      std::fflush(stdout);
      // PETSc does not say which file its parser stumbled over
      const bool hint =
          !started && !option_files.empty() && std::string(message).find(option_files) == std::string::npos;
      std::fprintf(stderr, "cdem: error: %s%s%s%s\n", message, hint ? "; the options are read from " : "",
                   hint ? option_files.c_str() : "", hint ? ": look at its indentation, colons and brackets" : "");
      std::fflush(stderr);
    }
    return code;
  }
  if (user_error) return code;  // the calls on the way out report the same code: they stay silent
  return PetscTraceBackErrorHandler(comm, line, function, file, code, type, message, ctx);
}

PetscErrorCode InstallErrorHandler(int argc, char **argv) {
  PetscFunctionBeginUser;
  for (int i = 1; i + 1 < argc; ++i)
    if (std::string(argv[i]) == "-options_file")
      option_files += (option_files.empty() ? "" : " and ") + std::string(argv[i + 1]);
  PetscCall(PetscPushErrorHandler(HandleError, nullptr));
  PetscFunctionReturn(PETSC_SUCCESS);
}

void ExitOnError() {
  int size = 1, rank = 0, mpi = 0;
  MPI_Initialized(&mpi);
  if (mpi) {
    MPI_Comm_size(MPI_COMM_WORLD, &size);
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  }
  std::fflush(nullptr);
  // The first abort ends all ranks, rank 0 too: it gets the time to say what is wrong.
  if (user_error && rank > 0) std::this_thread::sleep_for(std::chrono::seconds(10));
  if (size > 1) MPI_Abort(MPI_COMM_WORLD, 1);
  std::_Exit(1);  // the state of MPI and the device is unknown here: destructors must not run
}

PetscErrorCode CheckFailure(MPI_Comm comm, std::string failure) {
  PetscFunctionBeginUser;
  int size, rank, first;
  PetscCallMPI(MPI_Comm_size(comm, &size));
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  const int mine = failure.empty() ? size : rank;
  PetscCallMPI(MPI_Allreduce(&mine, &first, 1, MPI_INT, MPI_MIN, comm));
  if (first == size) PetscFunctionReturn(PETSC_SUCCESS);
  int length = static_cast<int>(failure.size());
  PetscCallMPI(MPI_Bcast(&length, 1, MPI_INT, first, comm));
  failure.resize(static_cast<std::size_t>(length));
  PetscCallMPI(MPI_Bcast(&failure[0], length, MPI_CHAR, first, comm));
  CdemCheck(false, comm, "%s", failure.c_str());
  PetscFunctionReturn(PETSC_SUCCESS);
}

}  // namespace cdem
