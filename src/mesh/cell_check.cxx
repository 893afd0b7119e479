#include "core/error.hpp"
#include "mesh/source.hpp"

#include <algorithm>
#include <cmath>

namespace cdem {

namespace {

constexpr int kMaxPoints = 16;
constexpr double kTiny = 1e-12;  // of the cube of the largest edge: det J below that is no volume

// Gradients of the shape functions on the reference cell at its corners and integration points.
struct Gradients {
  int n_points = 0;
  double dn[kMaxPoints][kMaxCorners][3];
};

constexpr int kHexCorner[8][3] = {{-1, -1, -1}, {1, -1, -1}, {1, 1, -1}, {-1, 1, -1},
                                  {-1, -1, 1},  {1, -1, 1},  {1, 1, 1},  {-1, 1, 1}};

Gradients HexGradients() {
  Gradients g;
  for (double scale : {1.0, 1 / std::sqrt(3.0)}) {
    for (const int *p : kHexCorner) {
      for (int a = 0; a < 8; ++a) {
        double f[3];
        for (int d = 0; d < 3; ++d) f[d] = 0.5 * (1 + scale * kHexCorner[a][d] * p[d]);
        for (int d = 0; d < 3; ++d) g.dn[g.n_points][a][d] = 0.5 * kHexCorner[a][d] * f[(d + 1) % 3] * f[(d + 2) % 3];
      }
      ++g.n_points;
    }
  }
  return g;
}

Gradients WedgeGradients() {
  Gradients g;
  const double slope[3][2] = {{-1, -1}, {1, 0}, {0, 1}};
  for (double scale : {1.0, 1 / std::sqrt(3.0)}) {
    const double near = scale == 1 ? 1 : 2.0 / 3, far = scale == 1 ? 0 : 1.0 / 6;
    for (int p = 0; p < 6; ++p) {
      for (int a = 0; a < 6; ++a) {
        const double side = a < 3 ? -1 : 1, height = 0.5 * (1 + side * scale * (p < 3 ? -1 : 1));
        for (int d = 0; d < 2; ++d) g.dn[g.n_points][a][d] = slope[a % 3][d] * height;
        g.dn[g.n_points][a][2] = 0.5 * side * (a % 3 == p % 3 ? near : far);
      }
      ++g.n_points;
    }
  }
  return g;
}

Gradients TetGradients() {
  Gradients g{1, {{{-1, -1, -1}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}};
  return g;
}

bool IsGood(const Gradients &gradients, const ShapeInfo &info, const double (*x)[3]) {
  double largest = 0;  // squared distance to corner 0
  for (int a = 1; a < info.corners; ++a) {
    double length = 0;
    for (int d = 0; d < 3; ++d) length += (x[a][d] - x[0][d]) * (x[a][d] - x[0][d]);
    largest = std::max(largest, length);
  }
  const double least = kTiny * largest * std::sqrt(largest);
  for (int p = 0; p < gradients.n_points; ++p) {
    double j[3][3] = {};
    for (int a = 0; a < info.corners; ++a) {
      for (int d = 0; d < 3; ++d) {
        for (int k = 0; k < 3; ++k) j[d][k] += gradients.dn[p][a][d] * x[a][k];
      }
    }
    const double det = j[0][0] * (j[1][1] * j[2][2] - j[1][2] * j[2][1]) +
                       j[0][1] * (j[1][2] * j[2][0] - j[1][0] * j[2][2]) +
                       j[0][2] * (j[1][0] * j[2][1] - j[1][1] * j[2][0]);
    if (!(det > least)) return false;  // NaN is not good either
  }
  return true;
}

void Relative(const Mesh &mesh, PetscInt cell, double (*x)[3]) {  // to corner 0, so that no digits go to the offset
  const PetscInt *corner = mesh.Corners(cell);
  for (int a = 0; a < Info(mesh.cell_shape[cell]).corners; ++a) {
    for (int d = 0; d < 3; ++d) x[a][d] = mesh.X(corner[a])[d] - mesh.X(corner[0])[d];
  }
}

}  // namespace

PetscErrorCode CheckGeometry(const MeshSource &source, const Mesh &mesh) {
  PetscFunctionBeginUser;
  const Gradients gradients[kShapes] = {TetGradients(), WedgeGradients(), HexGradients()};
  PetscInt bad = 0, first = PETSC_INT_MAX, local = -1;
  for (PetscInt c = 0; c < mesh.n_owned; ++c) {
    double x[kMaxCorners][3];
    Relative(mesh, c, x);
    if (IsGood(gradients[static_cast<int>(mesh.cell_shape[c])], Info(mesh.cell_shape[c]), x)) continue;
    if (++bad > 1) continue;
    first = mesh.cell_global[c];
    local = c;
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &bad, 1, MPIU_INT, MPI_SUM, mesh.comm));
  if (bad == 0) PetscFunctionReturn(PETSC_SUCCESS);

  const PetscInt mine = first;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &first, 1, MPIU_INT, MPI_MIN, mesh.comm));
  double found[4] = {0, 0, 0, 0};  // shape, centroid: of the rank that has the first one
  if (mine == first) {
    const ShapeInfo &info = Info(mesh.cell_shape[local]);
    found[0] = static_cast<double>(mesh.cell_shape[local]);
    for (int a = 0; a < info.corners; ++a) {
      for (int d = 0; d < 3; ++d) found[1 + d] += mesh.X(mesh.Corners(local)[a])[d] / info.corners;
    }
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, found, 4, MPI_DOUBLE, MPI_SUM, mesh.comm));
  const auto index = static_cast<std::size_t>(first);
  const bool named = index < source.cell_number.size();  // only rank 0 knows, and only it prints
  CdemCheck(false, mesh.comm,
            "%s: %" PetscInt_FMT " of %" PetscInt_FMT
            " elements are inverted or degenerate (det J <= 0 at a corner or "
            "integration point), the first is %s %lld%s with its centroid at %s; %s",
            source.what.c_str(), bad, mesh.n_global, kShapeInfo[static_cast<int>(found[0])].name,
            named ? static_cast<long long>(source.cell_number[index]) : static_cast<long long>(first),
            named ? "" : " (counted from 0)", PlaceText(found + 1).c_str(), source.hint.c_str());
  PetscFunctionReturn(PETSC_SUCCESS);
}

}  // namespace cdem
