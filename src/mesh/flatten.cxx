// DMPlex -> flat arrays, without a closure per cell: the vertices of a face come from its edges, the corners of a cell
// from its faces 0 and 1 and their orientations.
#include "core/error.hpp"
#include "mesh/source.hpp"

#include <algorithm>
#include <numeric>

namespace cdem {

namespace {

// The order of PETSc's corners in gmsh's order.
constexpr int kFromPetsc[kShapes][kMaxCorners] = {{1, 0, 2, 3}, {0, 2, 1, 3, 4, 5}, {0, 3, 2, 1, 4, 5, 6, 7}};

struct Flattener {
  const MeshSource &source;
  const std::vector<PetscInt> &cell_point;  // [local cell] point
  DM dm;
  Mesh *mesh;

  PointRange cells, faces, vertices;    // of dm
  std::vector<PetscInt> point_vertex;   // [point - vertices.begin] local vertex, -1 without a cell
  std::vector<PetscInt> face_vertices;  // [point - faces.begin][4] point - vertices.begin
  std::vector<PetscInt> cell_face;      // [local cell][local face] point - faces.begin
  std::vector<PetscInt> face_index;     // [point - faces.begin] index into mesh->faces

  PetscErrorCode ReadFaceVertices();
  PetscErrorCode ReadCorners();
  PetscErrorCode ReadCoordinates();
  PetscErrorCode ListFaces();
  PetscErrorCode ReadLabels();
  PetscErrorCode Stratum(const char *label, PetscInt value, const PointRange &range,
                         std::vector<PetscInt> *found) const;
};

PetscErrorCode Flattener::ReadFaceVertices() {
  PetscFunctionBeginUser;
  face_vertices.assign(4 * static_cast<std::size_t>(faces.size()), -1);
  for (PetscInt f = faces.begin; f < faces.end; ++f) {
    PetscInt n;
    const PetscInt *edges, *turned, *ends;
    PetscCall(DMPlexGetConeSize(dm, f, &n));
    PetscCall(DMPlexGetCone(dm, f, &edges));
    PetscCall(DMPlexGetConeOrientation(dm, f, &turned));
    for (PetscInt e = 0; e < n && e < 4; ++e) {
      PetscCall(DMPlexGetCone(dm, edges[e], &ends));
      face_vertices[4 * (f - faces.begin) + e] = ends[turned[e] < 0] - vertices.begin;
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

// PETSc's faces 0 and 1 are bottom and top of a hexahedron or wedge with all of its corners in order; those of a
// tetrahedron have its corners 0 1 2 and 0 3 1.
PetscErrorCode Flattener::ReadCorners() {
  PetscFunctionBeginUser;
  mesh->cell_shape.resize(mesh->n_cells);
  mesh->cell_vertex.assign(kMaxCorners * static_cast<std::size_t>(mesh->n_cells), -1);
  cell_face.assign(kMaxFaces * static_cast<std::size_t>(mesh->n_cells), -1);
  point_vertex.assign(vertices.size(), -1);
  for (PetscInt c = 0; c < mesh->n_cells; ++c) {
    const PetscInt point = cell_point[c];
    const PetscInt *cone, *turned;
    DMPolytopeType type;
    PetscCall(DMPlexGetCellType(dm, point, &type));
    PetscCall(DMPlexGetCone(dm, point, &cone));
    PetscCall(DMPlexGetConeOrientation(dm, point, &turned));
    const Shape shape = type == DM_POLYTOPE_TETRAHEDRON ? Shape::kTet
                        : type == DM_POLYTOPE_TRI_PRISM ? Shape::kWedge
                                                        : Shape::kHex;
    CdemCheck(type == DM_POLYTOPE_HEXAHEDRON || shape != Shape::kHex, PETSC_COMM_SELF,
              "%s: a cell of type %s after refinement; only hexahedra, tetrahedra and wedges are possible",
              source.what.c_str(), DMPolytopeTypes[type]);
    const ShapeInfo &info = Info(shape);
    const int n = shape == Shape::kHex ? 4 : 3;
    const DMPolytopeType face_type = n == 4 ? DM_POLYTOPE_QUADRILATERAL : DM_POLYTOPE_TRIANGLE;
    PetscInt corner[kMaxCorners] = {};
    for (int side = 1; side >= 0; --side) {
      const PetscInt *order = VertexArrangement(face_type, turned[side]);
      const PetscInt *of_face = &face_vertices[4 * (cone[side] - faces.begin)];
      for (int k = 0; k < n; ++k) corner[n * side + k] = of_face[order[k]];
    }
    if (shape == Shape::kTet) corner[3] = corner[4];
    PetscInt *out = &mesh->cell_vertex[kMaxCorners * c];
    for (int k = 0; k < info.corners; ++k) out[k] = corner[kFromPetsc[static_cast<int>(shape)][k]];
    for (int k = 0; k < info.corners; ++k) point_vertex[out[k]] = 0;
    mesh->cell_shape[c] = shape;

    for (int m = 0; m < info.faces; ++m) {  // which of the cell's faces has these corners
      const PetscInt *of_face = &face_vertices[4 * (cone[m] - faces.begin)];
      unsigned corners_here = 0;
      for (int k = 0; k < 4 && of_face[k] >= 0; ++k) {
        for (int v = 0; v < info.corners; ++v) corners_here |= static_cast<unsigned>(out[v] == of_face[k]) << v;
      }
      for (int j = 0; j < info.faces; ++j) {
        unsigned wanted = 0;
        for (int k = 0; k < info.face_size[j]; ++k) wanted |= 1u << info.face[j][k];
        if (wanted == corners_here) cell_face[kMaxFaces * c + j] = cone[m] - faces.begin;
      }
    }
    for (int j = 0; j < info.faces; ++j) {
      PetscCheck(cell_face[kMaxFaces * c + j] >= 0, PETSC_COMM_SELF, PETSC_ERR_PLIB,
                 "Cell %" PetscInt_FMT ": its cone does not hold face %d", mesh->cell_global[c], j);
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode Flattener::ReadCoordinates() {
  PetscFunctionBeginUser;
  PetscSection section;
  Vec coordinates;
  const PetscScalar *x;
  PetscInt dim;
  PetscCall(DMGetCoordinateDim(dm, &dim));
  PetscCheck(dim == 3, mesh->comm, PETSC_ERR_PLIB, "Coordinates of dimension %" PetscInt_FMT, dim);
  PetscCall(DMGetCoordinateSection(dm, &section));
  PetscCall(DMGetCoordinatesLocal(dm, &coordinates));
  PetscCall(VecGetArrayRead(coordinates, &x));
  PetscInt n = 0;
  for (PetscInt &v : point_vertex) v = v < 0 ? -1 : n++;
  mesh->vertex_x.resize(3 * static_cast<std::size_t>(n));
  for (PetscInt p = 0; p < vertices.size(); ++p) {
    PetscInt offset;
    if (point_vertex[p] < 0) continue;
    PetscCall(PetscSectionGetOffset(section, p + vertices.begin, &offset));
    for (int d = 0; d < 3; ++d) mesh->vertex_x[3 * point_vertex[p] + d] = PetscRealPart(x[offset + d]);
  }
  PetscCall(VecRestoreArrayRead(coordinates, &x));
  for (PetscInt &v : mesh->cell_vertex) v = v < 0 ? -1 : point_vertex[v];
  PetscFunctionReturn(PETSC_SUCCESS);
}

// Cells in ascending global number: the first to show a face is its cell[0], and faces come in (cell, local) order.
PetscErrorCode Flattener::ListFaces() {
  PetscFunctionBeginUser;
  face_index.assign(faces.size(), -1);
  mesh->faces.reserve(faces.size());
  std::vector<PetscInt> order(mesh->n_cells);
  std::iota(order.begin(), order.end(), 0);
  std::inplace_merge(order.begin(), order.begin() + mesh->n_owned, order.end(),
                     [&](PetscInt a, PetscInt b) { return mesh->cell_global[a] < mesh->cell_global[b]; });
  for (PetscInt c : order) {
    for (int j = 0; j < Info(mesh->cell_shape[c]).faces; ++j) {
      PetscInt &index = face_index[cell_face[kMaxFaces * c + j]];
      if (index < 0) {
        index = static_cast<PetscInt>(mesh->faces.size());
        mesh->faces.push_back({{c, -1}, {static_cast<std::int8_t>(j), -1}});
      } else {
        Face &face = mesh->faces[index];
        PetscCheck(face.cell[1] < 0, PETSC_COMM_SELF, PETSC_ERR_PLIB, "A face with three cells");
        face.cell[1] = c;
        face.local[1] = static_cast<std::int8_t>(j);
      }
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

// Points of range that carry the label's value or, as format 4.1 writes the group of a part turned over, its negative;
// less range.begin. A point may carry several values.
PetscErrorCode Flattener::Stratum(const char *label, PetscInt value, const PointRange &range,
                                  std::vector<PetscInt> *found) const {
  PetscFunctionBeginUser;
  PetscBool there;
  found->clear();
  PetscCall(DMHasLabel(dm, label, &there));
  if (!there) PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt signed_value : {value, -value}) {
    IS stratum = nullptr;
    PetscCall(DMGetStratumIS(dm, label, signed_value, &stratum));
    if (!stratum) continue;
    PetscInt n;
    const PetscInt *list;
    PetscCall(ISGetLocalSize(stratum, &n));
    PetscCall(ISGetIndices(stratum, &list));
    for (PetscInt i = 0; i < n; ++i) {
      if (range.Has(list[i])) found->push_back(list[i] - range.begin);
    }
    PetscCall(ISRestoreIndices(stratum, &list));
    PetscCall(ISDestroy(&stratum));
  }
  std::sort(found->begin(), found->end());
  found->erase(std::unique(found->begin(), found->end()), found->end());
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode Flattener::ReadLabels() {
  PetscFunctionBeginUser;
  std::vector<PetscInt> found;
  std::vector<PetscInt> point_cell(cells.size());
  for (PetscInt c = 0; c < mesh->n_cells; ++c) point_cell[cell_point[c] - cells.begin] = c;
  mesh->cell_region.assign(mesh->n_cells, -1);
  for (const Group &group : source.groups) {
    if (group.dim == 3) {
      const int region = static_cast<int>(mesh->regions.size());
      mesh->regions.push_back(group.name);
      if (group.tag == 0) std::fill(mesh->cell_region.begin(), mesh->cell_region.end(), region);
      PetscCall(Stratum("Cell Sets", group.tag, cells, &found));
      for (PetscInt p : found) mesh->cell_region[point_cell[p]] = region;
    } else if (group.dim == 2) {
      PetscCall(Stratum("Face Sets", group.tag, faces, &found));
      for (PetscInt &f : found) f = face_index[f];
      mesh->surfaces.push_back(group.name);
      mesh->surface_faces.push_back(found);
      std::sort(mesh->surface_faces.back().begin(), mesh->surface_faces.back().end());
    } else {
      PetscCall(Stratum(kPointLabel, static_cast<PetscInt>(mesh->point_sets.size()), vertices, &found));
      for (PetscInt &v : found) v = point_vertex[v];
      found.erase(std::remove(found.begin(), found.end(), -1), found.end());
      mesh->point_sets.push_back(group.name);
      mesh->set_vertices.push_back(found);
    }
  }
  for (PetscInt c = 0; c < mesh->n_cells; ++c) {
    PetscCheck(mesh->cell_region[c] >= 0, PETSC_COMM_SELF, PETSC_ERR_PLIB, "Cell %" PetscInt_FMT " has no region",
               mesh->cell_global[c]);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

}  // namespace

PetscErrorCode FlattenMesh(const MeshSource &source, DM dm, const std::vector<PetscInt> &cell_point, Mesh *mesh) {
  PetscFunctionBeginUser;
  Flattener flat{source, cell_point, dm, mesh, {}, {}, {}, {}, {}, {}, {}};
  PetscCall(DMPlexGetHeightStratum(dm, 0, &flat.cells.begin, &flat.cells.end));
  PetscCall(DMPlexGetHeightStratum(dm, 1, &flat.faces.begin, &flat.faces.end));
  PetscCall(DMPlexGetDepthStratum(dm, 0, &flat.vertices.begin, &flat.vertices.end));
  PetscCall(flat.ReadFaceVertices());
  PetscCall(flat.ReadCorners());
  PetscCall(flat.ReadCoordinates());
  PetscCall(flat.ListFaces());
  PetscCall(flat.ReadLabels());
  PetscFunctionReturn(PETSC_SUCCESS);
}

}  // namespace cdem
