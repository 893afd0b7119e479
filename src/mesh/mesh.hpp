// The mesh: a conforming DMPlex read from gmsh or made as a box, distributed with overlap 1, and copied once into flat
// host arrays, on which everything after it works.
#pragma once
#include "core/petsc.hpp"
#include "mesh/shapes.hpp"

#include <array>
#include <string>
#include <vector>

namespace cdem {

class Options;

/// A face of the mesh between cell[0] (the one of lower global number) and cell[1] (-1 on the outer boundary, and on the
/// rim of the overlap where no vertex belongs to an own cell).
struct Face {
  PetscInt cell[2];      ///< local cells
  std::int8_t local[2];  ///< number of the face in kShapeInfo of that cell
};

/// Host arrays of one rank: its own cells first, in ascending global number, then one layer of overlap.
struct Mesh {
  MPI_Comm comm = MPI_COMM_NULL;
  DM dm = nullptr;
  PetscSF cell_sf = nullptr;  ///< roots: local cell index on the owner; leaves: all overlap cells. NULL on one rank
  PetscInt n_owned = 0, n_cells = 0, n_global = 0;

  std::vector<PetscInt> cell_global;  ///< [n_cells] number in the file, whatever the partition
  std::vector<int> cell_owner;        ///< [n_cells] rank
  std::vector<Shape> cell_shape;      ///< [n_cells]
  std::vector<int> cell_region;       ///< [n_cells] index into regions
  std::vector<PetscInt> cell_vertex;  ///< [n_cells][8] local vertices in gmsh's corner order, -1 where there is none
  std::vector<double> vertex_x;       ///< [n_vertices][3] m
  std::vector<Face> faces;            ///< every face of a local cell, once, by (global number of cell[0], local[0])

  std::vector<std::string> regions;                  ///< names of the volumes, the same on all ranks
  std::vector<std::string> surfaces;                 ///< names of the surfaces, the same on all ranks
  std::vector<std::vector<PetscInt>> surface_faces;  ///< per surface: indices into faces
  std::vector<std::string> point_sets;               ///< names of lines and points
  std::vector<std::vector<PetscInt>> set_vertices;   ///< per line or point set: local vertices

  std::vector<std::string> remarks;  ///< things to say in the header (orphan nodes ignored, and the like)

  ~Mesh();
  /// Index of name in list, -1 if absent.
  static int Find(const std::vector<std::string> &list, const std::string &name);
  const PetscInt *Corners(PetscInt cell) const { return &cell_vertex[kMaxCorners * cell]; }
  const double *X(PetscInt vertex) const { return &vertex_x[3 * vertex]; }
};

/// Corner coordinates [m] of a cell, and of a face in the order of cell[0]; the number of corners.
int CellCorners(const Mesh &mesh, PetscInt cell, double (*x)[3]);
int FaceCorners(const Mesh &mesh, const Face &face, double (*x)[3]);
/// Mean of the corners of a cell [m].
void CellCentre(const Mesh &mesh, PetscInt cell, double centre[3]);

/// Reads or makes the mesh that the options ask for, checks it and distributes it (collective).
/// Errors: everything a mesh can have wrong, with its place and number in the file.
PetscErrorCode CreateMesh(MPI_Comm comm, Options &options, Mesh *mesh);

}  // namespace cdem
