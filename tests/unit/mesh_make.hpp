// Meshes for tests.
#pragma once
#include "core/options.hpp"
#include "mesh/geometry.hpp"
#include "mesh/mesh.hpp"

#include <algorithm>
#include <filesystem>
#include <string>

namespace cdem {

inline std::string MeshFolder() { return std::filesystem::path(__FILE__).parent_path().parent_path() / "meshes"; }

/// Makes a mesh from options as on a command line, which are gone again afterwards.
inline PetscErrorCode Make(MPI_Comm comm, const std::string &options, Mesh *mesh) {
  PetscFunctionBeginUser;
  PetscOptions database;
  PetscCall(PetscOptionsCreate(&database));
  PetscCall(PetscOptionsPush(database));
  PetscCall(PetscOptionsInsertString(database, options.c_str()));
  Options reader(comm);
  const PetscErrorCode code = CreateMesh(comm, reader, mesh);
  PetscCall(PetscOptionsPop());
  PetscCall(PetscOptionsDestroy(&database));
  PetscFunctionReturn(code);
}

/// Volume of the local cells of a region [m^3].
inline double Volume(const Mesh &mesh, int region) {
  double sum = 0, x[kMaxCorners][3], volumes[kMaxCorners];
  for (PetscInt c = 0; c < mesh.n_cells; ++c) {
    if (mesh.cell_region[c] != region) continue;
    for (int k = 0; k < Info(mesh.cell_shape[c]).corners; ++k) std::copy_n(mesh.X(mesh.Corners(c)[k]), 3, x[k]);
    sum += CornerVolumes(mesh.cell_shape[c], x, volumes);
  }
  return sum;
}

}  // namespace cdem
