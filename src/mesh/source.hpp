// What the parts of CreateMesh hand to each other: a serial DMPlex (everything on rank 0) and what its labels are called.
#pragma once
#include "core/petsc.hpp"
#include "mesh/mesh.hpp"

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace cdem {

/// A named part of the mesh. Labels of the DMPlex: "Cell Sets" (dim 3) and "Face Sets" (dim 2) hold tags, kPointLabel
/// (dim 0 and 1) holds the index among the point sets. A volume of tag 0 is every cell that no other volume claims.
struct Group {
  int dim, tag;
  std::string name;
};

inline constexpr char kPointLabel[] = "cdem point sets";

struct MeshSource {
  DM dm = nullptr;                              ///< interpolated, all of it on rank 0
  std::string what;                             ///< for messages: "mesh box" or "mesh 'file.msh'"
  std::string hint;                             ///< what to do about a bad element
  std::vector<Group> groups;                    ///< sorted by dimension (3 first) and tag, the same on all ranks
  std::vector<std::int64_t> cell_number;        ///< rank 0: numbers of the cells in the file; empty when there are none
  std::map<int, std::int64_t> surface_corners;  ///< rank 0: as in GmshScan
  std::vector<std::string> remarks;             ///< the same on all ranks
};

/// The box that the -mesh_box options describe: cells numbered along x, then y, then z.
PetscErrorCode CreateBox(MPI_Comm comm, Options &options, MeshSource *source);

/// Reads a gmsh file with PETSc's reader, after a look of our own for everything that it accepts or chokes on.
PetscErrorCode ReadGmsh(MPI_Comm comm, const std::string &path, MeshSource *source);

struct PointRange {
  PetscInt begin = 0, end = 0;
  PetscInt size() const { return end - begin; }
  bool Has(PetscInt point) const { return point >= begin && point < end; }
};

/// Lists the cells of dm, own ones first and both parts in ascending global number (their place in serial), and fills
/// that part of mesh. migration: from the points of serial to those of dm, NULL on one rank.
PetscErrorCode NumberCells(DM serial, DM dm, PetscSF migration, Mesh *mesh, std::vector<PetscInt> *cell_point);

/// Copies everything else of dm into mesh, in the order of cell_point.
PetscErrorCode FlattenMesh(const MeshSource &source, DM dm, const std::vector<PetscInt> &cell_point, Mesh *mesh);

/// Errors: a cell type that is not ours, more than two cells on a face, cells that are there twice. Adds a remark on
/// nodes that lie on each other. For meshes from files, before refinement and distribution.
PetscErrorCode CheckTopology(MeshSource *source);

/// Error when a cell is inverted or degenerate, or a coordinate is not finite.
PetscErrorCode CheckGeometry(const MeshSource &source, const Mesh &mesh);

/// "(x, y, z)" for messages.
std::string PlaceText(const double x[3]);

/// Makes text that of rank 0 on all ranks.
PetscErrorCode BroadcastText(MPI_Comm comm, std::string *text);

}  // namespace cdem
