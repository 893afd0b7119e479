// A box of hexahedra, wedges (two a cell) or tetrahedra (six a cell). Vertices and cells count along x, then y, then z.
#include "core/error.hpp"
#include "core/options.hpp"
#include "core/random.hpp"
#include "mesh/source.hpp"

#include <Random123/philox.h>

namespace cdem {

namespace {

struct Box {
  PetscInt cells[3] = {0, 0, 0};
  double size[3] = {0, 0, 0}, origin[3] = {0, 0, 0};
  double jitter = 0;
  PetscInt seed = 1;
  std::string shape = "hex";

  PetscInt Vertex(PetscInt i, PetscInt j, PetscInt k) const { return i + (cells[0] + 1) * (j + (cells[1] + 1) * k); }
  PetscInt Cells() const { return cells[0] * cells[1] * cells[2]; }
  PetscInt Vertices() const { return (cells[0] + 1) * (cells[1] + 1) * (cells[2] + 1); }
  void Position(PetscInt vertex, PetscInt at[3]) const {
    at[0] = vertex % (cells[0] + 1);
    at[1] = vertex / (cells[0] + 1) % (cells[1] + 1);
    at[2] = vertex / (cells[0] + 1) / (cells[1] + 1);
  }
};

// Corners of the parts of a cell in PETSc's order; bit d of a number is the offset along axis d.
constexpr int kWedges[2][6] = {{0, 3, 1, 4, 5, 7}, {0, 2, 3, 4, 7, 6}};
constexpr int kTets[6][4] = {{1, 0, 3, 7}, {3, 0, 2, 7}, {2, 0, 6, 7}, {6, 0, 4, 7}, {4, 0, 5, 7}, {5, 0, 1, 7}};

PetscErrorCode ReadOptions(MPI_Comm comm, Options &options, Box *box) {
  PetscFunctionBeginUser;
  bool given[2];
  PetscCall(options.Ints("mesh_box_cells", 3, box->cells, &given[0]));
  PetscCall(options.Reals("mesh_box_size", 3, box->size, &given[1]));
  CdemCheck(given[0] && given[1], comm, "-mesh box needs -mesh_box_cells nx,ny,nz and -mesh_box_size lx,ly,lz (m)");
  PetscCall(options.Reals("mesh_box_origin", 3, box->origin));
  PetscCall(options.Word("mesh_box_shape", &box->shape));
  PetscCall(options.Real("mesh_box_jitter", &box->jitter));
  PetscCall(options.Int("seed", &box->seed));
  double total = 1;
  for (int d = 0; d < 3; ++d) {
    CdemCheck(box->cells[d] > 0, comm, "-mesh_box_cells: %" PetscInt_FMT " cells along %c; at least 1 is needed",
              box->cells[d], 'x' + d);
    CdemCheck(box->size[d] > 0, comm, "-mesh_box_size: %g m along %c; it must be > 0", box->size[d], 'x' + d);
    total *= static_cast<double>(box->cells[d]) + 1;
  }
  CdemCheck(box->shape == "hex" || box->shape == "tet" || box->shape == "wedge", comm,
            "-mesh_box_shape %s: hex, tet or wedge is possible", box->shape.c_str());
  const double cones = box->shape == "hex" ? 24 : box->shape == "tet" ? 80 : 50;  // entries of DMPlex per cell
  CdemCheck(total * cones < static_cast<double>(PETSC_INT_MAX), comm,
            "-mesh_box_cells: %.3g cells are too many for a PETSc with %d-bit integers", total,
            static_cast<int>(8 * sizeof(PetscInt)));
  CdemCheck(box->jitter >= 0 && box->jitter < 0.5, comm,
            "-mesh_box_jitter %g: give a part of the cell size from 0 to below 0.5", box->jitter);
  PetscFunctionReturn(PETSC_SUCCESS);
}

// DMPlex has no box of tetrahedra without a mesh generator, and its wedges come in another order: corner lists then.
PetscErrorCode CreateFromCorners(MPI_Comm comm, const Box &box, DM *dm) {
  PetscFunctionBeginUser;
  int rank;
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  const bool tet = box.shape == "tet";
  const PetscInt corners = tet ? 4 : 6, parts = tet ? 6 : 2;
  const PetscInt n_cells = rank == 0 ? parts * box.Cells() : 0, n_vertices = rank == 0 ? box.Vertices() : 0;
  std::vector<PetscInt> list;
  list.reserve(static_cast<std::size_t>(n_cells) * corners);
  for (PetscInt c = 0; c < n_cells / parts; ++c) {
    const PetscInt i = c % box.cells[0], j = c / box.cells[0] % box.cells[1], k = c / box.cells[0] / box.cells[1];
    for (PetscInt p = 0; p < parts; ++p) {
      for (PetscInt v = 0; v < corners; ++v) {
        const int at = tet ? kTets[p][v] : kWedges[p][v];
        list.push_back(box.Vertex(i + (at & 1), j + (at >> 1 & 1), k + (at >> 2)));
      }
    }
  }

  DM plain;
  PetscCall(DMCreate(comm, &plain));
  PetscCall(DMSetType(plain, DMPLEX));
  PetscCall(DMSetDimension(plain, 3));
  PetscCall(DMPlexBuildFromCellList(plain, n_cells, n_vertices, corners, list.data()));
  PetscCall(DMCreateLabel(plain, "celltype"));  // PETSc would take six corners for a tensor prism
  for (PetscInt p = 0; p < n_cells + n_vertices; ++p) {
    const DMPolytopeType type = p >= n_cells ? DM_POLYTOPE_POINT
                                : tet        ? DM_POLYTOPE_TETRAHEDRON
                                             : DM_POLYTOPE_TRI_PRISM;
    PetscCall(DMPlexSetCellType(plain, p, type));
  }
  PetscCall(DMPlexInterpolate(plain, dm));
  PetscCall(DMDestroy(&plain));
  const std::vector<PetscReal> zero(3 * n_vertices);
  PetscCall(DMPlexBuildCoordinatesFromCellList(*dm, 3, zero.data()));
  PetscFunctionReturn(PETSC_SUCCESS);
}

// Sides are exactly at origin and origin + size; vertices inside move by up to jitter cell sizes along each axis, by
// random numbers that depend on the seed and the vertex alone.
PetscErrorCode PlaceVertices(const Box &box, DM dm) {
  PetscFunctionBeginUser;
  PetscInt first, last;
  Vec coordinates;
  PetscScalar *x;
  PetscCall(DMPlexGetDepthStratum(dm, 0, &first, &last));
  PetscCall(DMGetCoordinatesLocal(dm, &coordinates));
  PetscCall(VecGetArray(coordinates, &x));
  const r123::Philox4x64::key_type key = {{static_cast<std::uint64_t>(box.seed), 0}};
  for (PetscInt v = 0; v < last - first; ++v) {
    PetscInt at[3];
    box.Position(v, at);
    bool inside = box.jitter > 0;
    for (int d = 0; d < 3; ++d) inside = inside && at[d] > 0 && at[d] < box.cells[d];
    r123::Philox4x64::ctr_type bits = {{static_cast<std::uint64_t>(v), 0, 0, 0}};
    if (inside) bits = r123::Philox4x64()(bits, key);
    for (int d = 0; d < 3; ++d) {
      const double shift = inside ? box.jitter * (2 * (UnitReal(bits[d])) - 1) : 0;
      const double n = static_cast<double>(box.cells[d]);
      x[3 * v + d] = box.origin[d] + box.size[d] * ((static_cast<double>(at[d]) + shift) / n);
    }
  }
  PetscCall(VecRestoreArray(coordinates, &x));
  PetscCall(DMSetCoordinatesLocal(dm, coordinates));  // drops a global copy, if there is one
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode LabelSides(const Box &box, DM dm) {
  PetscFunctionBeginUser;
  PetscInt faces[2], vertices[2];
  for (const char *name : {"Face Sets", "marker"}) {  // DMPlex's own, if it made any
    PetscBool there;
    PetscCall(DMHasLabel(dm, name, &there));
    if (there) PetscCall(DMRemoveLabel(dm, name, nullptr));
  }
  PetscCall(DMCreateLabel(dm, "Face Sets"));
  DMLabel label;
  PetscCall(DMGetLabel(dm, "Face Sets", &label));
  PetscCall(DMPlexGetHeightStratum(dm, 1, &faces[0], &faces[1]));
  PetscCall(DMPlexGetDepthStratum(dm, 0, &vertices[0], &vertices[1]));
  for (PetscInt f = faces[0]; f < faces[1]; ++f) {
    PetscInt support, n, *closure = nullptr;
    PetscCall(DMPlexGetSupportSize(dm, f, &support));
    if (support != 1) continue;
    bool on[6] = {true, true, true, true, true, true};
    PetscCall(DMPlexGetTransitiveClosure(dm, f, PETSC_TRUE, &n, &closure));
    for (PetscInt i = 0; i < n; ++i) {
      if (closure[2 * i] < vertices[0] || closure[2 * i] >= vertices[1]) continue;
      PetscInt at[3];
      box.Position(closure[2 * i] - vertices[0], at);
      for (int d = 0; d < 3; ++d) {
        on[2 * d] = on[2 * d] && at[d] == 0;
        on[2 * d + 1] = on[2 * d + 1] && at[d] == box.cells[d];
      }
    }
    PetscCall(DMPlexRestoreTransitiveClosure(dm, f, PETSC_TRUE, &n, &closure));
    for (int side = 0; side < 6; ++side) {
      if (on[side]) PetscCall(DMLabelSetValue(label, f, side + 1));
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

}  // namespace

PetscErrorCode CreateBox(MPI_Comm comm, Options &options, MeshSource *source) {
  PetscFunctionBeginUser;
  Box box;
  PetscCall(ReadOptions(comm, options, &box));
  if (box.shape == "hex") {
    const PetscReal lower[3] = {0, 0, 0}, upper[3] = {1, 1, 1};
    PetscCall(CreateBoxMesh(comm, PETSC_FALSE, box.cells, lower, upper, &source->dm));
  } else {
    PetscCall(CreateFromCorners(comm, box, &source->dm));
  }
  PetscCall(PlaceVertices(box, source->dm));
  PetscCall(LabelSides(box, source->dm));
  source->what = "mesh box";
  source->hint = "lower -mesh_box_jitter";
  source->groups = {{3, 0, "box"}};
  const char *sides[6] = {"xmin", "xmax", "ymin", "ymax", "zmin", "zmax"};
  for (int side = 0; side < 6; ++side) source->groups.push_back({2, side + 1, sides[side]});
  PetscFunctionReturn(PETSC_SUCCESS);
}

}  // namespace cdem
