#include "forces/dilatation.hpp"

#include "forces/host_gather.hpp"
#include "mesh/geometry.hpp"
#include "physics/block_elastic.hpp"
#include "physics/element_tet_bbar.hpp"

#include <algorithm>
#include <limits>

namespace cdem {

namespace {

constexpr int kCorners = TetBbar::kCorners;

/// Lanes of the elements from e on: corners.
void GatherCorners(const ElementTable &t, int e, const double *field, Lanes q[kCorners][3]) {
  for (int a = 0; a < kCorners; ++a) Gather(field, &t.node[static_cast<std::size_t>(a) * t.n_pad + e], q[a]);
}

/// Values of the owned nodes to the ghosts behind them.
PetscErrorCode Halo(const Tables &tables, int width, double *value) {
  PetscFunctionBeginUser;
  if (!tables.halo) PetscFunctionReturn(PETSC_SUCCESS);
  MPI_Datatype unit;
  PetscCallMPI(MPI_Type_contiguous(width, MPIU_REAL, &unit));
  PetscCallMPI(MPI_Type_commit(&unit));
  double *ghosts = value + static_cast<std::size_t>(width) * tables.n_owned;
  PetscCall(PetscSFBcastBegin(tables.halo, unit, value, ghosts, MPI_REPLACE));
  PetscCall(PetscSFBcastEnd(tables.halo, unit, value, ghosts, MPI_REPLACE));
  PetscCallMPI(MPI_Type_free(&unit));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/// Sums to means at the owned nodes, and these to the ghosts.
PetscErrorCode Means(const Tables &tables, int rates, double *value) {
  PetscFunctionBeginUser;
  for (std::size_t i = 0; i < tables.inverse_volume.size(); ++i)
    for (int r = 0; r < rates; ++r) value[rates * i + r] *= tables.inverse_volume[i];
  PetscCall(Halo(tables, tables.layers * rates, value));
  PetscFunctionReturn(PETSC_SUCCESS);
}

}  // namespace

PetscErrorCode BuildAveraging(const Mesh &mesh, const std::vector<Material> &materials, Tables *tables) {
  PetscFunctionBeginUser;
  // the same layers on all ranks: regions that have such elements anywhere
  std::vector<int> layer(materials.size(), 0);
  for (const ElementTable &t : tables->elements)
    for (int e = 0; t.averages && e < t.n; ++e) layer[t.region[e]] = 1;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, layer.data(), static_cast<int>(layer.size()), MPI_INT, MPI_MAX, mesh.comm));
  tables->layers = 0;
  for (int &l : layer) l = l ? tables->layers++ : -1;
  if (tables->layers == 0) PetscFunctionReturn(PETSC_SUCCESS);

  tables->layer_bulk.assign(tables->layers, -std::numeric_limits<double>::infinity());
  tables->inverse_volume.assign(static_cast<std::size_t>(tables->layers) * tables->n_owned, 0.0);
  for (ElementTable &t : tables->elements) {
    if (!t.averages) continue;
    t.layer.resize(t.n_pad);
    for (int e = 0; e < t.n_pad; ++e) t.layer[e] = layer[t.region[e]];
    for (int e = 0; e < t.n; ++e) {
      const double *param = &tables->block_param[static_cast<std::size_t>(kMaxParams) * t.material[e]];
      double x[kCorners][3], &bulk = tables->layer_bulk[t.layer[e]];
      bulk = std::max(bulk, param[Elastic::kLambda] + 2.0 / 3 * param[Elastic::kMu]);
      for (int a = 0; a < kCorners; ++a) std::copy_n(&tables->x[3 * static_cast<std::size_t>(t.Node(a, e))], 3, x[a]);
      const double volume = TetBbar::Volume(x);
      for (int a = 0; a < kCorners; ++a)
        if (t.Node(a, e) < tables->n_owned)
          tables->inverse_volume[static_cast<std::size_t>(t.Node(a, e)) * tables->layers + t.layer[e]] += volume;
    }
  }
  for (double &value : tables->inverse_volume) value = value > 0 ? 1 / value : 0;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, tables->layer_bulk.data(), tables->layers, MPI_DOUBLE, MPI_MAX, mesh.comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode AverageDilatation(const Tables &tables, const double *u, const double *v, double beta,
                                 Averages *averages) {
  PetscFunctionBeginUser;
  const std::size_t nodes = static_cast<std::size_t>(tables.n_local) * tables.layers;
  const int rates = averages->rates = beta != 0 ? 2 : 1;
  averages->dilatation.assign(rates * nodes, 0.0);
  averages->pressure.assign(nodes, 0.0);
  averages->force.resize(tables.elements.size());
  for (std::size_t g = 0; g < tables.elements.size(); ++g) {
    const ElementTable &t = tables.elements[g];
    if (!t.averages) continue;
    averages->force[g].resize(static_cast<std::size_t>(3 * kCorners) * t.n_pad);
    for (int e = 0; e < t.n; e += kLanes) {
      Lanes x[kCorners][3], q[kCorners][3], swelling[2] = {};
      GatherCorners(t, e, tables.x.data(), x);
      GatherCorners(t, e, u, q);
      swelling[0] = TetBbar::Swelling(x, q);
      if (rates == 2) {
        GatherCorners(t, e, v, q);
        for (auto &corner : q)
          for (Lanes &component : corner) component = beta * component;
        swelling[1] = TetBbar::Swelling(x, q);
      }
      for (int l = 0; l < std::min(kLanes, t.n - e); ++l)
        for (int a = 0; a < kCorners; ++a)
          for (int r = 0; r < rates; ++r)
            averages->dilatation[rates * t.Layered(tables.layers, a, e + l) + r] += swelling[r][l];
    }
  }
  PetscCall(Means(tables, rates, averages->dilatation.data()));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode AveragePressure(const Tables &tables, Averages *averages) {
  PetscFunctionBeginUser;
  PetscCall(Means(tables, 1, averages->pressure.data()));
  PetscFunctionReturn(PETSC_SUCCESS);
}

void AddAveraged(const Tables &tables, std::size_t table, const Averages &averages, double *f) {
  const ElementTable &t = tables.elements[table];
  const double *force = averages.force[table].data();
  for (int e = 0; e < t.n; e += kLanes) {
    Lanes x[kCorners][3], of_node[kCorners], g[kCorners][3];
    GatherCorners(t, e, tables.x.data(), x);
    for (int a = 0; a < kCorners; ++a) {
      for (int l = 0; l < kLanes; ++l) of_node[a][l] = averages.pressure[t.Layered(tables.layers, a, e + l)];
      for (int k = 0; k < 3; ++k) g[a][k] = LoadAs<Lanes>(force + static_cast<std::size_t>(3 * a + k) * t.n_pad + e);
    }
    TetBbar::Press(x, of_node, g);
    for (int l = 0; l < std::min(kLanes, t.n - e); ++l)
      for (int a = 0; a < kCorners; ++a)
        for (int k = 0; k < 3; ++k) f[3 * static_cast<std::ptrdiff_t>(t.Node(a, e + l)) + k] += g[a][k][l];
  }
}

}  // namespace cdem
