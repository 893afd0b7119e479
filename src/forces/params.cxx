#include "forces/params.hpp"

#include "core/error.hpp"
#include "mesh/geometry.hpp"
#include "physics/laws.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace cdem {

bool HasOwnParams(const Material &material) {
  if (material.scatter.any) return true;
  bool sized = false;
  BlockLaws::Visit(material.law, [&](auto law) { sized = decltype(law)::kNeedsSize; });
  if (!sized) return false;
  double other[kMaxParams] = {};  // a law may need the size only with some of its options
  DeriveBlock(material, material.property, 2, other);
  return !std::equal(other, other + kMaxParams, material.param);
}

static double Volume(const Mesh &mesh, PetscInt cell) {
  double x[kMaxCorners][3], volume[kMaxCorners];
  CellCorners(mesh, cell, x);
  return CornerVolumes(mesh.cell_shape[cell], x, volume);
}

/// The properties of a cell as they scatter.
static void CellProperties(const Mesh &mesh, const Material &m, PetscInt cell, double volume, double *property) {
  BlockLaws::Visit(m.law, [&](auto law) {
    const auto &list = decltype(law)::kProperties;
    for (std::size_t i = 0; i < list.size(); ++i) {
      const Scatter &scatter = m.scatter.of[i];
      const bool sized = scatter.kind == Scatter::kWeibull && m.scatter.volume > 0;
      const double factor = sized ? std::pow(m.scatter.volume / volume, 1 / scatter.spread) : 1;
      property[i] = ScatteredValue(scatter, list[i], m.property[i], factor, m.scatter.seed,
                                   static_cast<std::uint64_t>(mesh.cell_global[cell]));
    }
  });
}

void CellParams(const Mesh &mesh, const std::vector<Material> &materials, PetscInt cell, double *param) {
  const Material &m = materials[mesh.cell_region[cell]];
  if (!HasOwnParams(m)) {
    std::copy_n(m.param, kMaxParams, param);
    return;
  }
  double property[kMaxProperties] = {};
  const double volume = Volume(mesh, cell);
  CellProperties(mesh, m, cell, volume, property);
  std::fill_n(param, kMaxParams, 0.0);
  DeriveBlock(m, property, std::cbrt(volume), param);
}

void StartBlockParams(const std::vector<Material> &materials, Tables *tables) {
  for (const Material &m : materials)
    tables->block_param.insert(tables->block_param.end(), m.param, m.param + kMaxParams);
}

void AddOwnParams(const Mesh &mesh, const std::vector<Material> &materials, ElementTable *table, Tables *tables) {
  std::vector<char> own;
  for (const Material &m : materials) own.push_back(HasOwnParams(m));
  std::vector<double> &rows = tables->block_param;
  int last = -1;
  for (int e = 0; e < table->n_pad; ++e) {
    if (!own[table->region[e]]) continue;
    double param[kMaxParams];
    CellParams(mesh, materials, table->cell[std::min(e, table->n - 1)], param);
    if (last < 0 || !std::equal(param, param + kMaxParams, &rows[static_cast<std::size_t>(kMaxParams) * last])) {
      last = static_cast<int>(rows.size() / kMaxParams);
      rows.insert(rows.end(), param, param + kMaxParams);
    }
    table->material[e] = last;
  }
}

PetscErrorCode CheckOwnParams(const Mesh &mesh, const std::vector<Material> &materials) {
  PetscFunctionBeginUser;
  std::string failure;
  for (PetscInt c = 0; c < mesh.n_owned && failure.empty(); ++c) {
    const Material &m = materials[mesh.cell_region[c]];
    if (!m.scatter.any) continue;
    double property[kMaxProperties] = {};
    CellProperties(mesh, m, c, Volume(mesh, c), property);
    std::string wrong;
    BlockLaws::Visit(m.law, [&](auto law) { wrong = decltype(law)::Check(property); });
    if (wrong.empty()) continue;
    const double *x = mesh.X(mesh.Corners(c)[0]);
    char place[80];
    std::snprintf(place, sizeof place, "the element at (%g, %g, %g)", x[0], x[1], x[2]);
    failure =
        "region '" + mesh.regions[mesh.cell_region[c]] + "': as its properties scatter, in " + place + ": " + wrong;
  }
  PetscCall(CheckFailure(mesh.comm, failure));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CheckSizes(const Mesh &mesh, const std::vector<Material> &materials, std::vector<std::string> *remarks) {
  PetscFunctionBeginUser;
  std::vector<double> most(materials.size(), 0.0);  // size over the largest one
  std::vector<char> own;
  for (const Material &m : materials) own.push_back(HasOwnParams(m));
  for (PetscInt c = 0; c < mesh.n_owned; ++c) {
    const std::size_t region = static_cast<std::size_t>(mesh.cell_region[c]);
    if (!own[region]) continue;
    double property[kMaxProperties] = {}, largest = kPropertyInf;
    const double volume = Volume(mesh, c);
    CellProperties(mesh, materials[region], c, volume, property);
    BlockLaws::Visit(materials[region].law, [&](auto law) { largest = decltype(law)::LargestCell(property); });
    most[region] = std::max(most[region], std::cbrt(volume) / largest);
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, most.data(), static_cast<int>(most.size()), MPI_DOUBLE, MPI_MAX, mesh.comm));
  for (std::size_t i = 0; i < most.size(); ++i) {
    if (most[i] <= 1 + 1e-9) continue;
    char text[300];
    std::snprintf(
        text, sizeof text,
        "region %s: elements are up to %.3g times too large for their softening (V^(1/3) <= 2 G gf/(k - k_r)^2): "
        "they spend more than gf, and what they carry depends on the mesh",
        mesh.regions[i].c_str(), most[i]);
    remarks->push_back(text);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/// The number of a face for random numbers: its first cell has the lower global number on every rank.
static std::uint64_t FaceNumber(const Mesh &mesh, const Face &face) {
  return static_cast<std::uint64_t>(mesh.cell_global[face.cell[0]]) * kMaxFaces + face.local[0];
}

bool HasOwnParams(const Joint &joint) { return joint.scatter.any || !joint.of_sides.empty(); }

void FaceProperties(const Mesh &mesh, const Joint &joint, const Face &face, double *property) {
  const double *mean = joint.property;
  if (!joint.of_sides.empty()) mean = joint.of_sides.at(SidesOf(mesh, face)).data();
  std::copy_n(mean, kMaxProperties, property);
  if (!joint.scatter.any) return;
  JointLaws::Visit(joint.law, [&](auto law) {
    const auto &list = decltype(law)::kProperties;
    for (std::size_t i = 0; i < list.size(); ++i)
      property[i] =
          ScatteredValue(joint.scatter.of[i], list[i], mean[i], 1, joint.scatter.seed, FaceNumber(mesh, face));
    decltype(law)::Adjust(property);
  });
}

void FaceParams(const Mesh &mesh, const Joint &joint, const Face &face, double *param) {
  double property[kMaxProperties];
  FaceProperties(mesh, joint, face, property);
  std::fill_n(param, kMaxParams, 0.0);
  DeriveJoint(joint, property, param);
}

void ScatterStiffness(const Mesh &mesh, const Joint &joint, const Face &face, double *kn, double *ks) {
  static const Property list[2] = {{"kn", "Pa/m", 0, kPropertyInf, kPropertyOpen},
                                   {"ks", "Pa/m", 0, kPropertyInf, kPropertyOpen}};
  double *value[2] = {kn, ks};
  for (int i = 0; i < 2; ++i)
    *value[i] =
        ScatteredValue(joint.stiffness_scatter[i], list[i], *value[i], 1, joint.scatter.seed, FaceNumber(mesh, face));
}

}  // namespace cdem
