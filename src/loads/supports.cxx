#include "loads/supports.hpp"

#include "core/order_free_sum.hpp"
#include "core/options.hpp"

#include <algorithm>

namespace cdem {

namespace {

bool BecomesQuiet(const std::vector<Boundary> &before, const Boundary &b) {
  const auto same = std::find_if(before.begin(), before.end(), [&](const Boundary &o) { return o.name == b.name; });
  return b.lets_go && (same == before.end() || !same->quiet);
}

bool IsPrescribed(const NodeRecords &r, int node, int k) {
  const int row = r.of_node.empty() ? -1 : r.of_node[node];
  return row >= 0 && (r.kind[row] >> (2 * k) & 3) != kFree;
}

/// Nodes of a surface, of all cells that touch it.
void MarkNodes(const Mesh &mesh, const Nodes &nodes, int surface, char mark, std::vector<char> *marks) {
  for (PetscInt f : mesh.surface_faces[surface]) {
    const Face &face = mesh.faces[f];
    const int size = Info(mesh.cell_shape[face.cell[0]]).face_size[face.local[0]];
    for (int side = 0; side < (face.cell[1] >= 0 ? 2 : 1); ++side)
      for (int j = 0; j < size; ++j) {
        const PetscInt node = FaceNode(mesh, nodes, face, j, side);
        if (node >= 0 && node < nodes.n_owned) (*marks)[node] = std::max((*marks)[node], mark);
      }
  }
}

/// Takes what is out of balance in all off the forces of the nodes with that mark, by their dashpots, along directions in
/// which nothing is prescribed.
PetscErrorCode SpreadImbalance(const Tables &tables, const std::vector<double> &reaction,
                               const std::vector<double> &earlier, const std::vector<char> &marks, char mark,
                               std::vector<double> *held) {
  PetscFunctionBeginUser;
  const NodeRecords &r = tables.records;
  // along x, y, z: out of balance [N], dashpots [N s/m], prescribed components
  const std::size_t n = static_cast<std::size_t>(tables.n_owned);
  std::vector<std::vector<double>> value(9, std::vector<double>(n, 0.0));
  const auto dashpot = [&](int i, int k) {
    const int row = marks[i] == mark && !r.quiet.empty() ? r.of_node[i] : -1;
    const int quiet = row < 0 || IsPrescribed(r, i, k) ? -1 : r.quiet[row];
    return quiet < 0 ? 0.0 : r.dashpot[6 * static_cast<std::size_t>(quiet) + k];  // the diagonal comes first
  };
  for (int i = 0; i < tables.n_owned; ++i)
    for (int k = 0; k < 3; ++k) {
      const std::size_t at = 3 * static_cast<std::size_t>(i) + k;
      if (tables.mass[i] == 0) continue;
      value[k][i] = ((*held)[at] - earlier[at]) - reaction[at];
      value[3 + k][i] = dashpot(i, k);
      value[6 + k][i] = IsPrescribed(r, i, k);
    }
  std::vector<std::vector<Summands>> terms;
  for (const std::vector<double> &one : value) terms.push_back({{one.data(), nullptr, n}});
  std::vector<double> sums;
  PetscCall(SumInAnyOrder(tables.comm, terms, &sums));
  for (int k = 0; k < 3; ++k) {
    const double force = sums[k], all = sums[3 + k];
    if (all == 0 || sums[6 + k] > 0) continue;
    for (int i = 0; i < tables.n_owned; ++i)
      (*held)[3 * static_cast<std::size_t>(i) + k] -= force * (dashpot(i, k) / all);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

}  // namespace

PetscErrorCode ReadRelease(Options &options, Boundary *b, bool *wave) {
  PetscFunctionBeginUser;
  int quiet, held, moves, last = -2;
  PetscCall(options.GivenBy({"boundary", b->name, "quiet"}, &quiet));
  PetscCall(options.GivenBy({"boundary", b->name, "velocity"}, &moves));
  *wave = moves >= quiet;
  if (!*wave) last = moves;
  for (const char *holds : {"fix", "displacement"}) {
    PetscCall(options.GivenBy({"boundary", b->name, holds}, &held));
    last = std::max(last, held);
  }
  b->lets_go = quiet > 0 && last > -2 && last < quiet;
  if (!b->lets_go) PetscFunctionReturn(PETSC_SUCCESS);
  std::string word = "keep";
  PetscCall(options.Word({"boundary", b->name, "release"}, &word));
  b->keeps_reactions = word == "keep";
  PetscFunctionReturn(PETSC_SUCCESS);
}

bool KeepsReactions(const std::vector<Boundary> &before, const std::vector<Boundary> &now) {
  return std::any_of(now.begin(), now.end(),
                     [&](const Boundary &b) { return b.keeps_reactions && BecomesQuiet(before, b); });
}

PetscErrorCode HoldReactions(const Mesh &mesh, const Nodes &nodes, const std::vector<Boundary> &before,
                             const Tables &old, bool at_rest, const std::vector<Boundary> &now, const Tables &tables,
                             const std::vector<double> &reaction, std::vector<double> *held) {
  PetscFunctionBeginUser;
  enum : char { kStays, kDrops, kKeeps };  // a node of two boundaries keeps its reaction where one of them does
  std::vector<char> release(nodes.n_owned, kStays);
  for (const Boundary &b : now)
    if (BecomesQuiet(before, b)) MarkNodes(mesh, nodes, b.surface, b.keeps_reactions ? kKeeps : kDrops, &release);
  const std::vector<double> earlier = *held;
  for (int i = 0; i < tables.n_owned; ++i)
    for (int k = 0; k < 3; ++k) {
      double &force = (*held)[3 * static_cast<std::size_t>(i) + k];
      const bool lets_go = release[i] != kStays && IsPrescribed(old.records, i, k);
      if (IsPrescribed(tables.records, i, k) || (lets_go && release[i] == kDrops))
        force = 0;
      else if (lets_go)
        force = reaction[3 * static_cast<std::size_t>(i) + k];
    }
  if (at_rest && KeepsReactions(before, now))
    PetscCall(SpreadImbalance(tables, reaction, earlier, release, kKeeps, held));
  PetscFunctionReturn(PETSC_SUCCESS);
}

void AddLoads(const std::vector<double> &force, Tables *tables) {
  NodeRecords &r = tables->records;
  const auto loaded = [&](int i) {
    const double *f = &force[3 * static_cast<std::size_t>(i)];
    return f[0] != 0 || f[1] != 0 || f[2] != 0;
  };
  std::vector<int> node_of_row(r.n, -1);
  if (r.of_node.empty()) r.of_node.assign(tables->n_owned, -1), r.load_start.assign(1, 0);
  for (int i = 0; i < tables->n_owned; ++i) {
    int &row = r.of_node[i];
    if (row < 0 && loaded(i)) {
      row = r.n++;
      node_of_row.push_back(-1);
      r.kind.push_back(0);
      r.value.insert(r.value.end(), 3, 0.0);
      r.table.insert(r.table.end(), 3, 0);
      r.load_start.push_back(r.load_start.back());
      r.watch.push_back(-1);
      if (!r.quiet.empty()) r.quiet.push_back(-1);
    }
    if (row >= 0) node_of_row[row] = i;
  }
  const NodeRecords old = r;
  r.load_table.clear();
  r.load.clear();
  for (int row = 0; row < r.n; ++row) {
    for (int l = old.load_start[row]; l < old.load_start[row + 1]; ++l) {
      r.load_table.push_back(old.load_table[l]);
      r.load.insert(r.load.end(), &old.load[3 * static_cast<std::size_t>(l)],
                    &old.load[3 * static_cast<std::size_t>(l)] + 3);
    }
    const int node = node_of_row[row];
    if (loaded(node)) {
      r.load_table.push_back(0);  // the table that is 1
      r.load.insert(r.load.end(), &force[3 * static_cast<std::size_t>(node)],
                    &force[3 * static_cast<std::size_t>(node)] + 3);
    }
    r.load_start[row + 1] = static_cast<int>(r.load_table.size());
  }
  if (r.n == 0) r = NodeRecords();
}

}  // namespace cdem
