#include "io/fingerprint.hpp"

#include "core/checksum.hpp"
#include "core/random.hpp"
#include "io/history_rows.hpp"
#include "physics/elements.hpp"

#include <algorithm>

namespace cdem {

namespace {

using Sum = std::uint64_t;

Sum OfCoordinates(const Mesh &mesh) {
  Sum sum = 0;
  for (PetscInt c = 0; c < mesh.n_owned; ++c) {
    Sum h = MixBits(1, static_cast<Sum>(mesh.cell_global[c]));
    for (int a = 0; a < Info(mesh.cell_shape[c]).corners; ++a)
      for (int k = 0; k < 3; ++k) h = MixReal(h, mesh.X(mesh.Corners(c)[a])[k]);
    sum += h;
  }
  return sum;
}

/// Shape, region and nodes of every element.
Sum OfCells(const Mesh &mesh, const Nodes &nodes, const std::vector<std::int64_t> &node_global) {
  Sum sum = 0;
  for (PetscInt c = 0; c < mesh.n_owned; ++c) {
    Sum h = MixBits(2, static_cast<Sum>(mesh.cell_global[c]));
    h = MixBits(h, static_cast<Sum>(mesh.cell_shape[c]));
    h = MixBits(h, KeyNumber(mesh.regions[mesh.cell_region[c]]));
    for (int a = 0; a < Info(mesh.cell_shape[c]).corners; ++a)
      h = MixBits(h, static_cast<Sum>(node_global[nodes.Corners(c)[a]]));
    sum += h;
  }
  return sum;
}

Sum OfInterfaces(const Mesh &mesh, const std::vector<int> &face_interface) {
  Sum sum = 0;
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    const Face &face = mesh.faces[f];
    if (face_interface[f] < 0 || face.cell[0] >= mesh.n_owned) continue;
    Sum h = MixBits(3, static_cast<Sum>(mesh.cell_global[face.cell[0]]));
    h = MixBits(h, static_cast<Sum>(face.local[0]));
    sum += MixBits(h, static_cast<Sum>(face_interface[f]));
  }
  return sum;
}

Sum MixParams(Sum h, const std::vector<double> &table, int row) {
  for (int p = 0; p < kMaxParams; ++p) h = MixReal(h, table[static_cast<std::size_t>(kMaxParams) * row + p]);
  return h;
}

/// Form, law and parameters of every element.
Sum OfBlocks(const Mesh &mesh, const Tables &tables) {
  Sum sum = 0;
  for (const ElementTable &t : tables.elements) {
    Sum kind = 4;
    VisitBlock(t.shape, t.form, t.law, [&](auto form, auto law) {
      kind = MixBits(KeyNumber(decltype(form)::kName), KeyNumber(decltype(law)::kName));
    });
    for (int e = 0; e < t.n; ++e)
      if (t.cell[e] < mesh.n_owned)
        sum +=
            MixParams(MixBits(kind, static_cast<Sum>(mesh.cell_global[t.cell[e]])), tables.block_param, t.material[e]);
  }
  return sum;
}

Sum OfMasses(const Nodes &nodes, const Tables &tables) {
  Sum sum = 0;
  for (int i = 0; i < tables.n_owned; ++i)
    sum += MixReal(MixBits(5, static_cast<Sum>(nodes.global[i])), tables.mass[i]);
  return sum;
}

/// Law, stiffness, parameters and state at the start of every spring; with *count springs.
Sum OfSprings(const Mesh &mesh, const Nodes &nodes, const Tables &tables, std::int64_t *count) {
  Sum sum = 0;
  for (const SpringTable &t : tables.springs) {
    const std::vector<int> corner = SpringCorners(mesh, nodes, t);
    Sum kind = 6;
    JointLaws::Visit(t.law, [&](auto law) {
      kind = MixBits(KeyNumber(decltype(law)::kName), static_cast<Sum>(decltype(law)::kState));
    });
    for (int i = 0; i < t.n; ++i) {
      if (!t.counted[i]) continue;
      const Face &face = mesh.faces[t.face[i]];
      Sum h = MixBits(kind, static_cast<Sum>(mesh.cell_global[face.cell[0]]));
      h = MixBits(h, static_cast<Sum>(4 * face.local[0] + corner[i]));
      h = MixReal(MixReal(h, t.kn[i]), t.ks[i]);
      h = MixBits(h, t.state.empty() ? 0 : t.state[i]);
      for (int side = 0; side < 2 && !t.cell.empty(); ++side) h = MixBits(h, t.cell[2 * i + side] >= 0);
      sum += MixParams(h, tables.joint_param, t.joint[i]);
      ++*count;
    }
  }
  return sum;
}

/// What is prescribed, what absorbs and what loads, node by node.
Sum OfBoundaries(const Nodes &nodes, const NodeRecords &r) {
  Sum sum = 0;
  for (std::size_t i = 0; i < r.of_node.size(); ++i) {
    const int row = r.of_node[i];
    const int quiet = row < 0 || r.quiet.empty() ? -1 : r.quiet[row];
    if (row < 0 || (r.kind[row] == 0 && quiet < 0 && r.load_start[row] == r.load_start[row + 1])) continue;  // watched
    Sum h = MixBits(MixBits(7, static_cast<Sum>(nodes.global[i])), r.kind[row]);
    for (int k = 0; k < 3; ++k)
      if ((r.kind[row] >> (2 * k) & 3) != kFree)
        h = MixBits(MixReal(h, r.value[3 * row + k]), static_cast<Sum>(r.table[3 * row + k]));
    for (int l = r.load_start[row]; l < r.load_start[row + 1]; ++l) {
      h = MixBits(h, static_cast<Sum>(r.load_table[l]));
      for (int k = 0; k < 3; ++k) h = MixReal(h, r.load[3 * static_cast<std::size_t>(l) + k]);
    }
    for (int k = 0; quiet >= 0 && k < 6; ++k) h = MixReal(h, r.dashpot[6 * static_cast<std::size_t>(quiet) + k]);
    sum += h;
  }
  return sum;
}

Sum OfBody(const Tables &t) {
  Sum h = 9;
  for (double value : {t.gravity[0], t.gravity[1], t.gravity[2], t.beta}) h = MixReal(h, value);
  return MixBits(h, t.releases);
}

}  // namespace

std::uint64_t OfTables(const std::vector<TimeTable> &tables) {
  std::uint64_t h = 8;
  for (const TimeTable &t : tables) {
    h = MixBits(h, static_cast<std::uint64_t>(t.type));
    for (double value : {t.frequency, t.delay, t.amplitude}) h = MixReal(h, value);
    for (const std::vector<double> *column : {&t.time, &t.value}) {
      h = MixBits(h, column->size());
      for (double value : *column) h = MixReal(h, value);
    }
  }
  return h;
}

PetscErrorCode TakeFingerprint(const Mesh &mesh, const Nodes &nodes, const std::vector<int> &face_interface,
                               const Tables &tables, const std::vector<TimeTable> &time_tables,
                               Fingerprint *fingerprint) {
  PetscFunctionBeginUser;
  std::vector<std::int64_t> node_global(nodes.global);
  node_global.resize(nodes.n_local);
  if (nodes.halo) {
    std::int64_t *ghosts = node_global.data() + nodes.n_owned;
    PetscCall(PetscSFBcastBegin(nodes.halo, MPI_INT64_T, nodes.global.data(), ghosts, MPI_REPLACE));
    PetscCall(PetscSFBcastEnd(nodes.halo, MPI_INT64_T, nodes.global.data(), ghosts, MPI_REPLACE));
  }
  std::int64_t springs = 0, faces = 0;
  for (std::size_t f = 0; f < mesh.faces.size(); ++f)
    faces += face_interface[f] >= 0 && mesh.faces[f].cell[0] < mesh.n_owned;
  const Sum of_springs = OfSprings(mesh, nodes, tables, &springs);
  // sums over the ranks, modulo 2^64
  std::vector<std::pair<std::string, Sum>> parts = {
      {"elements", static_cast<Sum>(mesh.n_owned)},
      {"nodes", static_cast<Sum>(tables.n_owned)},
      {"faces of interfaces", static_cast<Sum>(faces)},
      {"springs", static_cast<Sum>(springs)},
      {"sum: coordinates of the mesh", OfCoordinates(mesh)},
      {"sum: elements, their regions and nodes", OfCells(mesh, nodes, node_global)},
      {"sum: faces of the interfaces", OfInterfaces(mesh, face_interface)},
      {"sum: forms, laws and numbers of the blocks", OfBlocks(mesh, tables)},
      {"sum: masses", OfMasses(nodes, tables)},
      {"sum: laws and numbers of the springs", of_springs},
      {"sum: boundaries and loads", OfBoundaries(nodes, tables.records)},
  };
  fingerprint->clear();
  for (auto &[what, value] : parts) {
    PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &value, 1, MPI_UINT64_T, MPI_SUM, mesh.comm));
    fingerprint->emplace_back(what, static_cast<std::int64_t>(value));
  }
  fingerprint->emplace_back("sum: time tables", static_cast<std::int64_t>(OfTables(time_tables)));
  fingerprint->emplace_back("sum: gravity and damping", static_cast<std::int64_t>(OfBody(tables)));
  PetscFunctionReturn(PETSC_SUCCESS);
}

std::string FingerprintDifference(const Fingerprint &was, const Fingerprint &now) {
  std::string text;
  for (const auto &[what, value] : now) {
    const auto before =
        std::find_if(was.begin(), was.end(), [&, &name = what](const auto &part) { return part.first == name; });
    if (before != was.end() && before->second == value) continue;
    text += text.empty() ? "" : "; ";
    if (what.rfind("sum: ", 0) == 0)
      text += "other " + what.substr(5);
    else
      text += (before == was.end() ? "no" : std::to_string(before->second)) + " " + what + ", and " +
              std::to_string(value) + " now";
  }
  return text;
}

}  // namespace cdem
