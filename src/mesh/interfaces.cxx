#include "mesh/interfaces.hpp"

#include "core/error.hpp"
#include "core/options.hpp"

#include <algorithm>
#include <numeric>
#include <set>

namespace cdem {

std::string Joined(const std::vector<std::string> &names) {
  std::string all;
  for (const std::string &name : names) all += (all.empty() ? "" : ", ") + name;
  return all.empty() ? "(none)" : all;
}

static std::vector<std::string> SplitAtColons(const std::string &text) {
  std::vector<std::string> parts(1);
  for (char c : text) {
    if (c == ':')
      parts.emplace_back();
    else
      parts.back() += c;
  }
  return parts;
}

static PetscErrorCode Region(const Mesh &mesh, const std::string &spelled, const std::string &name, int *region) {
  PetscFunctionBeginUser;
  *region = Mesh::Find(mesh.regions, name);
  CdemCheck(*region >= 0, mesh.comm, "%s: the mesh has no region '%s'; its regions are: %s", spelled.c_str(),
            name.c_str(), Joined(mesh.regions).c_str());
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode CheckJointsUsed(const Mesh &mesh, const std::vector<FaceSet> &joints,
                                      const std::vector<char> &used) {
  PetscFunctionBeginUser;
  for (std::size_t j = 0; j < joints.size(); ++j) {
    const char *name = joints[j].name.c_str();
    CdemCheck(
        used[j], mesh.comm,
        "-joints: no interface uses the joint set '%s': declare one (-interfaces %s -interface_%s_on joints:%s), or "
        "take the set out",
        name, name, name, name);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SelectInterfaces(const Mesh &mesh, Options &options, const std::vector<FaceSet> &joints,
                                std::vector<std::string> *names, std::vector<int> *face_interface) {
  PetscFunctionBeginUser;
  std::vector<std::string> joint_names;
  std::vector<char> used(joints.size(), 0);
  for (const FaceSet &set : joints) joint_names.push_back(set.name);
  PetscCall(options.Names("interfaces", names));
  options.Declare("interface", *names);
  face_interface->assign(mesh.faces.size(), -1);
  for (std::size_t i = 0; i < names->size(); ++i) {
    const std::string &name = (*names)[i];
    const OptionKey key("interface", name, "on");
    std::string on = "surface:" + name;
    PetscCall(options.Text(key, &on));
    const std::string spelled = Options::Spelled(key) + " " + on;
    const std::vector<std::string> part = SplitAtColons(on);
    const int id = static_cast<int>(i);
    auto claim = [&](auto &&wanted) {
      for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
        const Face &face = mesh.faces[f];
        if (face.cell[1] >= 0 && wanted(mesh.cell_region[face.cell[0]], mesh.cell_region[face.cell[1]]))
          (*face_interface)[f] = id;
      }
    };
    if (part[0] == "surface" && part.size() == 2) {
      const int surface = Mesh::Find(mesh.surfaces, part[1]);
      CdemCheck(surface >= 0, mesh.comm, "%s: the mesh has no surface '%s'; its surfaces are: %s", spelled.c_str(),
                part[1].c_str(), Joined(mesh.surfaces).c_str());
      for (PetscInt f : mesh.surface_faces[surface])
        if (mesh.faces[f].cell[1] >= 0) (*face_interface)[f] = id;
    } else if (part[0] == "between" && part.size() == 3) {
      int a, b;
      PetscCall(Region(mesh, spelled, part[1], &a));
      PetscCall(Region(mesh, spelled, part[2], &b));
      CdemCheck(a != b, mesh.comm, "%s: the two regions are the same; for the faces inside one region use inside:%s",
                spelled.c_str(), part[1].c_str());
      claim([a, b](int p, int q) { return (p == a && q == b) || (p == b && q == a); });
    } else if (part[0] == "inside" && part.size() == 2) {
      int a;
      PetscCall(Region(mesh, spelled, part[1], &a));
      claim([a](int p, int q) { return p == a && q == a; });
    } else if (part[0] == "joints" && part.size() == 2) {
      const int set = Mesh::Find(joint_names, part[1]);
      CdemCheck(set >= 0, mesh.comm, "%s: there is no joint set '%s'; declared with -joints are: %s", spelled.c_str(),
                part[1].c_str(), Joined(joint_names).c_str());
      for (PetscInt f : joints[set].faces) (*face_interface)[f] = id;
      used[set] = 1;
    } else if (on == "all") {
      claim([](int, int) { return true; });
    } else {
      CdemCheck(false, mesh.comm, "%s: not understood; it is surface:S, between:A:B, inside:A, joints:J or all",
                spelled.c_str());
    }
    PetscInt count = 0;
    for (std::size_t f = 0; f < mesh.faces.size(); ++f)
      count += (*face_interface)[f] == id && mesh.faces[f].cell[0] < mesh.n_owned;
    PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &count, 1, MPIU_INT, MPI_SUM, mesh.comm));
    CdemCheck(count > 0, mesh.comm,
              "%s: interface '%s' has no face: the faces asked for lie on the outer boundary, or there are none%s",
              spelled.c_str(), name.c_str(),
              part[0] == "joints" ? " (its discs separate no two elements: are they smaller than an element?)" : "");
  }
  PetscCall(CheckJointsUsed(mesh, joints, used));
  for (std::size_t i = 0; i < names->size(); ++i) {
    PetscInt count = std::count(face_interface->begin(), face_interface->end(), static_cast<int>(i));
    PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &count, 1, MPIU_INT, MPI_SUM, mesh.comm));
    CdemCheck(count > 0, mesh.comm,
              "interface '%s' has no face left: later interfaces claim all of its faces; leave it out",
              (*names)[i].c_str());
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

RegionPair SidesOf(const Mesh &mesh, const Face &face) {
  const int a = mesh.cell_region[face.cell[0]], b = mesh.cell_region[face.cell[1]];
  return {std::min(a, b), std::max(a, b)};
}

PetscErrorCode FindSides(const Mesh &mesh, const std::vector<int> &face_interface, std::size_t n,
                         std::vector<std::vector<RegionPair>> *sides) {
  PetscFunctionBeginUser;
  std::set<std::array<int, 3>> found;  // interface, regions
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    if (face_interface[f] < 0 || mesh.faces[f].cell[1] < 0) continue;
    const RegionPair pair = SidesOf(mesh, mesh.faces[f]);
    found.insert({face_interface[f], pair[0], pair[1]});
  }
  std::vector<int> mine, all;
  for (const std::array<int, 3> &row : found) mine.insert(mine.end(), row.begin(), row.end());
  PetscMPIInt ranks, count = static_cast<PetscMPIInt>(mine.size());
  PetscCallMPI(MPI_Comm_size(mesh.comm, &ranks));
  std::vector<PetscMPIInt> counts(ranks), starts(ranks + 1, 0);
  PetscCallMPI(MPI_Allgather(&count, 1, MPI_INT, counts.data(), 1, MPI_INT, mesh.comm));
  std::partial_sum(counts.begin(), counts.end(), starts.begin() + 1);
  all.resize(starts[ranks]);
  PetscCallMPI(
      MPI_Allgatherv(mine.data(), count, MPI_INT, all.data(), counts.data(), starts.data(), MPI_INT, mesh.comm));
  for (std::size_t i = 0; i < all.size(); i += 3) found.insert({all[i], all[i + 1], all[i + 2]});
  sides->assign(n, {});
  for (const std::array<int, 3> &row : found) (*sides)[row[0]].push_back({row[1], row[2]});
  PetscFunctionReturn(PETSC_SUCCESS);
}

}  // namespace cdem
