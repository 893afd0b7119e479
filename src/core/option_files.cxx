// What PETSc passes over in silence in files of options.
#include "core/error.hpp"
#include "core/options.hpp"

#include <algorithm>
#include <fstream>

namespace cdem {

static bool IsYaml(const std::string &path) {
  for (const std::string ending : {".yaml", ".yml"})
    if (path.size() > ending.size() && path.compare(path.size() - ending.size(), ending.size(), ending) == 0)
      return true;
  return false;
}

/// The number of the line with which a second document begins or the first one ends early; 0 if there is none.
static int SecondDocument(const std::string &path) {
  std::ifstream in(path, std::ios::binary);
  std::string line;
  bool content = false, ended = false;
  for (int number = 1; std::getline(in, line); ++number) {
    const std::string mark = line.substr(0, 3);
    const bool alone = line.size() < 4 || std::string(" \t\r").find(line[3]) != std::string::npos;
    const bool blank = line.find_first_not_of(" \t\r") == std::string::npos || line[0] == '#';
    if (alone && mark == "---" && (content || ended)) return number;
    if (alone && mark == "...") {
      ended = true;
    } else if (!blank) {
      if (ended) return number;
      content = content || line[0] != '%';
    }
  }
  return 0;
}

/// The number of the first line of `-option value` with a quote that does not end before a comment; 0 if there is none.
static int OpenQuote(const std::string &path) {
  std::ifstream in(path, std::ios::binary);
  std::string line;
  for (int number = 1; std::getline(in, line); ++number) {
    line = line.substr(0, line.find('#'));  // PETSc takes it for a comment between quotes, too
    if (std::count(line.begin(), line.end(), '"') % 2 != 0) return number;
  }
  return 0;
}

PetscErrorCode CheckOptionFiles(int argc, char **argv) {
  PetscFunctionBeginUser;
  PetscMPIInt rank;
  PetscCallMPI(MPI_Comm_rank(PETSC_COMM_WORLD, &rank));
  for (int i = 1; i + 1 < argc; ++i) {
    const std::string path = argv[i + 1];
    if (std::string(argv[i]) != "-options_file") continue;
    std::string wrong;
    if (const int line = rank != 0 ? 0 : IsYaml(path) ? SecondDocument(path) : OpenQuote(path)) {
      wrong = "line " + std::to_string(line) + " of " + path +
              (IsYaml(path) ? " begins a second document, which is not read: take out '---' and '...'"
                            : " has a quote without its end (what follows a '#' is a comment)");
    }
    PetscCall(CheckFailure(PETSC_COMM_WORLD, wrong));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

}  // namespace cdem
