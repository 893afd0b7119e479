#include "loads/boundary.hpp"

#include "core/error.hpp"
#include "core/options.hpp"
#include "core/small.hpp"
#include "loads/quiet.hpp"
#include "loads/supports.hpp"
#include "mesh/geometry.hpp"
#include "mesh/interfaces.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

namespace cdem {

namespace {

/// Components named by a word of x, y, z.
PetscErrorCode ParseComponents(MPI_Comm comm, const OptionKey &key, const std::string &word, bool wanted[3]) {
  PetscFunctionBeginUser;
  std::fill_n(wanted, 3, false);
  for (char c : word) {
    CdemCheck(c >= 'x' && c <= 'z' && !wanted[c - 'x'], comm,
              "%s is '%s'; it is made of the letters x, y, z, each once", Options::Spelled(key).c_str(), word.c_str());
    wanted[c - 'x'] = true;
  }
  CdemCheck(!word.empty(), comm, "%s is empty; it is made of the letters x, y, z", Options::Spelled(key).c_str());
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode Place(const Mesh &mesh, Options &options, Boundary *b) {
  PetscFunctionBeginUser;
  const OptionKey key("boundary", b->name, "on");
  std::string on = b->name;
  PetscCall(options.Text(key, &on));
  b->surface = Mesh::Find(mesh.surfaces, on);
  b->point_set = Mesh::Find(mesh.point_sets, on);
  CdemCheck(b->surface >= 0 || b->point_set >= 0, mesh.comm,
            "boundary '%s': the mesh has no surface, line or point '%s' (give %s); surfaces: %s; lines and points: %s",
            b->name.c_str(), on.c_str(), Options::Spelled(key).c_str(), Joined(mesh.surfaces).c_str(),
            Joined(mesh.point_sets).c_str());
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ReadBoundary(const Mesh &mesh, Options &options, const std::vector<std::string> &table_names,
                            Boundary *b) {
  PetscFunctionBeginUser;
  auto key = [&](const char *k) { return OptionKey("boundary", b->name, k); };
  PetscCall(Place(mesh, options, b));
  std::string word;
  bool set, wanted[3];
  PetscCall(options.Flag(key("quiet"), &b->quiet));
  CdemCheck(!b->quiet || b->point_set < 0, mesh.comm,
            "boundary '%s': quiet needs a surface, and '%s' is a line or a point: its dashpots stand on faces",
            b->name.c_str(), mesh.point_sets[b->point_set].c_str());
  bool any = b->quiet;
  PetscCall(options.Text(key("fix"), &word, &set));
  bool with_wave = false;
  if (b->quiet) PetscCall(ReadRelease(options, b, &with_wave));
  CdemCheck(!b->quiet || !set || b->lets_go, mesh.comm,
            "boundary '%s' is quiet and has %s: what is fixed cannot absorb; give one, or fix those components on a "
            "boundary of another name, or let a later stage make it quiet",
            b->name.c_str(), Options::Spelled(key("fix")).c_str());
  if (set && !b->quiet) {
    PetscCall(ParseComponents(mesh.comm, key("fix"), word, wanted));
    for (int k = 0; k < 3; ++k)
      if (wanted[k]) b->kind[k] = kVelocity;
    any = true;
  }
  bool only[3] = {true, true, true}, components = false, moved[2];
  PetscCall(options.Text(key("components"), &word, &components));
  if (components) PetscCall(ParseComponents(mesh.comm, key("components"), word, only));
  const std::pair<const char *, int> motions[] = {{"velocity", kVelocity}, {"displacement", kDisplacement}};
  double value[2][3];
  for (int m = 0; m < 2; ++m) PetscCall(options.Reals(key(motions[m].first), 3, value[m], &moved[m]));
  CdemCheck(!(moved[0] && moved[1]), mesh.comm, "boundary '%s' prescribes both velocity and displacement: give one",
            b->name.c_str());
  CdemCheck(!b->quiet || !moved[1] || b->lets_go, mesh.comm,
            "boundary '%s' is quiet and has a displacement: an incoming wave is given by its velocity",
            b->name.c_str());
  if (with_wave) {
    b->wave = true;
    for (int k = 0; k < 3; ++k) b->incoming[k] = only[k] ? value[0][k] : 0;
  }
  for (int m = 0; m < 2; ++m) {
    if (!moved[m] || b->quiet) continue;
    any = true;
    CdemCheck(b->kind[0] == kFree || b->kind[1] == kFree || b->kind[2] == kFree, mesh.comm,
              "boundary '%s' fixes all components and prescribes a %s: give one", b->name.c_str(), motions[m].first);
    for (int k = 0; k < 3; ++k) {
      const bool fixed = b->kind[k] == kVelocity;
      CdemCheck(!(fixed && only[k] && (components || value[m][k] != 0)), mesh.comm,
                "boundary '%s' fixes component %c and prescribes its %s: give one", b->name.c_str(), 'x' + k,
                motions[m].first);
      if (only[k] && !fixed) b->kind[k] = motions[m].second, b->value[k] = value[m][k];
    }
  }
  CdemCheck(!components || moved[0] || moved[1], mesh.comm,
            "%s: there is no velocity or displacement on boundary '%s' whose components it could choose",
            Options::Spelled(key("components")).c_str(), b->name.c_str());
  bool traction, pressure, gradient;
  PetscCall(options.Reals(key("traction"), 3, b->traction, &traction));
  PetscCall(options.Real(key("pressure"), &b->pressure, &pressure));
  double per_metre = 0;
  PetscCall(options.Real(key("gradient_z"), &per_metre, &gradient));
  CdemCheck(!gradient || (pressure != traction), mesh.comm,
            "boundary '%s': gradient_z belongs to a pressure or to a traction; give one of them", b->name.c_str());
  const double size = std::sqrt(Dot(b->traction, b->traction));
  CdemCheck(!gradient || !traction || size > 0, mesh.comm,
            "boundary '%s': gradient_z goes along the traction, which is zero and has no direction", b->name.c_str());
  if (gradient && traction) b->traction_gradient_z = per_metre / size;
  if (gradient && pressure) b->pressure_gradient_z = per_metre;
  b->loaded = traction || pressure;
  CdemCheck(!b->loaded || b->surface >= 0, mesh.comm, "boundary '%s': traction and pressure need a surface",
            b->name.c_str());
  CdemCheck(any || b->loaded, mesh.comm,
            "boundary '%s' is declared but does nothing: give fix, displacement, velocity, traction, pressure or quiet",
            b->name.c_str());
  PetscCall(options.Text(key("table"), &word, &set));
  CdemCheck(!set || !b->quiet || b->wave || b->loaded, mesh.comm,
            "%s: boundary '%s' is only quiet, there is nothing that a table could multiply; give a velocity (of the "
            "incoming wave), traction or pressure, or leave the table out",
            Options::Spelled(key("table")).c_str(), b->name.c_str());
  if (set) {
    const auto it = std::find(table_names.begin() + 1, table_names.end(), word);
    CdemCheck(it != table_names.end(), mesh.comm, "%s: there is no table '%s'; declared with -tables: %s",
              Options::Spelled(key("table")).c_str(), word.c_str(),
              Joined({table_names.begin() + 1, table_names.end()}).c_str());
    b->table = static_cast<int>(it - table_names.begin());
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/// What one node collects before it becomes a row.
struct Row {
  int kind[3] = {kFree, kFree, kFree}, table[3] = {0, 0, 0}, watch = -1;
  double value[3] = {0, 0, 0};
  std::map<std::pair<int, bool>, std::array<double, 3>> load;  // by table; apart: of waves that come in
  bool quiet = false;
  std::array<double, 6> dashpot{};
};

void Prescribe(const Boundary &b, Row &row) {
  for (int k = 0; k < 3; ++k)
    if (b.kind[k] != kFree) row.kind[k] = b.kind[k], row.value[k] = b.value[k], row.table[k] = b.table;
}

/// Adds the integral of N_j t dA of one face to its nodes on a side; pressure pushes against the outward normal.
void LoadFace(const Mesh &mesh, const Nodes &nodes, const Boundary &b, const Face &face, int side,
              std::map<PetscInt, Row> &rows) {
  const double outward = side == 0 ? 1 : -1;  // the face's own normal points out of cell[0]
  double x[4][3];
  const int size = FaceCorners(mesh, face, x);
  FacePoint points[4];
  const int n = FacePoints(size, x, points);
  for (int j = 0; j < size; ++j) {
    const PetscInt node = FaceNode(mesh, nodes, face, j, side);
    if (node < 0 || node >= nodes.n_owned) continue;
    std::array<double, 3> &load = rows[node].load[{b.table, false}];
    for (int g = 0; g < n; ++g) {
      double z = 0;
      for (int i = 0; i < size; ++i) z += points[g].shape[i] * x[i][2];
      const double area = std::sqrt(Dot(points[g].area, points[g].area));
      const double along = 1 + b.traction_gradient_z * z, p = b.pressure + b.pressure_gradient_z * z;
      for (int k = 0; k < 3; ++k)
        load[k] += points[g].shape[j] * (b.traction[k] * along * area - p * outward * points[g].area[k]);
    }
  }
}

/// Adds the dashpots of one face to its nodes, and the load 2 C v_in of the wave that comes in.
void QuietFace(const Mesh &mesh, const Nodes &nodes, const std::vector<Material> &materials, const Boundary &b,
               const Face &face, int side, std::map<PetscInt, Row> &rows) {
  Dashpot dashpots[4];
  const int n = FaceDashpots(mesh, nodes, materials, face, side, dashpots);
  for (const Dashpot *d = dashpots; d < dashpots + n; ++d) {
    if (d->node < 0 || d->node >= nodes.n_owned) continue;
    Row &row = rows[d->node];
    row.quiet = true;
    for (int k = 0; k < 6; ++k) row.dashpot[k] += d->c[k];
    if (!b.wave) continue;
    double force[3];
    Apply(d->c, b.incoming, force);
    std::array<double, 3> &load = row.load[{b.table, true}];
    for (int k = 0; k < 3; ++k) load[k] += 2 * force[k];
  }
}

/// The one side of a face that is still there, or -1: both are, or none.
int OuterSide(const Mesh &mesh, const std::vector<char> &removed, const Face &face) {
  const bool first = !IsRemoved(mesh, removed, face.cell[0]);
  const bool second = face.cell[1] >= 0 && !IsRemoved(mesh, removed, face.cell[1]);
  return first == second ? -1 : first ? 0 : 1;
}

/// Loads and dashpots have one side to act on: it must lie on the outer boundary.
PetscErrorCode CheckLoadedSurface(const Mesh &mesh, const Boundary &b, const std::vector<char> &removed) {
  PetscFunctionBeginUser;
  PetscInt inner = 0;
  if (b.loaded || b.quiet)
    for (PetscInt f : mesh.surface_faces[b.surface]) {
      const Face &face = mesh.faces[f];
      inner += face.cell[1] >= 0 && !IsRemoved(mesh, removed, face.cell[0]) && !IsRemoved(mesh, removed, face.cell[1]);
    }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &inner, 1, MPIU_INT, MPI_SUM, mesh.comm));
  CdemCheck(inner == 0, mesh.comm,
            "boundary '%s' %s, but its surface lies inside the body: %s needs a surface on the outer boundary",
            b.name.c_str(), b.loaded ? "has a traction or pressure" : "is quiet", b.loaded ? "a load" : "it");
  PetscFunctionReturn(PETSC_SUCCESS);
}

}  // namespace

PetscErrorCode ReadBoundaries(const Mesh &mesh, Options &options, const std::vector<std::string> &table_names,
                              std::vector<Boundary> *boundaries) {
  PetscFunctionBeginUser;
  std::vector<std::string> names;
  PetscCall(options.Names("boundaries", &names));
  options.Declare("boundary", names);
  for (const std::string &name : names) {
    Boundary b;
    b.name = name;
    PetscCall(ReadBoundary(mesh, options, table_names, &b));
    boundaries->push_back(b);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode BuildRecords(const Mesh &mesh, const Nodes &nodes, const std::vector<Boundary> &boundaries,
                            const std::vector<Material> &materials, const std::vector<char> &removed,
                            std::vector<History> &histories, Tables *tables) {
  PetscFunctionBeginUser;
  PetscMPIInt rank;
  PetscCallMPI(MPI_Comm_rank(mesh.comm, &rank));
  std::map<PetscInt, Row> rows;
  for (const Boundary &b : boundaries) {
    if (b.point_set >= 0) {
      std::vector<char> member(mesh.vertex_x.size() / 3, 0);
      for (PetscInt v : mesh.set_vertices[b.point_set]) member[v] = 1;
      for (PetscInt i = 0; i < nodes.n_owned; ++i)
        if (member[nodes.vertex[i]]) Prescribe(b, rows[i]);
      continue;
    }
    PetscCall(CheckLoadedSurface(mesh, b, removed));
    for (PetscInt f : mesh.surface_faces[b.surface]) {
      const Face &face = mesh.faces[f];
      const int size = Info(mesh.cell_shape[face.cell[0]]).face_size[face.local[0]];
      for (int side = 0; side < (face.cell[1] >= 0 ? 2 : 1); ++side)
        for (int j = 0; j < size; ++j) {
          const PetscInt node = FaceNode(mesh, nodes, face, j, side);
          if (node >= 0 && node < nodes.n_owned) Prescribe(b, rows[node]);
        }
      const int outer = OuterSide(mesh, removed, face);
      if (b.loaded && outer >= 0) LoadFace(mesh, nodes, b, face, outer, rows);
      if (b.quiet && outer >= 0) QuietFace(mesh, nodes, materials, b, face, outer, rows);
    }
  }
  if (!removed.empty())
    for (PetscInt i = 0; i < nodes.n_owned; ++i)
      if (tables->mass[i] == 0) {
        rows[i] = Row();
        std::fill_n(rows[i].kind, 3, kVelocity);  // stays where it is
      }
  for (History &h : histories) {
    if (h.rank != rank) continue;
    Row &row = rows[h.node];
    if (row.watch < 0) row.watch = tables->n_watch++;
    h.slot = row.watch;
  }
  if (rows.empty()) PetscFunctionReturn(PETSC_SUCCESS);

  NodeRecords &r = tables->records;
  r.of_node.assign(nodes.n_owned, -1);
  r.load_start.assign(1, 0);
  for (const auto &[node, row] : rows) {
    r.of_node[node] = r.n++;
    r.kind.push_back(static_cast<std::uint8_t>(row.kind[0] | row.kind[1] << 2 | row.kind[2] << 4));
    for (int k = 0; k < 3; ++k) r.value.push_back(row.value[k]), r.table.push_back(row.table[k]);
    for (const auto &[table, load] : row.load) {
      r.load_table.push_back(table.first);
      r.load_wave.push_back(table.second);
      r.load.insert(r.load.end(), load.begin(), load.end());
    }
    r.load_start.push_back(static_cast<int>(r.load_table.size()));
    r.watch.push_back(row.watch);
    r.quiet.push_back(row.quiet ? static_cast<int>(r.dashpot.size() / 6) : -1);
    if (row.quiet) r.dashpot.insert(r.dashpot.end(), row.dashpot.begin(), row.dashpot.end());
  }
  if (r.dashpot.empty()) r.quiet.clear();
  PetscFunctionReturn(PETSC_SUCCESS);
}

}  // namespace cdem
