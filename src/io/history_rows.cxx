#include "io/history_rows.hpp"

#include "physics/elements.hpp"

#include <algorithm>

namespace cdem {

namespace {

constexpr int kMostForms = 16, kMostLaws = 64;
constexpr int kElementKinds = kShapes * kMostForms * kMostLaws;

int ElementKind(const ElementTable &t) { return (static_cast<int>(t.shape) * kMostForms + t.form) * kMostLaws + t.law; }

/// Which kinds any rank has, by the numbers of shape, form and law.
PetscErrorCode KindsThere(const Tables &tables, std::vector<char> *there) {
  PetscFunctionBeginUser;
  there->assign(kElementKinds + kMostLaws, 0);
  static_assert(BlockLaws::kCount <= kMostLaws && JointLaws::kCount <= kMostLaws, "numbers of laws");
  static_assert(HexForms::kCount <= kMostForms && TetForms::kCount <= kMostForms, "numbers of forms");
  for (const ElementTable &t : tables.elements)
    if (t.states > 0) (*there)[ElementKind(t)] = 1;
  for (const SpringTable &t : tables.springs)
    if (!t.state.empty()) (*there)[kElementKinds + t.law] = 1;
  PetscCallMPI(
      MPI_Allreduce(MPI_IN_PLACE, there->data(), static_cast<int>(there->size()), MPI_CHAR, MPI_MAX, tables.comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/// From the owners of cells to the overlap of others; width values a cell.
PetscErrorCode Share(const Mesh &mesh, int width, std::vector<std::int64_t> *values) {
  PetscFunctionBeginUser;
  if (!mesh.cell_sf) PetscFunctionReturn(PETSC_SUCCESS);
  const std::vector<std::int64_t> own(*values);
  MPI_Datatype unit;
  PetscCallMPI(MPI_Type_contiguous(width, MPI_INT64_T, &unit));
  PetscCallMPI(MPI_Type_commit(&unit));
  PetscCall(PetscSFBcastBegin(mesh.cell_sf, unit, own.data(), values->data(), MPI_REPLACE));
  PetscCall(PetscSFBcastEnd(mesh.cell_sf, unit, own.data(), values->data(), MPI_REPLACE));
  PetscCallMPI(MPI_Type_free(&unit));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode NumberElements(const Mesh &mesh, const Tables &tables, HistoryRows *kind) {
  PetscFunctionBeginUser;
  const ElementTable *t = kind->table < 0 ? nullptr : &tables.elements[kind->table];
  std::vector<PetscInt> count(mesh.n_owned, 0);
  for (int e = 0; t && e < t->n; ++e)
    if (t->cell[e] < mesh.n_owned) {
      kind->given.push_back(e);
      count[t->cell[e]] = 1;
    }
  std::vector<std::int64_t> row;
  PetscCall(GlobalOffsets(mesh, count, &row, &kind->total));
  row.resize(mesh.n_cells, -1);
  PetscCall(Share(mesh, 1, &row));
  for (int e = 0; t && e < t->n; ++e) {
    kind->number.push_back(row[t->cell[e]]);
    kind->place.push_back(mesh.cell_global[t->cell[e]]);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode NumberSprings(const Mesh &mesh, const Nodes &nodes, const Tables &tables, HistoryRows *kind) {
  PetscFunctionBeginUser;
  const SpringTable *t = kind->table < 0 ? nullptr : &tables.springs[kind->table];
  const std::vector<int> corner = t ? SpringCorners(mesh, nodes, *t) : std::vector<int>();
  std::vector<PetscInt> count(mesh.n_owned, 0);
  // Of each face: four bits, one for each corner with a spring, and above them the number of its first spring within the
  // cell. The owner of the first cell knows all springs of a face, the others may lack some.
  std::vector<std::int64_t> faces(kMaxFaces * static_cast<std::size_t>(mesh.n_cells), 0), before;
  const auto of = [&](int i) -> std::int64_t & {
    const Face &face = mesh.faces[t->face[i]];
    return faces[kMaxFaces * static_cast<std::size_t>(face.cell[0]) + face.local[0]];
  };
  for (int i = 0; t && i < t->n; ++i) {
    if (!t->counted[i]) continue;
    kind->given.push_back(i);
    PetscInt &springs = count[mesh.faces[t->face[i]].cell[0]];
    std::int64_t &face = of(i);
    if (face == 0) face = static_cast<std::int64_t>(springs) << 4;
    face |= std::int64_t{1} << corner[i];
    ++springs;
  }
  PetscCall(GlobalOffsets(mesh, count, &before, &kind->total));
  for (PetscInt c = 0; c < mesh.n_owned; ++c)
    for (int f = 0; f < kMaxFaces; ++f) faces[kMaxFaces * static_cast<std::size_t>(c) + f] += before[c] << 4;
  PetscCall(Share(mesh, kMaxFaces, &faces));
  for (int i = 0; t && i < t->n; ++i) {
    const Face &face = mesh.faces[t->face[i]];
    const std::int64_t there = of(i) & 15, lower = there & ((std::int64_t{1} << corner[i]) - 1);
    PetscCheck(there >> corner[i] & 1, PETSC_COMM_SELF, PETSC_ERR_PLIB, "a spring that its owner does not have");
    std::int64_t rank = 0;
    for (int bit = 0; bit < 4; ++bit) rank += lower >> bit & 1;
    kind->number.push_back((of(i) >> 4) + rank);
    for (const std::int64_t p : {static_cast<std::int64_t>(mesh.cell_global[face.cell[0]]),
                                 static_cast<std::int64_t>(face.local[0]), static_cast<std::int64_t>(corner[i])})
      kind->place.push_back(p);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode OfSpringLaw(const Mesh &mesh, const Nodes &nodes, const Tables &tables, int law, HistoryRows *kind) {
  PetscFunctionBeginUser;
  kind->springs = true;
  JointLaws::Visit(law, [&](auto l) {
    kind->states = decltype(l)::kState;
    kind->name = std::string("springs_") + decltype(l)::kName + "_" + std::to_string(kind->states);
  });
  for (std::size_t g = 0; g < tables.springs.size(); ++g)
    if (tables.springs[g].law == law) kind->table = static_cast<int>(g);
  kind->places = 3;
  PetscCall(NumberSprings(mesh, nodes, tables, kind));
  PetscFunctionReturn(PETSC_SUCCESS);
}

}  // namespace

PetscErrorCode FindSpringRows(const Mesh &mesh, const Nodes &nodes, const Tables &tables,
                              std::vector<HistoryRows> *kinds) {
  PetscFunctionBeginUser;
  char there[kMostLaws] = {};
  for (const SpringTable &t : tables.springs) there[t.law] = 1;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, there, kMostLaws, MPI_CHAR, MPI_MAX, tables.comm));
  kinds->clear();
  for (int law = 0; law < kMostLaws; ++law) {
    if (!there[law]) continue;
    kinds->emplace_back();
    PetscCall(OfSpringLaw(mesh, nodes, tables, law, &kinds->back()));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode FindHistoryRows(const Mesh &mesh, const Nodes &nodes, const Tables &tables,
                               std::vector<HistoryRows> *kinds) {
  PetscFunctionBeginUser;
  std::vector<char> there;
  PetscCall(KindsThere(tables, &there));
  kinds->clear();
  for (int k = 0; k < static_cast<int>(there.size()); ++k) {
    if (!there[k]) continue;
    HistoryRows kind;
    kind.springs = k >= kElementKinds;
    if (kind.springs) {
      PetscCall(OfSpringLaw(mesh, nodes, tables, k - kElementKinds, &kind));
    } else {
      const Shape shape = static_cast<Shape>(k / (kMostForms * kMostLaws));
      VisitBlock(shape, k / kMostLaws % kMostForms, k % kMostLaws, [&](auto form, auto law) {
        kind.states = decltype(form)::kPoints * decltype(law)::kState;
        kind.timed = decltype(law)::kJudgesMean;
        kind.name =
            std::string("elements_") + Info(shape).name + "_" + decltype(form)::kName + "_" + decltype(law)::kName;
        if (BlockLaws::Find(decltype(law)::kName) != k % kMostLaws) kind.name += "_offset";
      });
      for (std::size_t g = 0; g < tables.elements.size(); ++g)
        if (ElementKind(tables.elements[g]) == k) kind.table = static_cast<int>(g);
      PetscCall(NumberElements(mesh, tables, &kind));
    }
    for (const HistoryRows &other : *kinds)
      PetscCheck(other.name != kind.name, tables.comm, PETSC_ERR_PLIB, "two kinds of history are called %s",
                 kind.name.c_str());
    kinds->push_back(std::move(kind));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

HistoryData TakeRows(const HistoryRows &kind, const Histories &history, const std::vector<int> &rows) {
  HistoryData data;
  if (kind.table < 0) return data;
  const auto take = [&](const std::vector<std::uint8_t> &state, const std::vector<double> &value) {
    const std::size_t stride = state.size();
    for (int row : rows) {
      data.state.push_back(state[row]);
      for (int k = 0; k < kind.states; ++k) data.value.push_back(value[k * stride + row]);
    }
  };
  if (kind.springs) {
    take(history.springs[kind.table].state, history.springs[kind.table].values);
  } else {
    const ElementHistories &h = history.elements[kind.table];
    take(h.state, h.value);
    if (kind.timed)
      for (int row : rows) data.broken_time.push_back(h.broken_time[row]);
  }
  return data;
}

void PutRows(const HistoryRows &kind, const HistoryData &data, Histories *history) {
  if (kind.table < 0) return;
  const std::size_t n = data.state.size();
  const auto put = [&](std::vector<std::uint8_t> &state, std::vector<double> &value) {
    const std::size_t stride = state.size();
    for (std::size_t row = 0; row < stride; ++row) {
      const std::size_t from = std::min(row, n - 1);
      state[row] = data.state[from];
      for (int k = 0; k < kind.states; ++k) value[k * stride + row] = data.value[kind.states * from + k];
    }
  };
  if (kind.springs) {
    put(history->springs[kind.table].state, history->springs[kind.table].values);
  } else {
    ElementHistories &h = history->elements[kind.table];
    put(h.state, h.value);
    for (std::size_t row = 0; kind.timed && row < h.broken_time.size(); ++row)
      h.broken_time[row] = data.broken_time[std::min(row, n - 1)];
  }
}

}  // namespace cdem
