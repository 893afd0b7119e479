#include "io/audit_rows.hpp"

#include "forces/element_audit.hpp"
#include "forces/spring_audit.hpp"

namespace cdem {

namespace {

int Rates(const Tables &tables) { return tables.beta != 0 ? 2 : 1; }

/// Numbers of a node: its own works, those of its record, the velocity and the dilatations of the step before.
int NodeWidth(const Tables &tables) {
  return kNodeWorks + kRowWorks + (tables.beta != 0 ? 3 : 0) + tables.layers * Rates(tables);
}

/// Calls f(number) with every number of an owned node, in the order of its row; numbers that it has not are NULL.
template <class F>
void EachOfNode(const Tables &t, AuditArrays *a, int i, F &&f) {
  const std::size_t owned = static_cast<std::size_t>(t.n_owned), records = static_cast<std::size_t>(t.records.n);
  const int row = t.records.n > 0 ? t.records.of_node[i] : -1, layers = t.layers * Rates(t);
  for (int k = 0; k < kNodeWorks; ++k) f(&a->node[k * owned + i]);
  for (int k = 0; k < kRowWorks; ++k) f(row < 0 ? nullptr : &a->row[k * records + row]);
  for (int k = 0; k < 3 && !a->speed.empty(); ++k) f(&a->speed[3 * static_cast<std::size_t>(i) + k]);
  for (int k = 0; k < layers; ++k) f(&a->dilatation[static_cast<std::size_t>(layers) * i + k]);
}

/// The same of an element or a spring; columns may be empty.
template <class F>
void EachOf(std::vector<double> &columns, int width, std::size_t stride, std::size_t row, F &&f) {
  for (int k = 0; k < width; ++k) f(columns.empty() ? nullptr : &columns[k * stride + row]);
}

template <class F>
void EachOfSpring(const Tables &t, AuditArrays *a, int table, int i, F &&f) {
  const std::size_t stride = static_cast<std::size_t>(t.springs[table].n_pad);
  EachOf(a->spring[table], kSpringWorks, stride, i, f);
  EachOf(a->viscous[table], 3, stride, i, f);
}

}  // namespace

PetscErrorCode FindAuditRows(const Mesh &mesh, const Nodes &nodes, const Tables &tables, std::vector<AuditRows> *rows) {
  PetscFunctionBeginUser;
  rows->clear();
  AuditRows elements, of_nodes;
  elements.name = "audit_elements";
  elements.width = kElementWorks;
  elements.total = mesh.n_global;
  for (PetscInt c = 0; c < mesh.n_owned; ++c) elements.given.push_back(mesh.cell_global[c]);
  for (const ElementTable &t : tables.elements)
    for (int e = 0; e < t.n; ++e) elements.wanted.push_back(mesh.cell_global[t.cell[e]]);
  rows->push_back(elements);
  of_nodes.name = "audit_nodes";
  of_nodes.nodes = true;
  of_nodes.width = NodeWidth(tables);
  of_nodes.total = nodes.n_global;
  of_nodes.given = of_nodes.wanted = nodes.global;
  rows->push_back(of_nodes);
  std::vector<HistoryRows> kinds;
  PetscCall(FindSpringRows(mesh, nodes, tables, &kinds));
  for (const HistoryRows &kind : kinds) {
    AuditRows springs;
    springs.name = "audit_" + kind.name;
    springs.springs = true;
    springs.spring_table = kind.table;
    springs.width = kSpringWorks + 3;
    springs.total = kind.total;
    for (int row : kind.given) springs.given.push_back(kind.number[row]);
    springs.wanted = kind.number;
    rows->push_back(springs);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

std::vector<double> TakeAuditRows(const AuditRows &rows, const Mesh &mesh, const Tables &tables,
                                  const AuditArrays &arrays) {
  auto *a = const_cast<AuditArrays *>(&arrays);  // only read
  std::vector<double> values;
  const auto take = [&](const double *number) { values.push_back(number ? *number : 0); };
  if (rows.nodes) {
    for (int i = 0; i < tables.n_owned; ++i) EachOfNode(tables, a, i, take);
  } else if (rows.springs) {
    for (int i = 0; rows.spring_table >= 0 && i < tables.springs[rows.spring_table].n; ++i)
      if (tables.springs[rows.spring_table].counted[i]) EachOfSpring(tables, a, rows.spring_table, i, take);
  } else {
    values.assign(static_cast<std::size_t>(rows.width) * mesh.n_owned, 0.0);
    for (std::size_t g = 0; g < tables.elements.size(); ++g) {
      const ElementTable &t = tables.elements[g];
      for (int e = 0; e < t.n && !arrays.element[g].empty(); ++e)
        for (int k = 0; k < rows.width && t.cell[e] < mesh.n_owned; ++k)
          values[static_cast<std::size_t>(rows.width) * t.cell[e] + k] =
              arrays.element[g][static_cast<std::size_t>(k) * t.n_pad + e];
    }
  }
  return values;
}

void PutAuditRows(const AuditRows &rows, const Tables &tables, const std::vector<double> &values, AuditArrays *arrays) {
  std::size_t at = 0;
  const auto put = [&](double *number) {
    if (number) *number = values[at];
    ++at;
  };
  if (rows.nodes) {
    for (int i = 0; i < tables.n_owned; ++i) EachOfNode(tables, arrays, i, put);
  } else if (rows.springs) {
    for (int i = 0; rows.spring_table >= 0 && i < tables.springs[rows.spring_table].n; ++i)
      EachOfSpring(tables, arrays, rows.spring_table, i, put);
  } else {
    for (std::size_t g = 0; g < tables.elements.size(); ++g)
      for (int e = 0; e < tables.elements[g].n; ++e)
        EachOf(arrays->element[g], rows.width, static_cast<std::size_t>(tables.elements[g].n_pad), e, put);
  }
}

PetscErrorCode ShareAudit(const Tables &tables, AuditArrays *arrays) {
  PetscFunctionBeginUser;
  for (auto [width, values] : {std::pair<int, std::vector<double> *>{3, &arrays->speed},
                               {tables.layers * Rates(tables), &arrays->dilatation}}) {
    if (!tables.halo || width == 0 || (values == &arrays->speed && tables.beta == 0)) continue;  // alike on all ranks
    MPI_Datatype unit;
    PetscCallMPI(MPI_Type_contiguous(width, MPIU_REAL, &unit));
    PetscCallMPI(MPI_Type_commit(&unit));
    double *ghosts = values->data() + static_cast<std::size_t>(width) * tables.n_owned;
    PetscCall(PetscSFBcastBegin(tables.halo, unit, values->data(), ghosts, MPI_REPLACE));
    PetscCall(PetscSFBcastEnd(tables.halo, unit, values->data(), ghosts, MPI_REPLACE));
    PetscCallMPI(MPI_Type_free(&unit));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

}  // namespace cdem
