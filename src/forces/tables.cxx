#include "forces/tables.hpp"

#include "core/error.hpp"
#include "core/lanes.hpp"
#include "forces/dilatation.hpp"
#include "forces/form_check.hpp"
#include "forces/params.hpp"
#include "mesh/geometry.hpp"
#include "physics/elements.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>

namespace cdem {

PetscInt FaceNode(const Mesh &mesh, const Nodes &nodes, const Face &face, int j, int side) {
  if (side == 0) return nodes.Corners(face.cell[0])[Info(mesh.cell_shape[face.cell[0]]).face[face.local[0]][j]];
  int c0, c1;
  FaceCornerPair(mesh, face, j, &c0, &c1);
  return nodes.Corners(face.cell[1])[c1];
}

std::vector<int> SpringCorners(const Mesh &mesh, const Nodes &nodes, const SpringTable &table) {
  std::vector<int> corner(table.n, -1);
  for (int i = 0; i < table.n; ++i) {
    const Face &face = mesh.faces[table.face[i]];
    const int size = Info(mesh.cell_shape[face.cell[0]]).face_size[face.local[0]];
    for (int j = 0; j < size && corner[i] < 0; ++j)
      if (FaceNode(mesh, nodes, face, j, 0) == table.a[i] && FaceNode(mesh, nodes, face, j, 1) == table.b[i])
        corner[i] = j;
  }
  return corner;
}

namespace {

/// Cells with a complete node list, in ascending global number.
std::vector<PetscInt> ActiveCells(const Mesh &mesh, const Nodes &nodes, const std::vector<char> &removed) {
  std::vector<PetscInt> cells;
  for (PetscInt c : SortedByGlobal(mesh)) {
    if (IsRemoved(mesh, removed, c)) continue;
    const PetscInt *n = nodes.Corners(c);
    const int corners = Info(mesh.cell_shape[c]).corners;
    const bool complete = std::all_of(n, n + corners, [](PetscInt i) { return i >= 0; });
    const bool touches = std::any_of(n, n + corners, [&](PetscInt i) { return i >= 0 && i < nodes.n_owned; });
    if (complete && (touches || c < mesh.n_owned)) cells.push_back(c);
  }
  return cells;
}

/// Which of some cells the form for parallelepipeds serves: one flag each; none where fewer than half of the cells that
/// could are, since a table of few elements costs more than it gains. The same on all ranks (collective).
PetscErrorCode FindAffine(const Mesh &mesh, const std::vector<Material> &materials, const std::vector<PetscInt> &cells,
                          std::vector<char> *affine) {
  PetscFunctionBeginUser;
  affine->assign(cells.size(), 0);
  double count[2] = {0, 0};  // those that it serves, those that could be
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const PetscInt c = cells[i];
    const Material &m = materials[mesh.cell_region[c]];
    bool may = false;
    if (mesh.cell_shape[c] == Shape::kHex && m.element == HexAffine::kName)
      BlockLaws::Visit(m.law, [&](auto law) { may = kFits<HexAffine, decltype(law)>; });
    if (!may) continue;
    double x[8][3];
    CellCorners(mesh, c, x);
    (*affine)[i] = HexAffine::Serves(x);
    if (c < mesh.n_owned) count[0] += (*affine)[i], count[1] += 1;
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, count, 2, MPI_DOUBLE, MPI_SUM, mesh.comm));
  if (2 * count[0] < count[1]) affine->assign(cells.size(), 0);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode BuildElements(const Mesh &mesh, const Nodes &nodes, const std::vector<Material> &materials,
                             const std::vector<char> &removed, Tables *tables) {
  PetscFunctionBeginUser;
  const std::vector<PetscInt> active = ActiveCells(mesh, nodes, removed);
  std::vector<char> affine;
  PetscCall(FindAffine(mesh, materials, active, &affine));
  // one table for each shape, form and law that this rank has
  std::map<std::array<int, 3>, std::vector<int>> groups;
  for (std::size_t i = 0; i < active.size(); ++i) {
    const PetscInt c = active[i];
    const Material &m = materials[mesh.cell_region[c]];
    const Shape shape = mesh.cell_shape[c];
    const int form = affine[i] ? HexForms::Number<HexAffine>() : FormNumber(shape, m.element);
    groups[{static_cast<int>(shape), form, m.law}].push_back(static_cast<int>(c));
  }
  for (auto &[key, cells] : groups) {
    ElementTable t;
    t.shape = static_cast<Shape>(key[0]);
    t.form = key[1];
    t.law = key[2];
    t.corners = Info(t.shape).corners;
    t.cell = std::move(cells);
    VisitBlock(t.shape, t.form, t.law, [&](auto form, auto law) {
      t.states = decltype(form)::kPoints * decltype(law)::kState;
      t.breaks = kBreaks<decltype(law)>;
      t.judged = decltype(law)::kJudgesMean;
      t.averages = decltype(form)::kAverages;
    });
    t.n = static_cast<int>(t.cell.size());
    t.n_pad = Padded(t.n);
    t.node.resize(static_cast<std::size_t>(t.corners) * t.n_pad);
    t.material.resize(t.n_pad);
    t.region.resize(t.n_pad);
    for (int e = 0; e < t.n_pad; ++e) {
      const int c = t.cell[std::min(e, t.n - 1)];
      t.material[e] = t.region[e] = mesh.cell_region[c];
      for (int a = 0; a < t.corners; ++a)
        t.node[static_cast<std::size_t>(a) * t.n_pad + e] = static_cast<int>(nodes.Corners(c)[a]);
    }
    AddOwnParams(mesh, materials, &t, tables);
    t.corner_start = tables->n_slots;
    tables->n_slots += static_cast<std::size_t>(t.corners) * t.n_pad;
    tables->elements.push_back(std::move(t));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/// Row-sum masses, summed in ascending global number of the cells. Nodes whose elements have all been removed have none.
PetscErrorCode BuildMass(const Mesh &mesh, const Nodes &nodes, const std::vector<Material> &materials, bool removals,
                         Tables *tables) {
  PetscFunctionBeginUser;
  std::vector<char> alive(nodes.n_owned, !removals);
  tables->mass.assign(nodes.n_owned, 0.0);
  for (const ElementTable &t : tables->elements)
    for (int e = 0; e < t.n; ++e) {
      double x[8][3], volume[8];
      CellCorners(mesh, t.cell[e], x);
      CornerVolumes(t.shape, x, volume);
      for (int a = 0; a < t.corners; ++a) {
        const int node = t.node[static_cast<std::size_t>(a) * t.n_pad + e];
        if (node >= nodes.n_owned) continue;
        tables->mass[node] += materials[t.region[e]].density * volume[a];
        alive[node] = 1;
      }
    }
  tables->inverse_mass.assign(nodes.n_owned, 0.0);
  for (PetscInt i = 0; i < nodes.n_owned; ++i) {
    if (!alive[i]) continue;
    const double *x = mesh.X(nodes.vertex[i]);
    CdemCheck(tables->mass[i] > 0, PETSC_COMM_SELF,
              "the node at (%g, %g, %g) has mass %g kg: its elements are degenerate", x[0], x[1], x[2],
              tables->mass[i]);
    tables->inverse_mass[i] = 1.0 / tables->mass[i];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/// Stiffness per area of a joint at a face [Pa/m]: given, or a multiple of the softer side's over the centre distance.
void FaceStiffness(const Mesh &mesh, const std::vector<Material> &materials, const Joint &joint, const Face &face,
                   double *kn, double *ks) {
  *kn = joint.kn, *ks = joint.ks;
  if (*kn > 0 && *ks > 0) return;
  double m0[kMaxParams], m1[kMaxParams];  // lambda and mu come first
  CellParams(mesh, materials, face.cell[0], m0);
  CellParams(mesh, materials, face.cell[1], m1);
  const double b_over_h = joint.stiffness_factor / CentreDistance(mesh, face);
  if (*kn < 0) *kn = b_over_h * std::min(m0[0] + 2 * m0[1], m1[0] + 2 * m1[1]);
  if (*ks < 0) *ks = b_over_h * std::min(m0[1], m1[1]);
}

/// A row of parameters for a face that has its own; faces that follow each other share equal ones. [in] first: the rows of
/// the interfaces come before it.
int AddFaceRow(const Mesh &mesh, const Joint &joint, const Face &face, std::size_t first, Tables *tables) {
  double param[kMaxParams];
  FaceParams(mesh, joint, face, param);
  const std::size_t rows = tables->joint_param.size() / kMaxParams;
  if (rows > first && std::equal(param, param + kMaxParams, tables->joint_param.end() - kMaxParams))
    return static_cast<int>(rows) - 1;
  tables->joint_param.insert(tables->joint_param.end(), param, param + kMaxParams);
  return static_cast<int>(tables->joint_param.size() / kMaxParams) - 1;
}

void BuildSprings(const Mesh &mesh, const Nodes &nodes, const std::vector<int> &face_interface,
                  const std::vector<Material> &materials, const std::vector<Joint> &joints,
                  const std::vector<char> &removed, Tables *tables) {
  for (int law = 0; law < JointLaws::kCount; ++law) {
    SpringTable t;
    t.law = law;
    std::vector<double> normal;
    for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
      const Face &face = mesh.faces[f];
      if (face_interface[f] < 0 || face.cell[1] < 0 || joints[face_interface[f]].law != law) continue;
      if (IsRemoved(mesh, removed, face.cell[0]) || IsRemoved(mesh, removed, face.cell[1])) continue;
      const int size = Info(mesh.cell_shape[face.cell[0]]).face_size[face.local[0]];
      const Joint &joint = joints[face_interface[f]];
      double x[4][3], area[4][3], kn = 0, ks = 0;
      int row = face_interface[f];
      bool measured = false;
      for (int j = 0; j < size; ++j) {
        const PetscInt a = FaceNode(mesh, nodes, face, j, 0), b = FaceNode(mesh, nodes, face, j, 1);
        const bool counted = face.cell[0] < mesh.n_owned;
        if (a < 0 || b < 0 || a == b || (!counted && a >= nodes.n_owned && b >= nodes.n_owned)) continue;
        if (!measured) {
          FaceCorners(mesh, face, x);
          FaceVectors(size, x, area);
          FaceStiffness(mesh, materials, joint, face, &kn, &ks);
          ScatterStiffness(mesh, joint, face, &kn, &ks);
          if (HasOwnParams(joint)) row = AddFaceRow(mesh, joint, face, joints.size(), tables);
          measured = true;
        }
        const double size_j = std::sqrt(Dot(area[j], area[j]));
        t.a.push_back(static_cast<int>(a));
        t.b.push_back(static_cast<int>(b));
        t.area.push_back(size_j);
        t.kn.push_back(kn * size_j);
        t.ks.push_back(ks * size_j);
        t.joint.push_back(row);
        t.interface.push_back(face_interface[f]);
        if (tables->releases)
          for (PetscInt c : face.cell)
            t.cell.push_back(materials[mesh.cell_region[c]].releases ? static_cast<int>(c) : -1);
        t.face.push_back(static_cast<int>(f));
        t.counted.push_back(counted);
        for (int k = 0; k < 3; ++k) normal.push_back(area[j][k] / size_j);
      }
    }
    if (t.a.empty()) continue;
    t.n = static_cast<int>(t.a.size());
    t.n_pad = Padded(t.n);
    for (auto *v : {&t.a, &t.b, &t.joint}) v->resize(t.n_pad, v->back());
    t.counted.resize(t.n_pad, 0);
    for (auto *v : {&t.area, &t.kn, &t.ks}) v->resize(t.n_pad, v->back());
    t.normal.resize(3 * static_cast<std::size_t>(t.n_pad));
    for (int i = 0; i < t.n_pad; ++i)
      for (int k = 0; k < 3; ++k)
        t.normal[static_cast<std::size_t>(k) * t.n_pad + i] =
            normal[3 * static_cast<std::size_t>(std::min(i, t.n - 1)) + k];
    JointLaws::Visit(law, [&](auto l) {
      if (!decltype(l)::kHistory) return;
      t.n_state = decltype(l)::kState;
      t.state.assign(t.n_pad, 0);
      for (int i = 0; i < t.n; ++i)
        if (joints[t.interface[i]].broken) t.state[i] = kTensionLost | kCohesionLost;
    });
    t.force_start = tables->n_slots;
    tables->n_slots += t.n_pad;
    tables->springs.push_back(std::move(t));
  }
}

}  // namespace

double CentreDistance(const Mesh &mesh, const Face &face) {
  double c0[3], c1[3], d2 = 0;
  CellCentre(mesh, face.cell[0], c0);
  CellCentre(mesh, face.cell[1], c1);
  for (int k = 0; k < 3; ++k) d2 += (c1[k] - c0[k]) * (c1[k] - c0[k]);
  return std::sqrt(d2);
}

PetscErrorCode BuildTables(const Mesh &mesh, const Nodes &nodes, const std::vector<int> &face_interface,
                           const std::vector<Material> &materials, const std::vector<Joint> &joints,
                           const std::vector<char> &removed, Tables *tables) {
  PetscFunctionBeginUser;
  CdemCheck(nodes.n_local < std::numeric_limits<int>::max() / 3, PETSC_COMM_SELF,
            "a rank has %lld nodes: more than it can count; use more ranks", static_cast<long long>(nodes.n_local));
  tables->comm = mesh.comm;
  tables->n_owned = static_cast<int>(nodes.n_owned);
  tables->n_local = static_cast<int>(nodes.n_local);
  tables->halo = nodes.halo;
  tables->x.resize(3 * static_cast<std::size_t>(nodes.n_local));
  for (PetscInt i = 0; i < nodes.n_local; ++i) std::copy_n(mesh.X(nodes.vertex[i]), 3, &tables->x[3 * i]);
  PetscCall(CheckOwnParams(mesh, materials));
  StartBlockParams(materials, tables);
  for (const Joint &j : joints) tables->joint_param.insert(tables->joint_param.end(), j.param, j.param + kMaxParams);
  PetscCall(BuildElements(mesh, nodes, materials, removed, tables));
  PetscCall(BuildAveraging(mesh, materials, tables));
  PetscCall(BuildMass(mesh, nodes, materials, !removed.empty(), tables));
  for (const Material &m : materials) tables->releases = tables->releases || m.releases;
  tables->n_cells = static_cast<int>(mesh.cell_global.size());
  tables->cells = mesh.cell_sf;
  BuildSprings(mesh, nodes, face_interface, materials, joints, removed, tables);
  CdemCheck(tables->n_slots < static_cast<std::size_t>(std::numeric_limits<int>::max()), PETSC_COMM_SELF,
            "a rank has %zu element corners and springs: more than it can count; use more ranks", tables->n_slots);
  PetscFunctionReturn(PETSC_SUCCESS);
}

}  // namespace cdem
