#include "mesh/mesh.hpp"

#include "core/error.hpp"
#include "core/options.hpp"
#include "core/petsc_refusal.hpp"
#include "mesh/source.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace cdem {

Mesh::~Mesh() {
  PetscBool finalized = PETSC_FALSE;
  if (PetscFinalized(&finalized) || finalized) return;
  (void)PetscSFDestroy(&cell_sf);
  (void)DMDestroy(&dm);
}

int Mesh::Find(const std::vector<std::string> &list, const std::string &name) {
  for (std::size_t i = 0; i < list.size(); ++i) {
    if (list[i] == name) return static_cast<int>(i);
  }
  return -1;
}

int CellCorners(const Mesh &mesh, PetscInt cell, double (*x)[3]) {
  const int corners = Info(mesh.cell_shape[cell]).corners;
  for (int a = 0; a < corners; ++a) std::copy_n(mesh.X(mesh.Corners(cell)[a]), 3, x[a]);
  return corners;
}

int FaceCorners(const Mesh &mesh, const Face &face, double (*x)[3]) {
  const ShapeInfo &info = Info(mesh.cell_shape[face.cell[0]]);
  const int size = info.face_size[face.local[0]], *corner = info.face[face.local[0]];
  for (int j = 0; j < size; ++j) std::copy_n(mesh.X(mesh.Corners(face.cell[0])[corner[j]]), 3, x[j]);
  return size;
}

void CellCentre(const Mesh &mesh, PetscInt cell, double centre[3]) {
  double x[kMaxCorners][3];
  const int corners = CellCorners(mesh, cell, x);
  for (int k = 0; k < 3; ++k) {
    centre[k] = 0;
    for (int a = 0; a < corners; ++a) centre[k] += x[a][k];
    centre[k] /= corners;
  }
}

std::string PlaceText(const double x[3]) {
  char text[100];
  std::snprintf(text, sizeof text, "(%g, %g, %g)", x[0], x[1], x[2]);
  return text;
}

PetscErrorCode BroadcastText(MPI_Comm comm, std::string *text) {
  PetscFunctionBeginUser;
  unsigned long size = text->size();
  PetscCallMPI(MPI_Bcast(&size, 1, MPI_UNSIGNED_LONG, 0, comm));
  text->resize(size);
  PetscCallMPI(MPI_Bcast(text->data(), static_cast<int>(size), MPI_CHAR, 0, comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

// -dm_refine, which PETSc reads: so many times that the cells still have numbers.
static PetscErrorCode CheckRefinement(MPI_Comm comm, PetscInt cells) {
  PetscFunctionBeginUser;
  char text[64] = "";
  PetscBool given;
  double times = 0, all = static_cast<double>(cells);
  PetscCall(PetscOptionsGetString(nullptr, nullptr, "-dm_refine", text, sizeof text, &given));
  if (!given) PetscFunctionReturn(PETSC_SUCCESS);
  CdemCheck(ParseReal(text, &times) && times >= 0 && times == std::floor(times), comm,
            "-dm_refine is '%s'; give a whole number, how often the mesh is refined (each time 8 cells of one)", text);
  PetscCallMPI(MPI_Bcast(&all, 1, MPI_DOUBLE, 0, comm));  // the serial mesh has its cells on rank 0
  all *= std::pow(8, times);
  CdemCheck(24 * all < static_cast<double>(PETSC_INT_MAX), comm,
            "-dm_refine %s makes %.3g cells, too many for a PETSc with %d-bit integers", text, all,
            static_cast<int>(8 * sizeof(PetscInt)));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode CheckPartitioner(MPI_Comm comm) {
  PetscFunctionBeginUser;
  char type[64] = "";
  PetscBool given;
  void (*found)(void) = nullptr;
  PetscCall(PetscOptionsGetString(nullptr, nullptr, "-petscpartitioner_type", type, sizeof type, &given));
  if (given) PetscCall(PetscFunctionListFind(PetscPartitionerList, type, &found));
  CdemCheck(!given || found, comm, "-petscpartitioner_type: this PETSc has no partitioner '%s'; try simple", type);
  PetscFunctionReturn(PETSC_SUCCESS);
}

// PETSc's own options for meshes (-dm_refine, -dm_plex_scale, ...) act on the serial mesh: numbers must not depend on ranks.
static PetscErrorCode ApplyPetscOptions(MeshSource *source) {
  PetscFunctionBeginUser;
  PetscInt cells[2];
  MPI_Comm comm = PetscObjectComm(reinterpret_cast<PetscObject>(source->dm));
  PetscCall(DMPlexGetHeightStratum(source->dm, 0, &cells[0], &cells[1]));
  const PetscInt before = cells[1] - cells[0];
  PetscCall(CheckRefinement(comm, before));
  PetscCall(CheckPartitioner(comm));
  PetscCall(DMPlexDistributeSetDefault(source->dm, PETSC_FALSE));
  PetscCall(SetFromOptions(
      comm, "meshes", [](void *dm) { return DMSetFromOptions(static_cast<DM>(dm)); }, source->dm));

  PetscBool distributed, reordered;
  PetscCall(DMPlexIsDistributed(source->dm, &distributed));
  CdemCheck(!distributed, comm, "-dm_distribute: cdem distributes the mesh itself; take the option away");
  PetscCall(PetscOptionsHasName(nullptr, nullptr, "-dm_plex_reorder", &reordered));
  PetscCall(DMPlexGetHeightStratum(source->dm, 0, &cells[0], &cells[1]));
  if (cells[1] - cells[0] != before || reordered) source->cell_number.clear();
  PetscFunctionReturn(PETSC_SUCCESS);
}

// With one layer of overlap every rank sees the whole star of the vertices of its own cells.
static PetscErrorCode Distribute(DM serial, PetscSF *migration, DM *dm) {
  PetscFunctionBeginUser;
  PetscPartitioner partitioner;
  PetscCall(DMSetBasicAdjacency(serial, PETSC_FALSE, PETSC_TRUE));
  PetscCall(DMPlexGetPartitioner(serial, &partitioner));
  PetscCall(PetscPartitionerSetFromOptions(partitioner));
  PetscCall(DMPlexDistribute(serial, 1, migration, dm));
  if (!*dm) {  // one rank
    *dm = serial;
    PetscCall(PetscObjectReference(reinterpret_cast<PetscObject>(serial)));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CreateMesh(MPI_Comm comm, Options &options, Mesh *mesh) {
  PetscFunctionBeginUser;
  MeshSource source;
  std::string file;
  bool given = false;
  PetscCall(options.Text("mesh", &file, &given));
  CdemCheck(given, comm, "no mesh: give -mesh FILE.msh (gmsh, format 2.2 or 4.1) or -mesh box");
  if (file == "box") {
    PetscCall(CreateBox(comm, options, &source));
  } else {
    PetscCall(ReadGmsh(comm, file, &source));
    PetscCall(CheckTopology(&source));
  }
  PetscCall(ApplyPetscOptions(&source));

  PetscSF migration = nullptr;
  mesh->comm = comm;
  PetscCall(Distribute(source.dm, &migration, &mesh->dm));
  std::vector<PetscInt> cell_point;
  PetscCall(NumberCells(source.dm, mesh->dm, migration, mesh, &cell_point));
  PetscCall(PetscSFDestroy(&migration));
  PetscCall(DMDestroy(&source.dm));
  PetscCall(FlattenMesh(source, mesh->dm, cell_point, mesh));
  PetscCall(CheckGeometry(source, *mesh));
  mesh->remarks = source.remarks;
  PetscCall(PetscObjectSetName(reinterpret_cast<PetscObject>(mesh->dm), "mesh"));
  PetscCall(DMViewFromOptions(mesh->dm, nullptr, "-dm_view"));
  PetscFunctionReturn(PETSC_SUCCESS);
}

}  // namespace cdem
