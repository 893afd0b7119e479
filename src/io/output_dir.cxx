#include "io/output_dir.hpp"

#include "io/safe_file.hpp"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <map>
#include <system_error>

namespace fs = std::filesystem;

namespace cdem {

namespace {

using Text = std::string;

bool EndsWith(const Text &name, const Text &end) {
  return name.size() > end.size() && name.compare(name.size() - end.size(), end.size(), end) == 0;
}

// What stands between the last mark in name and its end, when all of it is digits.
bool HasNumber(const Text &name, const Text &mark, const Text &end) {
  if (!EndsWith(name, end)) return false;
  const Text stem = name.substr(0, name.size() - end.size());
  const std::size_t at = stem.rfind(mark);
  if (at == Text::npos || at + mark.size() == stem.size()) return false;
  return std::all_of(stem.begin() + static_cast<std::ptrdiff_t>(at + mark.size()), stem.end(),
                     [](unsigned char c) { return std::isdigit(c) != 0; });
}

// Files that only a run writes; a file of the user's (terrain.hdf, rock_mesh_fine.h5) is none of them.
bool IsResult(const Text &name) {
  return name == "summary.json" || name == "histories.csv" || name == "joints.csv" || EndsWith(name, ".hdf.series") ||
         HasNumber(name, "_", ".hdf") || HasNumber(name, "_mesh_", ".h5") ||
         (name.rfind("checkpoint_", 0) == 0 && HasNumber(name, "_", ".h5"));
}

bool IsLeftover(const Text &name) {
  if (!EndsWith(name, ".part")) return false;
  const Text whole = name.substr(0, name.size() - 5);
  return IsResult(whole) || whole == "scene.opts";
}

// Makes dir or empties it of what an earlier run wrote; the text of the failure, or "".
Text MakeDir(const Text &dir, bool overwrite) {
  std::error_code code;
  fs::create_directories(dir, code);
  if (code) return "cannot make the output folder " + dir + ": " + code.message();
  std::vector<fs::path> old;
  bool results = false;
  fs::directory_iterator entry(dir, code), end;
  for (; !code && entry != end; entry.increment(code)) {
    const Text name = entry->path().filename().string();
    std::error_code ignored;
    if (entry->is_directory(ignored) && !entry->is_symlink(ignored)) continue;
    if (!IsResult(name) && !IsLeftover(name)) continue;
    old.push_back(entry->path());
    results = results || IsResult(name);
  }
  if (code) return "cannot read the output folder " + dir + ": " + code.message();
  if (results && !overwrite)
    return "the output folder " + dir + " holds the results of an earlier run (" +
           std::min_element(old.begin(), old.end())->filename().string() +
           "); give another -output, or -output_overwrite to remove them";
  for (const fs::path &path : old) {
    fs::remove(path, code);
    if (code) return "cannot remove " + path.string() + ": " + code.message();
  }
  return "";
}

// One line of a PETSc options file. Its quotes have no escapes, '#' begins a comment even between them, and a value
// that looks like an option is refused: such a value becomes a comment.
Text OptionLine(const Text &name, const Text &value, bool has_value) {
  if (!has_value) return "-" + name + "\n";
  PetscBool key = PETSC_FALSE;
  (void)PetscOptionsValidKey(value.c_str(), &key);
  if (key || value.find_first_of("\"#\t\r\n") != Text::npos) {
    Text shown = value;
    for (char &c : shown)
      if (c == '\n' || c == '\r') c = ' ';
    return "# no options file can hold this value: -" + name + " " + shown + "\n";
  }
  const bool quote = value.empty() || value.find(' ') != Text::npos;
  return "-" + name + " " + (quote ? "\"" + value + "\"" : value) + "\n";
}

// All options of the database, sorted as PETSc keeps them. PETSc gives them only as one string without quotes; the
// exact values come from two other calls that, unlike PetscOptionsFindPair alone, leave unread options unread.
PetscErrorCode AllOptions(Text *lines) {
  PetscFunctionBeginUser;
  PetscInt n_left = 0;
  char **names = nullptr, **values = nullptr, *all = nullptr;
  PetscCall(PetscOptionsLeftGet(nullptr, &n_left, &names, &values));
  std::map<Text, const char *> left;
  for (PetscInt i = 0; i < n_left; ++i) left[names[i]] = values[i];
  PetscCall(PetscOptionsGetAll(nullptr, &all));
  const Text text = all;
  PetscCall(PetscFree(all));
  for (std::size_t at = 0; at < text.size() && text[at] == '-';) {  // "-name " or "-name value "
    const std::size_t space = std::min(text.find(' ', at), text.size());
    const Text name = text.substr(at + 1, space - at - 1);
    const char *value = nullptr;
    PetscBool used = PETSC_FALSE, set = PETSC_FALSE;
    const auto unread = left.find(name);
    PetscCall(PetscOptionsUsed(nullptr, name.c_str(), &used));
    if (unread != left.end()) {
      value = unread->second;
    } else if (used) {
      PetscCall(PetscOptionsFindPair(nullptr, nullptr, ("-" + name).c_str(), &value, &set));
    }
    Text exact = value ? value : "";
    bool has_value = value != nullptr;
    at = space + 1;
    if (has_value && text.compare(at, exact.size(), exact) == 0) {
      at += exact.size() + 1;
    } else if (!used && unread == left.end()) {  // one of those that PETSc never lists as left: up to the next option
      std::size_t next = at;
      if (!(next < text.size() && text[next] == '-' && next + 1 < text.size() && std::isalpha(text[next + 1]))) {
        do next = text.find(" -", next + 1);
        while (next != Text::npos && next + 2 < text.size() && !std::isalpha(text[next + 2]));
        next = std::min(next, text.size() - 1);
        exact = text.substr(at, next - at);
        has_value = !exact.empty();
        at = next + 1;
      }
    }
    if (name.rfind("options_file", 0) != 0 && name.rfind("options_string", 0) != 0)
      *lines += OptionLine(name, exact, has_value);
  }
  PetscCall(PetscOptionsLeftRestore(nullptr, &n_left, &names, &values));
  PetscFunctionReturn(PETSC_SUCCESS);
}

}  // namespace

PetscErrorCode WriteFileSafely(const std::string &path, const std::string &text) {
  PetscFunctionBeginUser;
  const std::string failure = ReplaceFile(path, text);
  CdemCheck(failure.empty(), PETSC_COMM_SELF, "%s", failure.c_str());
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode PrepareOutputDir(MPI_Comm comm, const std::string &dir, bool overwrite) {
  PetscFunctionBeginUser;
  int rank;
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  std::string failure;
  if (rank == 0) {
    std::string lines = "# every option of this run; give it back with -options_file\n";
    PetscCall(AllOptions(&lines));
    failure = dir.empty() ? "-output needs the name of a folder" : MakeDir(dir, overwrite);
    if (failure.empty()) failure = ReplaceFile(dir + "/scene.opts", lines);
  }
  PetscCall(CheckFailure(comm, failure));
  PetscFunctionReturn(PETSC_SUCCESS);
}

HistoryFile::~HistoryFile() {
  if (file_) std::fclose(file_);
}

PetscErrorCode HistoryFile::Open(MPI_Comm comm, const std::string &dir, const std::vector<std::string> &names) {
  PetscFunctionBeginUser;
  int rank;
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  comm_ = comm;
  path_ = dir + "/histories.csv";
  std::string failure;
  if (rank == 0) {
    std::string header = "step,time";
    for (const std::string &name : names) header += "," + name;
    header += "\n";
    if (file_) std::fclose(file_);
    file_ = std::fopen(path_.c_str(), "w");
    if (!file_ || std::fputs(header.c_str(), file_) < 0 || std::fflush(file_) != 0)
      failure = "cannot write " + path_ + ": " + std::strerror(errno);
  }
  PetscCall(CheckFailure(comm, failure));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode HistoryFile::Append(const std::vector<PetscInt> &steps, const std::vector<double> &times,
                                   const std::vector<std::vector<double>> &values) {
  PetscFunctionBeginUser;
  std::string failure;
  if (file_) {
    std::string rows;
    char number[40];
    for (std::size_t i = 0; i < steps.size(); ++i) {
      rows += std::to_string(steps[i]);
      std::snprintf(number, sizeof(number), ",%.17g", times[i]);
      rows += number;
      for (const double value : values[i]) {
        std::snprintf(number, sizeof(number), ",%.17g", value);
        rows += number;
      }
      rows += "\n";
    }
    if (std::fwrite(rows.data(), 1, rows.size(), file_) != rows.size() || std::fflush(file_) != 0)
      failure = "cannot write " + path_ + ": " + std::strerror(errno);
  }
  PetscCall(CheckFailure(comm_, failure));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode WriteSummary(MPI_Comm comm, const std::string &dir, const nlohmann::json &summary) {
  PetscFunctionBeginUser;
  int rank;
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  std::string failure;
  if (rank == 0) {  // a path with broken UTF-8 in it must not end a finished run
    const auto replace = nlohmann::json::error_handler_t::replace;
    failure = ReplaceFile(dir + "/summary.json", summary.dump(2, ' ', false, replace) + "\n");
  }
  PetscCall(CheckFailure(comm, failure));
  PetscFunctionReturn(PETSC_SUCCESS);
}

}  // namespace cdem
