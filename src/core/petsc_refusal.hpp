// Options that PETSc itself reads: what it refuses is the user's error, and said like one.
#pragma once
#include "core/petsc.hpp"

namespace cdem {

/// Calls set(object), such as TSSetFromOptions, and raises its failure as an error of the user's, in PETSc's words.
/// Collective: every rank reads the same options. [in] whose: "time stepper", say.
PetscErrorCode SetFromOptions(MPI_Comm comm, const char *whose, PetscErrorCode (*set)(void *), void *object);

}  // namespace cdem
