// Which cells a rank has, their numbers, their owners, and the star forest that shares what the owner knows of a cell.
#include "mesh/source.hpp"

#include <algorithm>
#include <numeric>

namespace cdem {

// Makes mesh->cell_sf: overlap cell -> local cell of its owner.
static PetscErrorCode ShareCells(PetscSF point_sf, const std::vector<PetscInt> &cell_point, PetscInt n_points,
                                 Mesh *mesh) {
  PetscFunctionBeginUser;
  std::vector<PetscInt> index(n_points, -1);  // [point] local cell on the owner
  for (PetscInt c = 0; c < mesh->n_owned; ++c) index[cell_point[c]] = c;
  PetscCall(PetscSFBcastBegin(point_sf, MPIU_INT, index.data(), index.data(), MPI_REPLACE));
  PetscCall(PetscSFBcastEnd(point_sf, MPIU_INT, index.data(), index.data(), MPI_REPLACE));
  const PetscInt n_overlap = mesh->n_cells - mesh->n_owned;
  std::vector<PetscInt> leaves(n_overlap);
  std::vector<PetscSFNode> roots(n_overlap);
  for (PetscInt i = 0; i < n_overlap; ++i) {
    leaves[i] = mesh->n_owned + i;
    roots[i].rank = mesh->cell_owner[leaves[i]];
    roots[i].index = index[cell_point[leaves[i]]];
  }
  PetscCall(PetscSFCreate(mesh->comm, &mesh->cell_sf));
  PetscCall(PetscSFSetGraph(mesh->cell_sf, mesh->n_owned, n_overlap, leaves.data(), PETSC_COPY_VALUES, roots.data(),
                            PETSC_COPY_VALUES));
  PetscCall(PetscSFSetUp(mesh->cell_sf));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode NumberCells(DM serial, DM dm, PetscSF migration, Mesh *mesh, std::vector<PetscInt> *cell_point) {
  PetscFunctionBeginUser;
  PointRange points, cells, serial_points, serial_cells;
  PetscCall(DMPlexGetChart(dm, &points.begin, &points.end));
  PetscCall(DMPlexGetHeightStratum(dm, 0, &cells.begin, &cells.end));
  PetscCall(DMPlexGetChart(serial, &serial_points.begin, &serial_points.end));
  PetscCall(DMPlexGetHeightStratum(serial, 0, &serial_cells.begin, &serial_cells.end));
  mesh->n_global = serial_cells.size();
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &mesh->n_global, 1, MPIU_INT, MPI_SUM, mesh->comm));

  std::vector<PetscInt> number(points.end);  // [point] of a cell: its place in the serial mesh
  std::iota(number.begin(), number.end(), -cells.begin);
  if (migration) {
    std::vector<PetscInt> root(serial_points.end);
    std::iota(root.begin(), root.end(), -serial_cells.begin);
    PetscCall(PetscSFBcastBegin(migration, MPIU_INT, root.data(), number.data(), MPI_REPLACE));
    PetscCall(PetscSFBcastEnd(migration, MPIU_INT, root.data(), number.data(), MPI_REPLACE));
  }

  int rank;
  PetscCallMPI(MPI_Comm_rank(mesh->comm, &rank));
  PetscSF point_sf = nullptr;
  PetscInt n_leaves = 0;
  const PetscInt *leaves = nullptr;
  const PetscSFNode *roots = nullptr;
  if (migration) {
    PetscCall(DMGetPointSF(dm, &point_sf));
    PetscCall(PetscSFGetGraph(point_sf, nullptr, &n_leaves, &leaves, &roots));
  }
  std::vector<int> owner(points.end, rank);  // [point]
  for (PetscInt l = 0; l < n_leaves; ++l) owner[leaves ? leaves[l] : l] = static_cast<int>(roots[l].rank);

  cell_point->resize(cells.size());
  std::iota(cell_point->begin(), cell_point->end(), cells.begin);
  std::sort(cell_point->begin(), cell_point->end(), [&](PetscInt a, PetscInt b) {
    const bool other_a = owner[a] != rank, other_b = owner[b] != rank;
    return other_a != other_b ? other_b : number[a] < number[b];
  });
  mesh->n_cells = cells.size();
  mesh->n_owned = 0;
  for (PetscInt point : *cell_point) {
    mesh->cell_global.push_back(number[point]);
    mesh->cell_owner.push_back(owner[point]);
    if (owner[point] == rank) ++mesh->n_owned;
  }
  if (migration) PetscCall(ShareCells(point_sf, *cell_point, points.end, mesh));
  PetscFunctionReturn(PETSC_SUCCESS);
}

}  // namespace cdem
