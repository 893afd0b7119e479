// Which element faces the discs take.
#include "core/small.hpp"
#include "joints/clip.hpp"
#include "joints/network.hpp"
#include "mesh/geometry.hpp"

namespace cdem {

static double FaceArea(const Mesh &mesh, const Face &face) {
  double x[4][3], vectors[4][3], area = 0;
  const int size = FaceCorners(mesh, face, x);
  FaceVectors(size, x, vectors);
  for (int j = 0; j < size; ++j) area += std::sqrt(Dot(vectors[j], vectors[j]));
  return area;
}

FaceTaker::FaceTaker(const Mesh &mesh) : mesh_(mesh), cell_centre_(3 * mesh.n_cells) {
  for (PetscInt c = 0; c < mesh.n_cells; ++c) CellCentre(mesh, c, &cell_centre_[3 * c]);
  double reach2 = 0;
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    const Face &face = mesh.faces[f];
    if (face.cell[1] < 0) continue;
    double x[4][3], centre[3] = {0, 0, 0};
    const int size = FaceCorners(mesh, face, x);
    for (int j = 0; j < size; ++j)
      for (int k = 0; k < 3; ++k) centre[k] += x[j][k] / size;
    for (PetscInt c :
         face.cell) {  // where a disc separates the cells, it passes no farther from the face than they lie
      double away = 0;
      for (int k = 0; k < 3; ++k) away += (cell_centre_[3 * c + k] - centre[k]) * (cell_centre_[3 * c + k] - centre[k]);
      reach2 = std::max(reach2, away);
    }
    face_centre_.insert(face_centre_.end(), centre, centre + 3);
    face_.push_back(static_cast<PetscInt>(f));
  }
  bins_.Fill(face_centre_, std::sqrt(reach2));
}

PetscErrorCode FaceTaker::Take(JointSet *set, std::vector<PetscInt> *faces) const {
  PetscFunctionBeginUser;
  std::vector<char> taken(face_.size(), 0);
  auto within = [&](const Face &face) {
    return set->region < 0 ||
           (mesh_.cell_region[face.cell[0]] == set->region && mesh_.cell_region[face.cell[1]] == set->region);
  };
  for (const Disc &disc : set->discs) {
    auto distance = [&](const double *x) {
      const double r[3] = {x[0] - disc.centre[0], x[1] - disc.centre[1], x[2] - disc.centre[2]};
      return Dot(disc.normal, r);
    };
    bins_.Near(disc, [&](std::size_t i) {
      const Face &face = mesh_.faces[face_[i]];
      if (taken[i] ||
          (distance(&cell_centre_[3 * face.cell[0]]) > 0) == (distance(&cell_centre_[3 * face.cell[1]]) > 0))
        return;
      const double *x = &face_centre_[3 * i];
      const double r[3] = {x[0] - disc.centre[0], x[1] - disc.centre[1], x[2] - disc.centre[2]};
      const double d = Dot(disc.normal, r);
      if (Dot(r, r) - d * d <= disc.radius * disc.radius && within(face)) taken[i] = 1;
    });
  }
  // Areas are added as whole numbers, so that the sum does not depend on the ranks.
  double unit = 0;
  for (int k = 0; k < 3; ++k) unit = std::max(unit, (set->upper[k] - set->lower[k]) * (set->upper[k] - set->lower[k]));
  unit *= 0x1p-50;
  std::int64_t sums[3] = {0, 0, 0};
  faces->clear();
  for (std::size_t i = 0; i < face_.size(); ++i) {
    const Face &face = mesh_.faces[face_[i]];
    if (taken[i]) faces->push_back(face_[i]);
    if (face.cell[0] >= mesh_.n_owned || !within(face)) continue;
    ++sums[0];
    if (!taken[i]) continue;
    ++sums[1];
    sums[2] += std::llround(FaceArea(mesh_, face) / unit);
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, sums, 3, MPI_INT64_T, MPI_SUM, mesh_.comm));
  set->inner_faces = sums[0];
  set->taken_faces = sums[1];
  set->taken_area = static_cast<double>(sums[2]) * unit;
  PetscFunctionReturn(PETSC_SUCCESS);
}

}  // namespace cdem
