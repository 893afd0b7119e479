// Errors a user can mend: one short message, exit code 1, no traceback.
#pragma once
#include "core/petsc.hpp"

#include <string>

namespace cdem {

/// Installs the error handler: a CdemCheck failure prints "cdem: error: ..." once; anything else keeps PETSc's traceback.
/// Before PetscInitialize has returned every failure is the user's (an options file that cannot be read) and prints so.
/// Such a message names the options files of the command line.
PetscErrorCode InstallErrorHandler(int argc = 0, char **argv = nullptr);

/// Ends the program after a failed call: exit code 1, all ranks of PETSC_COMM_WORLD with it. Does not return.
[[noreturn]] void ExitOnError();

/// Raises the failure (not "") of the lowest rank that has one, with the same text on every rank. Collective.
PetscErrorCode CheckFailure(MPI_Comm comm, std::string failure);

}  // namespace cdem

/// Raises an error of the user's input unless cond holds. With a communicator of several ranks the check must be
/// collective and give the same answer everywhere (only rank 0 prints); with PETSC_COMM_SELF the rank prints by itself.
/// The message says what is wrong, where, and what to do.
#define CdemCheck(cond, comm, ...) PetscCheck(cond, comm, PETSC_ERR_USER_INPUT, __VA_ARGS__)
