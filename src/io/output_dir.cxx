#include "io/output_dir.hpp"

#include "core/option_list.hpp"
#include "io/result_names.hpp"
#include "io/safe_file.hpp"

#include <algorithm>
#include <filesystem>
#include <system_error>

namespace fs = std::filesystem;

namespace cdem {

namespace {

using Text = std::string;

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

}  // namespace

std::string SceneFile(const std::string &dir) {
  std::vector<GivenOption> options;
  if (ListOptions(&options)) return "cannot list the options";
  std::string lines = "# every option of this run; give it back with -options_file\n";
  for (const GivenOption &option : options) lines += OptionLine(option);
  return ReplaceFile(dir + "/scene.opts", lines);
}

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
    failure = dir.empty() ? "-output needs the name of a folder" : MakeDir(dir, overwrite);
    if (failure.empty()) failure = SceneFile(dir);
  }
  PetscCall(CheckFailure(comm, failure));
  PetscFunctionReturn(PETSC_SUCCESS);
}

HistoryFile::~HistoryFile() {
  if (file_) std::fclose(file_);
}

std::string HistoryFile::Header(const std::vector<std::string> &names) {
  std::string header = "step,time";
  for (const std::string &name : names) header += "," + name;
  return header;
}

PetscErrorCode HistoryFile::Open(MPI_Comm comm, const std::string &dir, const std::vector<std::string> &names,
                                 bool append) {
  PetscFunctionBeginUser;
  int rank;
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  comm_ = comm;
  path_ = dir + "/histories.csv";
  std::string failure;
  if (rank == 0) {
    if (file_) std::fclose(file_);
    std::error_code ignored;
    append = append && fs::exists(path_, ignored);
    const std::string header = append ? "" : Header(names) + "\n";
    file_ = std::fopen(path_.c_str(), append ? "a" : "w");
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
