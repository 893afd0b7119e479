// Blocks, interfaces and nodes: which corners of the elements share a node (a union-find across every face that is no
// interface), who owns it, and the halo. The DMPlex stays conforming; nodes are ours.
#pragma once
#include "mesh/mesh.hpp"

#include <cstdint>

namespace cdem {

/// The node table of one rank. Local nodes are [owned | ghost]; owned ones in (global cell, corner) order of their first
/// corner, which does not depend on the partition.
struct Nodes {
  PetscInt n_owned = 0, n_local = 0, n_global = 0;
  std::vector<PetscInt> cell_node;   ///< [n_cells][8] local node of a corner, -1 where this rank does not need it
  std::vector<PetscInt> vertex;      ///< [n_local] mesh vertex at which the node stands
  std::vector<std::int64_t> global;  ///< [n_owned] number over all ranks, in (global cell, corner) order
  PetscSF halo = nullptr;            ///< roots: owned nodes; leaves: ghosts, in order. NULL on one rank
  PetscInt n_blocks = 0;             ///< connected parts of the whole mesh

  ~Nodes();
  const PetscInt *Corners(PetscInt cell) const { return &cell_node[kMaxCorners * cell]; }
};

/// Builds the node table (collective).
/// [in] face_interface: per face of the mesh, the interface that claims it, or -1.
PetscErrorCode CreateNodes(const Mesh &mesh, const std::vector<int> &face_interface, Nodes *nodes);

/// Local cells, owned and overlap, in ascending global number.
std::vector<PetscInt> SortedByGlobal(const Mesh &mesh);

/// For corner j of a face as listed by cell[0]: the corner's number in cell[0] and in cell[1].
void FaceCornerPair(const Mesh &mesh, const Face &face, int j, int *corner0, int *corner1);

/// Numbers items that ranks hold in the order of a global key that counts per cell: gives the number of items before each
/// of this rank's owned cells (collective). [in] count: per owned cell.
PetscErrorCode GlobalOffsets(const Mesh &mesh, const std::vector<PetscInt> &count, std::vector<std::int64_t> *before,
                             std::int64_t *total);

}  // namespace cdem
