#include "forces/validity.hpp"

#include "core/small.hpp"
#include "mesh/geometry.hpp"

#include <algorithm>
#include <cmath>

namespace cdem {

namespace {

/// Mean rotation of an element [degrees]: half the curl of u.
double Rotation(const Tables &tables, const ElementTable &t, int e, const double *u, double *centre) {
  double x[kMaxCorners][3], w[kMaxCorners][3], g[3][3];
  std::fill_n(centre, 3, 0.0);
  for (int a = 0; a < t.corners; ++a) {
    const std::size_t node = 3 * static_cast<std::size_t>(t.node[static_cast<std::size_t>(a) * t.n_pad + e]);
    for (int k = 0; k < 3; ++k) {
      x[a][k] = tables.x[node + k];
      w[a][k] = u[node + k];
      centre[k] += x[a][k] / t.corners;
    }
  }
  MeanGradient(t.shape, x, w, g);
  const double curl[3] = {g[2][1] - g[1][2], g[0][2] - g[2][0], g[1][0] - g[0][1]};
  return 0.5 * std::sqrt(Dot(curl, curl)) * 180 / 3.14159265358979323846;
}

/// Tangential shift of a spring over the edge of a square face of four such shares.
double Slip(const SpringTable &t, int i, const double *u) {
  double d[3], n[3];
  for (int k = 0; k < 3; ++k) {
    d[k] = u[3 * static_cast<std::size_t>(t.b[i]) + k] - u[3 * static_cast<std::size_t>(t.a[i]) + k];
    n[k] = t.normal[static_cast<std::size_t>(k) * t.n_pad + i];
  }
  const double along = Dot(n, d);
  return std::sqrt(std::max(0.0, Dot(d, d) - along * along) / (4 * t.area[i]));
}

}  // namespace

PetscErrorCode LargestOverRanks(MPI_Comm comm, double *value, double *place) {
  PetscFunctionBeginUser;
  struct {
    double value;
    int rank;
  } mine = {*value, 0}, most;
  PetscCallMPI(MPI_Comm_rank(comm, &mine.rank));
  PetscCallMPI(MPI_Allreduce(&mine, &most, 1, MPI_DOUBLE_INT, MPI_MAXLOC, comm));
  PetscCallMPI(MPI_Bcast(place, 3, MPI_DOUBLE, most.rank, comm));
  *value = most.value;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CheckValidity(const Tables &tables, const double *u, Validity *validity) {
  PetscFunctionBeginUser;
  *validity = Validity();
  for (const ElementTable &t : tables.elements)
    for (int e = 0; e < t.n; ++e) {
      double centre[3];
      const double rotation = Rotation(tables, t, e, u, centre);
      if (rotation <= validity->rotation) continue;
      validity->rotation = rotation;
      std::copy_n(centre, 3, validity->rotation_at);
    }
  for (const SpringTable &t : tables.springs)
    for (int i = 0; i < t.n; ++i) {
      const double slip = Slip(t, i, u);
      if (slip <= validity->slip) continue;
      validity->slip = slip;
      std::copy_n(&tables.x[3 * static_cast<std::size_t>(t.a[i])], 3, validity->slip_at);
    }
  PetscCall(LargestOverRanks(tables.comm, &validity->slip, validity->slip_at));
  PetscCall(LargestOverRanks(tables.comm, &validity->rotation, validity->rotation_at));
  PetscFunctionReturn(PETSC_SUCCESS);
}

}  // namespace cdem
