#include "mesh/split.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

namespace cdem {

Nodes::~Nodes() { (void)PetscSFDestroy(&halo); }

std::vector<PetscInt> SortedByGlobal(const Mesh &mesh) {
  std::vector<PetscInt> cells(mesh.n_cells);
  std::iota(cells.begin(), cells.end(), 0);
  std::sort(cells.begin(), cells.end(),
            [&](PetscInt a, PetscInt b) { return mesh.cell_global[a] < mesh.cell_global[b]; });
  return cells;
}

void FaceCornerPair(const Mesh &mesh, const Face &face, int j, int *corner0, int *corner1) {
  const ShapeInfo &info = Info(mesh.cell_shape[face.cell[0]]);
  *corner0 = info.face[face.local[0]][j];
  const PetscInt vertex = mesh.Corners(face.cell[0])[*corner0];
  const PetscInt *other = mesh.Corners(face.cell[1]);
  int c = 0;
  while (other[c] != vertex) ++c;  // both cells hold the face, so it is there
  *corner1 = c;
}

namespace {

/// Union-find over corners (8 cell + corner), the root being the corner of the smallest (global cell, corner).
class Fans {
 public:
  explicit Fans(const Mesh &mesh) : mesh_(mesh), parent_(kMaxCorners * mesh.n_cells) {
    std::iota(parent_.begin(), parent_.end(), 0);
  }
  PetscInt Find(PetscInt c) {
    while (parent_[c] != c) c = parent_[c] = parent_[parent_[c]];
    return c;
  }
  void Join(PetscInt a, PetscInt b) {
    a = Find(a), b = Find(b);
    if (a == b) return;
    if (Before(b, a)) std::swap(a, b);
    parent_[b] = a;
  }

 private:
  bool Before(PetscInt a, PetscInt b) const {
    PetscInt ga = mesh_.cell_global[a / kMaxCorners], gb = mesh_.cell_global[b / kMaxCorners];
    return ga != gb ? ga < gb : a % kMaxCorners < b % kMaxCorners;
  }
  const Mesh &mesh_;
  std::vector<PetscInt> parent_;
};

/// Where a node lives: the rank that owns it and its number there.
struct Home {
  PetscInt rank, index;
  bool operator<(const Home &o) const { return rank != o.rank ? rank < o.rank : index < o.index; }
  bool operator==(const Home &o) const { return rank == o.rank && index == o.index; }
};
static_assert(sizeof(Home) == 2 * sizeof(PetscInt), "Home travels as two PetscInt");

PetscErrorCode FillOverlap(const Mesh &mesh, std::vector<Home> &home) {
  PetscFunctionBeginUser;
  if (mesh.cell_sf) {
    MPI_Datatype unit;
    PetscCallMPI(MPI_Type_contiguous(2 * kMaxCorners, MPIU_INT, &unit));
    PetscCallMPI(MPI_Type_commit(&unit));
    std::vector<Home> roots(home.begin(), home.begin() + static_cast<std::ptrdiff_t>(kMaxCorners * mesh.n_owned));
    PetscCall(PetscSFBcastBegin(mesh.cell_sf, unit, roots.data(), home.data(), MPI_REPLACE));
    PetscCall(PetscSFBcastEnd(mesh.cell_sf, unit, roots.data(), home.data(), MPI_REPLACE));
    PetscCallMPI(MPI_Type_free(&unit));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/// Connected parts of the mesh: labels go from rank to rank until none changes.
PetscErrorCode CountBlocks(const Mesh &mesh, const std::vector<int> &face_interface, PetscInt *n_blocks) {
  PetscFunctionBeginUser;
  std::vector<PetscInt> label(mesh.cell_global), parent(mesh.n_cells);
  std::iota(parent.begin(), parent.end(), 0);
  auto find = [&](PetscInt c) {
    while (parent[c] != c) c = parent[c] = parent[parent[c]];
    return c;
  };
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    const Face &face = mesh.faces[f];
    if (face.cell[1] < 0 || face_interface[f] >= 0) continue;
    PetscInt a = find(face.cell[0]), b = find(face.cell[1]);
    if (a != b) parent[std::max(a, b)] = std::min(a, b);
  }
  for (int changed = 1; changed;) {
    changed = 0;
    for (PetscInt c = 0; c < mesh.n_cells; ++c) label[find(c)] = std::min(label[find(c)], label[c]);
    for (PetscInt c = 0; c < mesh.n_cells; ++c) {
      if (label[c] != label[find(c)]) changed = 1;
      label[c] = label[find(c)];
    }
    if (!mesh.cell_sf) break;
    std::vector<PetscInt> roots(label.begin(), label.begin() + mesh.n_owned);
    PetscCall(PetscSFBcastBegin(mesh.cell_sf, MPIU_INT, roots.data(), label.data(), MPI_REPLACE));
    PetscCall(PetscSFBcastEnd(mesh.cell_sf, MPIU_INT, roots.data(), label.data(), MPI_REPLACE));
    for (PetscInt c = 0; c < mesh.n_cells; ++c)
      if (label[c] != label[find(c)]) changed = 1;
    PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &changed, 1, MPI_INT, MPI_MAX, mesh.comm));
  }
  *n_blocks = 0;
  for (PetscInt c = 0; c < mesh.n_owned; ++c) *n_blocks += label[c] == mesh.cell_global[c];
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, n_blocks, 1, MPIU_INT, MPI_SUM, mesh.comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

}  // namespace

PetscErrorCode GlobalOffsets(const Mesh &mesh, const std::vector<PetscInt> &count, std::vector<std::int64_t> *before,
                             std::int64_t *total) {
  PetscFunctionBeginUser;
  PetscLayout layout;
  PetscCall(PetscLayoutCreateFromSizes(mesh.comm, PETSC_DECIDE, mesh.n_global, 1, &layout));
  PetscInt n_rows;
  PetscCall(PetscLayoutGetLocalSize(layout, &n_rows));
  PetscSF sf;
  PetscCall(PetscSFCreate(mesh.comm, &sf));
  PetscCall(PetscSFSetGraphLayout(sf, layout, mesh.n_owned, nullptr, PETSC_OWN_POINTER, mesh.cell_global.data()));
  std::vector<std::int64_t> mine(count.begin(), count.end()), rows(n_rows, 0);
  PetscCall(PetscSFReduceBegin(sf, MPI_INT64_T, mine.data(), rows.data(), MPI_REPLACE));
  PetscCall(PetscSFReduceEnd(sf, MPI_INT64_T, mine.data(), rows.data(), MPI_REPLACE));
  std::int64_t sum = std::accumulate(rows.begin(), rows.end(), std::int64_t{0}), start = 0;
  PetscCallMPI(MPI_Exscan(&sum, &start, 1, MPI_INT64_T, MPI_SUM, mesh.comm));
  PetscCallMPI(MPI_Allreduce(&sum, total, 1, MPI_INT64_T, MPI_SUM, mesh.comm));
  for (std::int64_t &row : rows) start += std::exchange(row, start);
  before->assign(mesh.n_owned, 0);
  PetscCall(PetscSFBcastBegin(sf, MPI_INT64_T, rows.data(), before->data(), MPI_REPLACE));
  PetscCall(PetscSFBcastEnd(sf, MPI_INT64_T, rows.data(), before->data(), MPI_REPLACE));
  PetscCall(PetscSFDestroy(&sf));
  PetscCall(PetscLayoutDestroy(&layout));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CreateNodes(const Mesh &mesh, const std::vector<int> &face_interface, Nodes *nodes) {
  PetscFunctionBeginUser;
  PetscMPIInt rank;
  PetscCallMPI(MPI_Comm_rank(mesh.comm, &rank));
  Fans fans(mesh);
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    const Face &face = mesh.faces[f];
    if (face.cell[1] < 0 || face_interface[f] >= 0) continue;
    const int size = Info(mesh.cell_shape[face.cell[0]]).face_size[face.local[0]];
    for (int j = 0; j < size; ++j) {
      int c0, c1;
      FaceCornerPair(mesh, face, j, &c0, &c1);
      fans.Join(kMaxCorners * face.cell[0] + c0, kMaxCorners * face.cell[1] + c1);
    }
  }

  // The owner of a node is the owner of its lowest-numbered cell, which numbers it. One exchange tells the overlap the
  // numbers of the nodes that its cells begin; a second one the nodes of all their corners.
  std::vector<Home> home(kMaxCorners * mesh.n_cells, Home{-1, -1});
  std::vector<PetscInt> begun(mesh.n_owned, 0);
  for (PetscInt c = 0; c < mesh.n_owned; ++c)
    for (int i = 0; i < Info(mesh.cell_shape[c]).corners; ++i) {
      const PetscInt corner = kMaxCorners * c + i;
      if (fans.Find(corner) != corner) continue;
      home[corner] = Home{rank, nodes->n_owned++};
      nodes->vertex.push_back(mesh.Corners(c)[i]);
      ++begun[c];
    }
  PetscCall(FillOverlap(mesh, home));
  for (PetscInt c = 0; c < mesh.n_owned; ++c)
    for (int i = 0; i < Info(mesh.cell_shape[c]).corners; ++i)
      home[kMaxCorners * c + i] = home[fans.Find(kMaxCorners * c + i)];
  PetscCall(FillOverlap(mesh, home));

  // A corner is needed when its cell is owned or touches an owned node, when it faces an owned node across an interface,
  // or when it lies on an interface face that this rank reports.
  std::vector<char> needed(kMaxCorners * mesh.n_cells, 0);
  for (PetscInt c = 0; c < mesh.n_cells; ++c) {
    const Home *h = &home[kMaxCorners * c];
    const bool touches = std::any_of(h, h + kMaxCorners, [&](const Home &a) { return a.rank == rank; });
    if (touches || c < mesh.n_owned) std::fill_n(&needed[kMaxCorners * c], Info(mesh.cell_shape[c]).corners, char{1});
  }
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    const Face &face = mesh.faces[f];
    if (face.cell[1] < 0 || face_interface[f] < 0) continue;
    const int size = Info(mesh.cell_shape[face.cell[0]]).face_size[face.local[0]];
    for (int j = 0; j < size; ++j) {
      int c0, c1;
      FaceCornerPair(mesh, face, j, &c0, &c1);
      const PetscInt a = kMaxCorners * face.cell[0] + c0, b = kMaxCorners * face.cell[1] + c1;
      if (home[a].rank == rank || face.cell[0] < mesh.n_owned) needed[b] = 1;
      if (home[b].rank == rank) needed[a] = 1;
    }
  }

  std::vector<Home> ghosts;
  for (std::size_t i = 0; i < needed.size(); ++i)
    if (needed[i] && home[i].rank != rank) ghosts.push_back(home[i]);
  std::sort(ghosts.begin(), ghosts.end());
  ghosts.erase(std::unique(ghosts.begin(), ghosts.end()), ghosts.end());
  nodes->n_local = nodes->n_owned + static_cast<PetscInt>(ghosts.size());
  nodes->vertex.resize(nodes->n_local, -1);
  nodes->cell_node.assign(kMaxCorners * mesh.n_cells, -1);
  for (std::size_t i = 0; i < needed.size(); ++i) {
    if (!needed[i]) continue;
    PetscInt local = home[i].index;
    if (home[i].rank != rank) {
      local = nodes->n_owned + (std::lower_bound(ghosts.begin(), ghosts.end(), home[i]) - ghosts.begin());
      nodes->vertex[local] = mesh.cell_vertex[i];
    }
    nodes->cell_node[i] = local;
  }

  PetscMPIInt size;
  PetscCallMPI(MPI_Comm_size(mesh.comm, &size));
  if (size > 1) {
    PetscSFNode *remote;
    PetscCall(PetscMalloc1(ghosts.size(), &remote));
    for (std::size_t g = 0; g < ghosts.size(); ++g) remote[g] = PetscSFNode{ghosts[g].rank, ghosts[g].index};
    PetscCall(PetscSFCreate(mesh.comm, &nodes->halo));
    PetscCall(PetscSFSetFromOptions(nodes->halo));
    PetscCall(PetscSFSetGraph(nodes->halo, nodes->n_owned, static_cast<PetscInt>(ghosts.size()), nullptr,
                              PETSC_OWN_POINTER, remote, PETSC_OWN_POINTER));
    PetscCall(PetscSFSetUp(nodes->halo));
  }

  std::vector<std::int64_t> before;
  std::int64_t total;
  PetscCall(GlobalOffsets(mesh, begun, &before, &total));
  nodes->n_global = static_cast<PetscInt>(total);
  nodes->global.reserve(nodes->n_owned);
  for (PetscInt c = 0; c < mesh.n_owned; ++c)
    for (PetscInt i = 0; i < begun[c]; ++i) nodes->global.push_back(before[c] + i);
  PetscCall(CountBlocks(mesh, face_interface, &nodes->n_blocks));
  PetscFunctionReturn(PETSC_SUCCESS);
}

}  // namespace cdem
