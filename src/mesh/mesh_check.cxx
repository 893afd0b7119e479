#include "core/error.hpp"
#include "mesh/source.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace cdem {

namespace {

// "element 17", as the file numbers it if it does.
std::string CellName(const MeshSource &source, PetscInt cell) {
  const auto i = static_cast<std::size_t>(cell);
  if (i < source.cell_number.size()) return "element " + std::to_string(source.cell_number[i]);
  return "element " + std::to_string(cell) + " (counted from 0)";
}

PetscErrorCode Centroid(DM dm, PetscInt cell, std::string *text) {
  PetscFunctionBeginUser;
  PetscInt vertices[2], n, *closure = nullptr, corners = 0;
  PetscSection section;
  Vec coordinates;
  const PetscScalar *x;
  double sum[3] = {0, 0, 0};
  PetscCall(DMPlexGetDepthStratum(dm, 0, &vertices[0], &vertices[1]));
  PetscCall(DMGetCoordinateSection(dm, &section));
  PetscCall(DMGetCoordinatesLocal(dm, &coordinates));
  PetscCall(VecGetArrayRead(coordinates, &x));
  PetscCall(DMPlexGetTransitiveClosure(dm, cell, PETSC_TRUE, &n, &closure));
  for (PetscInt i = 0; i < n; ++i) {
    PetscInt offset;
    if (closure[2 * i] < vertices[0] || closure[2 * i] >= vertices[1]) continue;
    PetscCall(PetscSectionGetOffset(section, closure[2 * i], &offset));
    for (int d = 0; d < 3; ++d) sum[d] += PetscRealPart(x[offset + d]);
    ++corners;
  }
  PetscCall(DMPlexRestoreTransitiveClosure(dm, cell, PETSC_TRUE, &n, &closure));
  PetscCall(VecRestoreArrayRead(coordinates, &x));
  for (double &s : sum) s /= corners;
  *text = PlaceText(sum);
  PetscFunctionReturn(PETSC_SUCCESS);
}

// Nodes at the same place (within 1e-9 of the mesh's size), besides the first of each.
PetscErrorCode CountCoincident(DM dm, PetscInt *count) {
  PetscFunctionBeginUser;
  Vec coordinates;
  PetscInt n;
  const PetscScalar *x;
  PetscCall(DMGetCoordinatesLocal(dm, &coordinates));
  PetscCall(VecGetLocalSize(coordinates, &n));
  PetscCall(VecGetArrayRead(coordinates, &x));
  double size = 0;
  for (PetscInt i = 3; i < n; ++i) size = std::max(size, std::abs(PetscRealPart(x[i] - x[i % 3])));
  const double unit = std::exp2(std::floor(std::log2(1e-9 * size)));  // nice numbers stay off its halves
  std::vector<std::array<std::int64_t, 3>> places(n / 3);
  for (PetscInt i = 0; i < n; ++i) places[i / 3][i % 3] = std::llround(PetscRealPart(x[i]) / unit);
  std::sort(places.begin(), places.end());
  const auto different = std::unique(places.begin(), places.end());
  *count = static_cast<PetscInt>(places.end() - different);
  PetscCall(VecRestoreArrayRead(coordinates, &x));
  PetscFunctionReturn(PETSC_SUCCESS);
}

// On rank 0: what is wrong with the way cells hang together, empty if nothing.
PetscErrorCode FindTopologyError(const MeshSource &source, std::string *error) {
  PetscFunctionBeginUser;
  DM dm = source.dm;
  PetscInt cells[2], faces[2], crowded = 0, doubled = 0;
  std::string first_doubled, first_crowded;
  PetscCall(DMPlexGetHeightStratum(dm, 0, &cells[0], &cells[1]));
  PetscCall(DMPlexGetHeightStratum(dm, 1, &faces[0], &faces[1]));
  for (PetscInt f = faces[0]; f < faces[1]; ++f) {
    PetscInt n, size[2];
    const PetscInt *support, *cone[2];
    PetscCall(DMPlexGetSupportSize(dm, f, &n));
    if (n < 2) continue;
    PetscCall(DMPlexGetSupport(dm, f, &support));
    for (int i = 0; i < 2; ++i) PetscCall(DMPlexGetConeSize(dm, support[i], &size[i]));
    for (int i = 0; i < 2; ++i) PetscCall(DMPlexGetCone(dm, support[i], &cone[i]));
    const bool same = size[0] == size[1] && std::is_permutation(cone[0], cone[0] + size[0], cone[1]);
    if (n == 2 && !same) continue;
    std::string &first = same ? first_doubled : first_crowded;
    ++(same ? doubled : crowded);
    if (!first.empty()) continue;
    std::string place;
    PetscCall(Centroid(dm, support[0], &place));
    for (PetscInt i = 0; i < n; ++i) {
      first += (i == 0 ? "" : i + 1 < n ? ", " : " and ") + CellName(source, support[i] - cells[0]);
    }
    first += ", at " + place;
  }
  if (doubled > 0) {
    *error = "elements are there twice: " + first_doubled +
             " (format 2.2 writes an element of two physical groups twice: "
             "an element needs exactly one group; otherwise remove the duplicates)";
  } else if (crowded > 0) {
    *error = "more than two elements meet at a face (" + std::to_string(crowded) + " times): " + first_crowded +
             " (overlapping volumes: make the geometry conforming, e.g. with BooleanFragments)";
  }
  if (!error->empty()) PetscFunctionReturn(PETSC_SUCCESS);
  for (const Group &group : source.groups) {
    if (group.dim != 2) continue;
    PetscInt outside = 0;
    std::int64_t corners = 0;
    for (int tag : {group.tag, -group.tag}) {
      IS stratum = nullptr;
      PetscInt n = 0;
      const PetscInt *list;
      PetscCall(DMGetStratumIS(dm, "Face Sets", tag, &stratum));
      if (!stratum) continue;
      PetscCall(ISGetLocalSize(stratum, &n));
      PetscCall(ISGetIndices(stratum, &list));
      for (PetscInt i = 0; i < n; ++i) {
        PetscInt size;
        PetscCall(DMPlexGetConeSize(dm, list[i], &size));
        outside += list[i] < faces[0] || list[i] >= faces[1];
        corners += size;
      }
      PetscCall(ISRestoreIndices(stratum, &list));
      PetscCall(ISDestroy(&stratum));
    }
    // PETSc takes any point above all corners of a surface element: for half a quadrilateral the whole one
    const auto wanted = source.surface_corners.find(group.tag);
    if (outside == 0 && wanted != source.surface_corners.end() && wanted->second == corners) continue;
    *error = (outside > 0 ? std::to_string(outside) : "some") + " elements of surface '" + group.name +
             "' are no faces of volume elements: mesh "
             "volumes and surfaces together";
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

}  // namespace

PetscErrorCode CheckTopology(MeshSource *source) {
  PetscFunctionBeginUser;
  MPI_Comm comm = PetscObjectComm(reinterpret_cast<PetscObject>(source->dm));
  int rank;
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  std::string error;
  PetscInt coincident = 0, dim;
  PetscCall(DMGetDimension(source->dm, &dim));
  CdemCheck(dim == 3, comm, "%s has dimension %" PetscInt_FMT ": a mesh of volumes is needed", source->what.c_str(),
            dim);
  if (rank == 0) {
    PetscCall(FindTopologyError(*source, &error));
    PetscCall(CountCoincident(source->dm, &coincident));
  }
  PetscCall(BroadcastText(comm, &error));
  CdemCheck(error.empty(), comm, "%s: %s", source->what.c_str(), error.c_str());
  PetscCallMPI(MPI_Bcast(&coincident, 1, MPIU_INT, 0, comm));
  if (coincident > 0) {
    source->remarks.push_back(
        source->what + ": " + std::to_string(coincident) +
        " nodes lie on other nodes and are not merged: the mesh is open there (gmsh: Coherence Mesh)");
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

}  // namespace cdem
