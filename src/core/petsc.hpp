// PETSc's headers, and the only place that knows which version (3.18 to 3.24) is there.
#pragma once
#include <petscdmplex.h>
#include <petscsf.h>
#include <petscts.h>
#include <petscviewer.h>
#include <petscversion.h>

#if PETSC_VERSION_LT(3, 19, 0)
#define PETSC_SUCCESS ((PetscErrorCode)0)
#endif
#if PETSC_VERSION_LT(3, 21, 0) && !defined(PETSC_INT_MAX)
#define PETSC_INT_MAX PETSC_MAX_INT
#endif

namespace cdem {

/// The viewer that option -name asks for in PETSc's syntax (ascii:file:format); set tells whether it was given.
inline PetscErrorCode ViewerFromOption(MPI_Comm comm, const char *name, PetscViewer *viewer, PetscViewerFormat *format,
                                       PetscBool *set) {
#if PETSC_VERSION_LT(3, 22, 0)
  return PetscOptionsGetViewer(comm, nullptr, nullptr, name, viewer, format, set);
#else
  return PetscOptionsCreateViewer(comm, nullptr, nullptr, name, viewer, format, set);
#endif
}

/// DMPlexCreateBoxMesh of an interpolated, non-periodic box.
inline PetscErrorCode CreateBoxMesh(MPI_Comm comm, PetscBool simplex, const PetscInt cells[3], const PetscReal lower[3],
                                    const PetscReal upper[3], DM *dm) {
#if PETSC_VERSION_LT(3, 22, 0)
  return DMPlexCreateBoxMesh(comm, 3, simplex, cells, lower, upper, nullptr, PETSC_TRUE, dm);
#else
  return DMPlexCreateBoxMesh(comm, 3, simplex, cells, lower, upper, nullptr, PETSC_TRUE, 0, PETSC_FALSE, dm);
#endif
}

/// Order of the vertices of a point of type ct that a cone holds in orientation o.
inline const PetscInt *VertexArrangement(DMPolytopeType ct, PetscInt o) {
#if PETSC_VERSION_LT(3, 19, 0)
  return DMPolytopeTypeGetVertexArrangment(ct, o);
#else
  return DMPolytopeTypeGetVertexArrangement(ct, o);
#endif
}

/// Steps that -ts_run_steps (3.24) still allows from this step on.
#if PETSC_VERSION_LT(3, 24, 0)
#define CdemRunStepsLeft(ts) PETSC_INT_MAX
#else
#define CdemRunStepsLeft(ts) \
  ((ts)->run_steps == PETSC_INT_MAX ? PETSC_INT_MAX : (ts)->start_step + (ts)->run_steps - (ts)->steps)
#endif

}  // namespace cdem
