#include "core/error.hpp"
#include "mesh/gmsh_scan.hpp"
#include "mesh/source.hpp"

#include <strings.h>

#include <algorithm>
#include <cctype>
#include <sstream>

namespace cdem {

namespace {

const char *const kDimName[] = {"point", "line", "surface", "volume"};

// A group's name as an option can carry it: signs with a meaning in lists, paths or options become '_'.
std::string OptionName(const GmshKey &key, const std::map<GmshKey, std::string> &names) {
  const auto found = names.find(key);
  std::string name = found == names.end() ? "" : found->second;
  for (char &c : name) {
    const auto u = static_cast<unsigned char>(c);
    if (u < 128 && !std::isalnum(u) && c != '_' && c != '-' && c != '.') c = '_';
  }
  const char *const kind[] = {"point", "line", "surface", "region"};
  return name.empty() ? std::string(kind[key.first]) + "_" + std::to_string(key.second) : name;
}

// Volumes have names of their own; surfaces, lines and points share theirs, for a boundary may be on any of them.
// PETSc's options do not tell capitals from small letters.
void NameGroups(const GmshScan &scan, MeshSource *source) {
  for (int dim = 3; dim >= 0; --dim) {
    for (const auto &[key, count] : scan.elements) {
      if (key.first != dim) continue;
      const std::string name = OptionName(key, scan.names);
      for (const Group &other : source->groups) {
        if ((other.dim == 3) != (dim == 3) || strcasecmp(other.name.c_str(), name.c_str()) != 0) continue;
        throw GmshError("the physical " + std::string(kDimName[other.dim]) + " " + std::to_string(other.tag) +
                        " and the " + kDimName[dim] + " " + std::to_string(key.second) + " are both called '" + name +
                        "' in options: rename one");
      }
      source->groups.push_back({dim, key.second, name});
    }
  }
  if (source->groups.empty() || source->groups[0].dim != 3)
    source->groups.insert(source->groups.begin(), {3, 0, "mesh"});
  if (source->groups[0].tag != 0 && scan.ungrouped > 0) {
    throw GmshError(std::to_string(scan.ungrouped) + " of " + std::to_string(scan.cell_number.size()) +
                    " volume elements are in no physical volume: put every volume in a group, or use no groups at all");
  }
}

void AddRemarks(const GmshScan &scan, MeshSource *source) {
  if (scan.orphans > 0) {
    source->remarks.push_back(source->what + ": " + std::to_string(scan.orphans) +
                              " nodes belong to no volume element and are ignored");
  }
  for (const auto &[key, name] : scan.names) {
    if (key.first < 0 || key.first > 3 || scan.elements.count(key)) continue;
    source->remarks.push_back(source->what + ": the physical " + kDimName[key.first] + " '" + name +
                              "' has no elements and is ignored");
  }
}

PetscErrorCode BroadcastGroups(MPI_Comm comm, MeshSource *source) {
  PetscFunctionBeginUser;
  std::ostringstream out;
  for (const Group &g : source->groups) out << g.dim << ' ' << g.tag << ' ' << g.name << '\n';
  for (const std::string &remark : source->remarks) out << "4 0 " << remark << '\n';
  std::string text = out.str();
  PetscCall(BroadcastText(comm, &text));
  source->groups.clear();
  source->remarks.clear();
  std::istringstream in(text);
  for (Group g; in >> g.dim >> g.tag && std::getline(in >> std::ws, g.name);) {
    if (g.dim < 4)
      source->groups.push_back(g);
    else
      source->remarks.push_back(g.name);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

// Keeps the first message of PETSc's reader for us to print.
PetscErrorCode KeepMessage(MPI_Comm, int, const char *, const char *, PetscErrorCode code, PetscErrorType type,
                           const char *message, void *text) {
  if (type == PETSC_ERROR_INITIAL && message) *static_cast<std::string *>(text) = message;
  return code;
}

PetscErrorCode Refuse(const std::string &what, const std::string &message) {
  PetscFunctionBeginUser;
  CdemCheck(false, PETSC_COMM_SELF,
            "%s: PETSc's reader cannot take it: %s (a surface element must be a face of a volume "
            "element)",
            what.c_str(), message.empty() ? "unknown reason" : message.c_str());
  PetscFunctionReturn(PETSC_SUCCESS);
}

// The reader fails on rank 0 alone, the other ranks wait for it then: the program must end here.
PetscErrorCode PetscRead(MPI_Comm comm, const std::string &path, bool multiple_tags, MeshSource *source) {
  PetscFunctionBeginUser;
  const std::pair<const char *, const char *> forced[] = {
      {"-dm_plex_gmsh_hybrid", "0"},    // 1: wedges become tensor prisms, mixed meshes fail
      {"-dm_plex_gmsh_periodic", "0"},  // 1: vertices merge
      {"-dm_plex_gmsh_highorder", "0"},
      {"-dm_plex_gmsh_project", "0"},
      {"-dm_plex_gmsh_use_regions", "0"},  // 1: names as labels, which mixes up volumes, surfaces and "depth"
      {"-dm_plex_gmsh_mark_vertices", "0"},
      {"-dm_plex_gmsh_multiple_tags", multiple_tags ? "1" : "0"}};  // in 2.2 other tags follow the group's
  for (const auto &[name, value] : forced) PetscCall(PetscOptionsSetValue(nullptr, name, value));
  std::string message;
  PetscCall(PetscPushErrorHandler(KeepMessage, &message));
  const PetscErrorCode failed = DMPlexCreateGmshFromFile(comm, path.c_str(), PETSC_TRUE, &source->dm);
  PetscCall(PetscPopErrorHandler());
  if (failed) {
    int size;
    PetscCallMPI(MPI_Comm_size(comm, &size));
    const PetscErrorCode refused = Refuse(source->what, message);
    if (size > 1) ExitOnError();
    PetscCall(refused);
  }
  for (const auto &option : forced) PetscCall(PetscOptionsClearValue(nullptr, option.first));
  PetscFunctionReturn(PETSC_SUCCESS);
}

// Lines and points: PETSc's labels mix their tags with those of volumes and surfaces, or leave lines out. Edges are
// labelled with their ends, so that refinement keeps a line whole.
PetscErrorCode LabelPointSets(const GmshScan &scan, MeshSource *source) {
  PetscFunctionBeginUser;
  PetscInt index = 0, first, last;
  PetscCall(DMPlexGetDepthStratum(source->dm, 0, &first, &last));
  PetscCall(DMCreateLabel(source->dm, kPointLabel));
  for (const Group &group : source->groups) {
    if (group.dim > 1) continue;
    const auto found = scan.corners.find({group.dim, group.tag});  // nothing but on rank 0
    const std::vector<std::int64_t> none, &list = found == scan.corners.end() ? none : found->second;
    for (std::size_t i = 0; i < list.size(); ++i) {
      const PetscInt vertex = first + static_cast<PetscInt>(list[i]);
      PetscCheck(vertex < last, PETSC_COMM_SELF, PETSC_ERR_PLIB, "Vertex %" PetscInt_FMT " of a point set", vertex);
      PetscCall(DMSetLabelValue(source->dm, kPointLabel, vertex, index));
      if (group.dim == 0 || i % 2 == 0) continue;
      const PetscInt ends[2] = {first + static_cast<PetscInt>(list[i - 1]), vertex};
      PetscInt n;
      const PetscInt *edges;
      PetscCall(DMPlexGetJoin(source->dm, 2, ends, &n, &edges));
      for (PetscInt e = 0; e < n; ++e) PetscCall(DMSetLabelValue(source->dm, kPointLabel, edges[e], index));
      PetscCall(DMPlexRestoreJoin(source->dm, 2, ends, &n, &edges));
    }
    ++index;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

}  // namespace

PetscErrorCode ReadGmsh(MPI_Comm comm, const std::string &path, MeshSource *source) {
  PetscFunctionBeginUser;
  int rank;
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  source->what = "mesh '" + path + "'";
  source->hint = "mend it and mesh again (corners must be in gmsh's order)";
  GmshScan scan;
  std::string error;
  if (rank == 0) {
    try {
      scan = ScanGmsh(path);
      NameGroups(scan, source);
      AddRemarks(scan, source);
    } catch (const std::exception &e) {
      error = e.what();
    }
  }
  PetscCall(BroadcastText(comm, &error));
  CdemCheck(error.empty(), comm, "%s %s", source->what.c_str(), error.c_str());
  PetscCall(BroadcastGroups(comm, source));
  int multiple_tags = scan.multiple_tags;
  PetscCallMPI(MPI_Bcast(&multiple_tags, 1, MPI_INT, 0, comm));
  PetscCall(PetscRead(comm, path, multiple_tags, source));
  PetscCall(LabelPointSets(scan, source));
  source->cell_number = std::move(scan.cell_number);
  source->surface_corners = std::move(scan.surface_corners);
  PetscFunctionReturn(PETSC_SUCCESS);
}

}  // namespace cdem
