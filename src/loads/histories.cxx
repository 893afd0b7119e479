#include "core/error.hpp"
#include "core/options.hpp"
#include "loads/boundary.hpp"

#include <limits>

namespace cdem {

/// The owned node nearest to a point: by distance, then by global number, over all ranks.
static PetscErrorCode Nearest(const Mesh &mesh, const Nodes &nodes, History *h) {
  PetscFunctionBeginUser;
  PetscMPIInt rank;
  PetscCallMPI(MPI_Comm_rank(mesh.comm, &rank));
  double best = std::numeric_limits<double>::infinity();
  for (PetscInt i = 0; i < nodes.n_owned; ++i) {
    const double *x = mesh.X(nodes.vertex[i]);
    double d2 = 0;
    for (int k = 0; k < 3; ++k) d2 += (x[k] - h->at[k]) * (x[k] - h->at[k]);
    if (d2 < best) best = d2, h->node = static_cast<int>(i);
  }
  double least;
  PetscCallMPI(MPI_Allreduce(&best, &least, 1, MPI_DOUBLE, MPI_MIN, mesh.comm));
  std::int64_t number =
      best == least && h->node >= 0 ? nodes.global[h->node] : std::numeric_limits<std::int64_t>::max();
  std::int64_t lowest;
  PetscCallMPI(MPI_Allreduce(&number, &lowest, 1, MPI_INT64_T, MPI_MIN, mesh.comm));
  PetscMPIInt owner = number == lowest && h->node >= 0 ? rank : -1;
  PetscCallMPI(MPI_Allreduce(&owner, &h->rank, 1, MPI_INT, MPI_MAX, mesh.comm));
  if (h->rank == rank)
    for (int k = 0; k < 3; ++k) h->found[k] = mesh.X(nodes.vertex[h->node])[k];
  PetscCallMPI(MPI_Bcast(h->found, 3, MPI_DOUBLE, h->rank, mesh.comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ReadHistories(const Mesh &mesh, const Nodes &nodes, Options &options, std::vector<History> *histories) {
  PetscFunctionBeginUser;
  std::vector<std::string> names;
  PetscCall(options.Names("histories", &names));
  options.Declare("history", names);
  for (const std::string &name : names) {
    History h;
    h.name = name;
    bool set;
    PetscCall(options.Reals({"history", name, "at"}, 3, h.at, &set));
    CdemCheck(set, mesh.comm, "history '%s' has no place: give %s x,y,z in m", name.c_str(),
              Options::Spelled({"history", name, "at"}).c_str());
    PetscCall(options.Word({"history", name, "of"}, &h.of, &set));
    CdemCheck(set, mesh.comm, "history '%s' has no quantity: give %s, such as displacement_z", name.c_str(),
              Options::Spelled({"history", name, "of"}).c_str());
    h.component = (h.of.rfind("velocity", 0) == 0 ? 3 : 0) + (h.of.back() - 'x');
    PetscCall(Nearest(mesh, nodes, &h));
    histories->push_back(h);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

}  // namespace cdem
