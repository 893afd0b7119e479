#include "io/fields.hpp"

#include "core/error.hpp"
#include "core/options.hpp"
#include "mesh/interfaces.hpp"

#include <algorithm>
#include <cmath>

namespace cdem {

static const std::vector<std::string> kFields = {
    "displacement", "velocity", "stress",    "region",         "opening", "slip",        "normal_stress",
    "shear_stress", "state",    "interface", "plastic_strain", "broken",  "broken_time", "damage"};

PetscErrorCode FieldOutput::Create(MPI_Comm comm, Options &options) {
  PetscFunctionBeginUser;
  comm_ = comm;
  PetscCall(options.Names("output_fields", &wanted_));
  for (const std::string &name : wanted_)
    CdemCheck(Mesh::Find(kFields, name) >= 0, comm, "-output_fields: there is no field '%s'; the fields are: %s",
              name.c_str(), Joined(kFields).c_str());
  PetscFunctionReturn(PETSC_SUCCESS);
}

bool FieldOutput::Wants(const char *field) const { return wanted_.empty() || Mesh::Find(wanted_, field) >= 0; }

void FieldOutput::Open(const std::string &dir, const Mesh &mesh, const Nodes &nodes, const Tables &tables,
                       const std::vector<int> &face_interface, const LawFields &of_laws) {
  dir_ = dir;
  of_laws_ = of_laws;
  mesh_ = &mesh;
  nodes_ = &nodes;
  tables_ = &tables;
  face_interface_ = &face_interface;
}

PetscErrorCode FieldOutput::WriteMesh(const std::vector<char> &removed, int number) {
  PetscFunctionBeginUser;
  const Mesh &mesh = *mesh_;
  const Nodes &nodes = *nodes_;
  // Cells of a rank may have ghost nodes: their global numbers come from the owners.
  std::vector<std::int64_t> global(nodes.global);
  global.resize(nodes.n_local);
  if (nodes.halo) {
    PetscCall(
        PetscSFBcastBegin(nodes.halo, MPI_INT64_T, nodes.global.data(), global.data() + nodes.n_owned, MPI_REPLACE));
    PetscCall(
        PetscSFBcastEnd(nodes.halo, MPI_INT64_T, nodes.global.data(), global.data() + nodes.n_owned, MPI_REPLACE));
  }
  VtkMesh vtk;
  vtk.point_global = nodes.global;
  vtk.points.assign(tables_->x.begin(), tables_->x.begin() + 3 * static_cast<std::ptrdiff_t>(nodes.n_owned));
  vtk.cell_start.push_back(0);
  std::vector<PetscInt> there(mesh.n_owned);
  std::vector<std::int64_t> row;
  std::int64_t n_live;
  for (PetscInt c = 0; c < mesh.n_owned; ++c) there[c] = !IsRemoved(mesh, removed, c);
  PetscCall(GlobalOffsets(mesh, there, &row, &n_live));
  live_.clear();
  region_.clear();
  for (PetscInt c = 0; c < mesh.n_owned; ++c) {
    if (!there[c]) continue;
    live_.push_back(c);
    const ShapeInfo &info = Info(mesh.cell_shape[c]);
    vtk.cell_global.push_back(row[c]);
    vtk.cell_type.push_back(static_cast<std::uint8_t>(info.vtk_type));
    for (int a = 0; a < info.corners; ++a) vtk.cell_points.push_back(global[nodes.Corners(c)[a]]);
    vtk.cell_start.push_back(static_cast<int>(vtk.cell_points.size()));
    region_.push_back(mesh.cell_region[c]);
  }
  PetscCall(blocks_.Create(comm_, dir_, "fields", vtk, number));
  PetscCall(WriteInterfaceMesh(removed, number));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode FieldOutput::Continue(EarlierRun *earlier) {
  PetscFunctionBeginUser;
  PetscCall(blocks_.Continue(earlier->Frames("fields")));
  if (with_interfaces_) PetscCall(interfaces_.Continue(earlier->Frames("interfaces")));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode FieldOutput::WriteInterfaceMesh(const std::vector<char> &removed, int number) {
  PetscFunctionBeginUser;
  const Mesh &mesh = *mesh_;
  const std::vector<int> &face_interface = *face_interface_;
  interface_.clear();
  face_nodes_.clear();
  row_of_face_.assign(mesh.faces.size(), -1);
  std::vector<PetscInt> points(mesh.n_owned, 0), cells(mesh.n_owned, 0);
  VtkMesh vtk;
  vtk.cell_start.push_back(0);
  // faces are sorted by their first cell, so the rows of a cell follow each other
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    const Face &face = mesh.faces[f];
    if (face_interface[f] < 0 || face.cell[1] < 0 || face.cell[0] >= mesh.n_owned) continue;
    if (IsRemoved(mesh, removed, face.cell[0]) || IsRemoved(mesh, removed, face.cell[1])) continue;
    const int size = Info(mesh.cell_shape[face.cell[0]]).face_size[face.local[0]];
    row_of_face_[f] = static_cast<int>(interface_.size());
    interface_.push_back(face_interface[f]);
    for (int j = 0; j < size; ++j) {
      const PetscInt node = FaceNode(mesh, *nodes_, face, j, 0);
      face_nodes_.push_back(node);
      for (int k = 0; k < 3; ++k) vtk.points.push_back(tables_->x[3 * static_cast<std::size_t>(node) + k]);
      vtk.point_global.push_back(points[face.cell[0]]++);  // within the cell; the cell's start is added below
    }
    vtk.cell_global.push_back(cells[face.cell[0]]++);
    vtk.cell_type.push_back(size == 4 ? 9 : 5);
    vtk.cell_start.push_back(static_cast<int>(vtk.point_global.size()));
  }
  std::vector<std::int64_t> point_start, cell_start;
  std::int64_t n_points, n_cells;
  PetscCall(GlobalOffsets(mesh, points, &point_start, &n_points));
  PetscCall(GlobalOffsets(mesh, cells, &cell_start, &n_cells));
  with_interfaces_ = n_cells > 0;
  if (!with_interfaces_) PetscFunctionReturn(PETSC_SUCCESS);
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    const int row = row_of_face_[f];
    if (row < 0) continue;
    const PetscInt cell = mesh.faces[f].cell[0];
    vtk.cell_global[row] += cell_start[cell];
    for (int p = vtk.cell_start[row]; p < vtk.cell_start[row + 1]; ++p) vtk.point_global[p] += point_start[cell];
  }
  vtk.cell_points = vtk.point_global;
  PetscCall(interfaces_.Create(comm_, dir_, "interfaces", vtk, number));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode FieldOutput::WriteInterfaces(PetscInt step, double time, const double *u, const SpringResults &springs,
                                            const std::vector<SpringHistory> &history) {
  PetscFunctionBeginUser;
  const std::size_t n = interface_.size();
  std::vector<double> opening(n, 0), slip(n, 0), normal(n, 0), shear(n, 0), state(n, 0), area(n, 0), count(n, 0),
      damage(n, 0);
  std::vector<double> shear_force(3 * n, 0), displacement;
  for (std::size_t g = 0; g < tables_->springs.size(); ++g) {
    const SpringTable &t = tables_->springs[g];
    for (int i = 0; i < t.n; ++i) {
      const int row = row_of_face_[t.face[i]];
      if (row < 0) continue;
      double d[3], unit[3], force[3];
      for (int k = 0; k < 3; ++k) {
        const std::size_t at = static_cast<std::size_t>(k) * t.n_pad + i;
        d[k] = u[3 * static_cast<std::size_t>(t.b[i]) + k] - u[3 * static_cast<std::size_t>(t.a[i]) + k];
        unit[k] = t.normal[at];
        force[k] = springs.force[g][at];
      }
      const double d_n = Dot(unit, d), f_n = Dot(unit, force);
      double d_s2 = 0;
      for (int k = 0; k < 3; ++k) {
        d_s2 += (d[k] - d_n * unit[k]) * (d[k] - d_n * unit[k]);
        shear_force[3 * row + k] += force[k] - f_n * unit[k];
      }
      opening[row] += d_n * t.area[i];
      slip[row] += std::sqrt(d_s2) * t.area[i];
      normal[row] -= f_n;  // the spring pushes b along n in compression; stress is positive in tension
      area[row] += t.area[i];
      count[row] += 1;
      state[row] += (springs.state[g][i] & kCohesionLost) != 0;
      if (of_laws_.damage) damage[row] += DamageOf(t, history[g], springs.state[g][i], i) * t.area[i];
    }
  }
  for (std::size_t row = 0; row < n; ++row) {
    if (area[row] <= 0) continue;  // a face whose corners all share their nodes carries no spring
    opening[row] /= area[row];
    slip[row] /= area[row];
    normal[row] /= area[row];
    shear[row] = std::sqrt(Dot(&shear_force[3 * row], &shear_force[3 * row])) / area[row];
    state[row] /= count[row];
    damage[row] /= area[row];
  }
  for (PetscInt node : face_nodes_)
    for (int k = 0; k < 3; ++k) displacement.push_back(u[3 * static_cast<std::size_t>(node) + k]);
  std::vector<VtkField> fields = {{"displacement", true, 3, displacement.data()},
                                  {"opening", false, 1, opening.data()},
                                  {"slip", false, 1, slip.data()},
                                  {"normal_stress", false, 1, normal.data()},
                                  {"shear_stress", false, 1, shear.data()},
                                  {"state", false, 1, state.data()},
                                  {"interface", false, 1, interface_.data()}};
  if (of_laws_.damage) fields.push_back({"damage", false, 1, damage.data()});
  fields.erase(std::remove_if(fields.begin(), fields.end(), [&](const VtkField &f) { return !Wants(f.name.c_str()); }),
               fields.end());
  PetscCall(interfaces_.WriteFrame(step, time, fields));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/// The rows [owned cells][components] of the cells that are there.
std::vector<double> FieldOutput::OfLive(const double *values, int components) const {
  std::vector<double> live;
  live.reserve(live_.size() * static_cast<std::size_t>(components));
  for (PetscInt c : live_)
    live.insert(live.end(), values + static_cast<std::ptrdiff_t>(components) * c,
                values + static_cast<std::ptrdiff_t>(components) * (c + 1));
  return live;
}

PetscErrorCode FieldOutput::Write(PetscInt step, double time, const double *u, const std::vector<double> &v_now,
                                  const std::vector<double> &stress, const SpringResults &springs,
                                  const Histories &history) {
  PetscFunctionBeginUser;
  ElementFields of_history;
  FillElementFields(*tables_, static_cast<int>(mesh_->n_owned), history.elements, of_laws_, &of_history);
  const std::vector<double> live_stress = OfLive(stress.data(), 6);
  std::vector<VtkField> fields = {{"displacement", true, 3, u},
                                  {"velocity", true, 3, v_now.data()},
                                  {"stress", false, 6, live_stress.data()},
                                  {"region", false, 1, region_.data()}};
  for (std::vector<double> *values : {&of_history.plastic_strain, &of_history.broken, &of_history.broken_time})
    if (!values->empty()) *values = OfLive(values->data(), 1);
  if (of_laws_.plastic) fields.push_back({"plastic_strain", false, 1, of_history.plastic_strain.data()});
  if (of_laws_.broken) {
    fields.push_back({"broken", false, 1, of_history.broken.data()});
    fields.push_back({"broken_time", false, 1, of_history.broken_time.data()});
  }
  fields.erase(std::remove_if(fields.begin(), fields.end(), [&](const VtkField &f) { return !Wants(f.name.c_str()); }),
               fields.end());
  PetscCall(blocks_.WriteFrame(step, time, fields));
  if (with_interfaces_) PetscCall(WriteInterfaces(step, time, u, springs, history.springs));
  PetscFunctionReturn(PETSC_SUCCESS);
}

}  // namespace cdem
