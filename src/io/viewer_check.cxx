#include "io/viewer_check.hpp"

#include "core/error.hpp"

#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <vector>

namespace fs = std::filesystem;

namespace cdem {

namespace {

struct ViewerOption {
  const char *name;
  bool only_text;  // what prints lines can do nothing else
};
constexpr ViewerOption kViewers[] = {
    {"monitor_progress", true}, {"monitor_energy", true}, {"monitor_convergence", true},
    {"ts_monitor", true},       {"ts_view", false},       {"dm_view", false},
    {"log_view", true}};
const std::vector<std::string> kTypes = {"ascii", "binary", "draw", "hdf5", "vtk", "socket"};
const std::vector<std::string> kModes = {"", "write", "append"};

bool IsOneOf(const std::vector<std::string> &list, const std::string &word) {
  return std::find(list.begin(), list.end(), word) != list.end();
}

// Cut at colons, as PETSc does; of more than four parts the last keeps the rest.
std::vector<std::string> Parts(const std::string &text) {
  std::vector<std::string> parts(1);
  for (char c : text) {
    if (c == ':' && parts.size() < 4)
      parts.emplace_back();
    else
      parts.back() += c;
  }
  parts.resize(4);
  return parts;
}

// Why this file cannot be written, "" if it can. A folder that the run makes itself need not be there.
std::string FileTrouble(const std::string &file, const std::string &output_dir) {
  std::error_code ignored;
  const fs::path path(file), parent = path.has_parent_path() ? path.parent_path() : fs::path(".");
  if (fs::is_directory(path, ignored)) return "it is a folder";
  if (fs::exists(path, ignored)) return access(file.c_str(), W_OK) == 0 ? "" : "its permissions forbid it";
  if (fs::is_directory(parent, ignored)) return access(parent.c_str(), W_OK) == 0 ? "" : "its folder forbids it";
  const fs::path to_be = (fs::path(output_dir) / "").lexically_normal();
  if (!output_dir.empty() && (parent / "").lexically_normal() == to_be) return "";
  return "there is no folder " + parent.string();
}

std::string Trouble(const ViewerOption &option, const std::string &text, const std::string &output_dir) {
  const std::vector<std::string> switches = {"", "true", "false", "yes", "no", "on", "off", "0", "1"};
  if (IsOneOf(switches, text)) return "";
  const std::vector<std::string> part = Parts(text);
  const std::string given = std::string("-") + option.name + " " + text + ": ";
  const std::string form = option.only_text
                               ? "; it prints text: give nothing (the terminal), ascii:FILE or ascii:FILE::append"
                               : "; give type:file:format:mode, such as ascii:FILE";
  if (!part[0].empty() && !(option.only_text ? part[0] == "ascii" : IsOneOf(kTypes, part[0])))
    return given + "there is no viewer '" + part[0] + "' for it" + form;
  PetscEnum format;
  PetscBool known = PETSC_TRUE;
  if (!part[2].empty() && PetscEnumFind(PetscViewerFormats, part[2].c_str(), &format, &known)) known = PETSC_FALSE;
  if (!known) return given + "there is no format '" + part[2] + "'" + form;
  if (!IsOneOf(kModes, part[3])) return given + "there is no mode '" + part[3] + "'" + form;
  if (part[1].empty() || part[0] == "draw" || part[0] == "socket") return "";
  const std::string trouble = FileTrouble(part[1], output_dir);
  return trouble.empty() ? "" : given + "cannot write " + part[1] + ": " + trouble;
}

}  // namespace

PetscErrorCode CheckViewers(MPI_Comm comm, const std::string &output_dir) {
  PetscFunctionBeginUser;
  int rank;
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  for (const ViewerOption &option : kViewers) {
    char text[PETSC_MAX_PATH_LEN] = "";
    PetscBool set;
    PetscCall(
        PetscOptionsGetString(nullptr, nullptr, (std::string("-") + option.name).c_str(), text, sizeof text, &set));
    PetscCall(CheckFailure(comm, set && rank == 0 ? Trouble(option, text, output_dir) : ""));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

}  // namespace cdem
