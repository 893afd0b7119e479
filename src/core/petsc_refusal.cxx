#include "core/petsc_refusal.hpp"

#include "core/error.hpp"

#include <string>

namespace cdem {

static PetscErrorCode KeepFirst(MPI_Comm, int, const char *, const char *, PetscErrorCode code, PetscErrorType type,
                                const char *message, void *text) {
  if (type == PETSC_ERROR_INITIAL && message) *static_cast<std::string *>(text) = message;
  return code;
}

PetscErrorCode SetFromOptions(MPI_Comm comm, const char *whose, PetscErrorCode (*set)(void *), void *object) {
  PetscFunctionBeginUser;
  std::string message;
  PetscCall(PetscPushErrorHandler(KeepFirst, &message));
  const PetscErrorCode refused = set(object);
  PetscCall(PetscPopErrorHandler());
  CdemCheck(!refused, comm, "PETSc refuses an option of its %s: %s", whose,
            message.empty() ? "it does not say why" : message.c_str());
  PetscFunctionReturn(PETSC_SUCCESS);
}

}  // namespace cdem
