#include "forces/elastic_operator.hpp"

#include "forces/host_gather.hpp"
#include "forces/host_passes.hpp"

#include <algorithm>
#include <cmath>

namespace cdem {

bool HasOwnLaws(const ElementTable &t) {
  bool own = false;
  VisitElement(t.shape, t.form, [&](auto form) { own = decltype(form)::kAtCorners; });
  return own;
}

int ElasticLaw(const ElementTable &t) { return HasOwnLaws(t) ? t.law : BlockLaws::Find(Elastic::kName); }

std::vector<double> ElasticParams(const Tables &tables) {
  std::vector<double> param = tables.block_param;
  for (const ElementTable &t : tables.elements)
    if (HasOwnLaws(t))
      BlockLaws::Visit(t.law, [&](auto law) {
        for (int row : t.material) decltype(law)::MakeIntact(&param[static_cast<std::size_t>(kMaxParams) * row]);
      });
  return param;
}

std::vector<std::uint8_t> FreeComponents(const Tables &tables) {
  const NodeRecords &records = tables.records;
  std::vector<std::uint8_t> bits(tables.n_owned, 7);
  for (int i = 0; records.n > 0 && i < tables.n_owned; ++i)
    for (int row = records.of_node[i], k = 0; row >= 0 && k < 3; ++k)
      if (((records.kind[row] >> (2 * k)) & 3) != kFree) bits[i] &= static_cast<std::uint8_t>(~(1 << k));
  return bits;
}

namespace {

/// What the matrix holds: tables of the elements alone, as elastic ones, and the scaling.
struct Elasticity {
  const Tables *scene;
  Tables tables;
  std::vector<ElementHistories> history;  // of laws of corners; nothing ever breaks
  std::vector<double> scale;              // [n_owned][3] 1/sqrt(m), 0 where prescribed [kg^-1/2]
  std::vector<double> u, f;               // [n_local][3]
  MPI_Datatype unit = MPI_DATATYPE_NULL;
};

void AddSprings(const SpringTable &t, const double *u, double *f) {
  const std::size_t stride = t.n_pad;
  for (int i = 0; i < t.n; i += kLanes) {
    Spring<Lanes> s;
    Lanes at[3], force[3];
    Gather(u, &t.b[i], s.d);
    Gather(u, &t.a[i], at);
    for (int k = 0; k < 3; ++k) {
      s.d[k] -= at[k];
      s.normal[k] = LoadAs<Lanes>(&t.normal[k * stride + i]);
    }
    s.kn = LoadAs<Lanes>(&t.kn[i]);
    s.ks = LoadAs<Lanes>(&t.ks[i]);
    SpringForce<JointElastic, false>(s, force);
    for (int l = 0; l < std::min(kLanes, t.n - i); ++l)
      for (int k = 0; k < 3; ++k) {
        f[3 * static_cast<std::ptrdiff_t>(t.a[i + l]) + k] += force[k][l];
        f[3 * static_cast<std::ptrdiff_t>(t.b[i + l]) + k] -= force[k][l];
      }
  }
}

PetscErrorCode Multiply(Mat matrix, Vec x, Vec y) {
  PetscFunctionBeginUser;
  Elasticity *e;
  const PetscScalar *from;
  PetscScalar *to;
  PetscCall(MatShellGetContext(matrix, &e));
  PetscCall(VecGetArrayRead(x, &from));
  for (std::size_t i = 0; i < e->scale.size(); ++i) e->u[i] = e->scale[i] * from[i];
  PetscCall(VecRestoreArrayRead(x, &from));
  if (e->tables.halo) {
    double *ghosts = e->u.data() + e->scale.size();
    PetscCall(PetscSFBcastBegin(e->tables.halo, e->unit, e->u.data(), ghosts, MPI_REPLACE));
    PetscCall(PetscSFBcastEnd(e->tables.halo, e->unit, e->u.data(), ghosts, MPI_REPLACE));
  }
  std::fill(e->f.begin(), e->f.end(), 0.0);
  HostElements(e->tables, e->u.data(), nullptr, 0, 0, e->history, e->f.data());
  for (const SpringTable &t : e->scene->springs) AddSprings(t, e->u.data(), e->f.data());
  PetscCall(VecGetArrayWrite(y, &to));
  for (std::size_t i = 0; i < e->scale.size(); ++i) to[i] = e->scale[i] * e->f[i];
  PetscCall(VecRestoreArrayWrite(y, &to));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode Destroy(Mat matrix) {
  PetscFunctionBeginUser;
  Elasticity *e;
  PetscCall(MatShellGetContext(matrix, &e));
  if (e->unit != MPI_DATATYPE_NULL) PetscCallMPI(MPI_Type_free(&e->unit));
  delete e;
  PetscFunctionReturn(PETSC_SUCCESS);
}

}  // namespace

PetscErrorCode CreateElasticOperator(const Tables &tables, Mat *matrix) {
  PetscFunctionBeginUser;
  auto *e = new Elasticity;
  e->scene = &tables;
  e->tables.comm = tables.comm;
  e->tables.n_owned = tables.n_owned;
  e->tables.n_local = tables.n_local;
  e->tables.halo = tables.halo;
  e->tables.x = tables.x;
  e->tables.elements = tables.elements;
  e->tables.block_param = ElasticParams(tables);
  e->tables.layers = tables.layers;
  e->tables.inverse_volume = tables.inverse_volume;
  e->tables.layer_bulk = tables.layer_bulk;
  for (ElementTable &t : e->tables.elements) {
    t.law = ElasticLaw(t);
    t.breaks = t.judged = false;
    if (!HasOwnLaws(t)) t.states = 0;
  }
  e->history = StartElements(e->tables);

  const std::vector<std::uint8_t> free = FreeComponents(tables);
  e->scale.resize(3 * static_cast<std::size_t>(tables.n_owned));
  for (int i = 0; i < tables.n_owned; ++i)
    for (int k = 0; k < 3; ++k)
      e->scale[3 * static_cast<std::size_t>(i) + k] = free[i] >> k & 1 ? std::sqrt(tables.inverse_mass[i]) : 0;
  e->u.assign(tables.x.size(), 0.0);
  e->f.assign(tables.x.size(), 0.0);
  if (tables.halo) {
    PetscCallMPI(MPI_Type_contiguous(3, MPIU_REAL, &e->unit));
    PetscCallMPI(MPI_Type_commit(&e->unit));
  }
  const PetscInt n = 3 * static_cast<PetscInt>(tables.n_owned);
  PetscCall(MatCreateShell(tables.comm, n, n, PETSC_DETERMINE, PETSC_DETERMINE, e, matrix));
  PetscCall(MatShellSetOperation(*matrix, MATOP_MULT, reinterpret_cast<void (*)(void)>(Multiply)));
  PetscCall(MatShellSetOperation(*matrix, MATOP_DESTROY, reinterpret_cast<void (*)(void)>(Destroy)));
  PetscFunctionReturn(PETSC_SUCCESS);
}

}  // namespace cdem
