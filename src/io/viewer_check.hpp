// PETSc's viewer syntax, looked at before PETSc opens what it asks for.
#pragma once
#include "core/petsc.hpp"

#include <string>

namespace cdem {

/// Errors: an option of a monitor, or one of PETSc's that print or draw (-ts_monitor, -ts_view, -dm_view, -log_view), that
/// is no viewer (type:file:format:mode) or names a file that cannot be written. Touches no file. Collective.
/// [in] output_dir: the folder of results, which may not be there yet; "" for none.
PetscErrorCode CheckViewers(MPI_Comm comm, const std::string &output_dir);

}  // namespace cdem
