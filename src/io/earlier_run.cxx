#include "io/earlier_run.hpp"

#include "core/error.hpp"
#include "io/hdf5_reader.hpp"
#include "io/output_dir.hpp"
#include "io/result_names.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>

namespace fs = std::filesystem;

namespace cdem {

namespace {

/// Step and time of a frame; the text of the failure, or "".
std::string ReadFrame(const std::string &path, KeptFrame *frame) {
  Hdf5Reader file(PETSC_COMM_SELF, path);
  if (!file.OpenAlone("VTKHDF", "is no frame").empty()) return file.failure();
  std::int64_t step = 0;
  file.Read("FieldData/Step", H5T_NATIVE_INT64, 0, 1, &step);
  file.Read("FieldData/Time", H5T_NATIVE_DOUBLE, 0, 1, &frame->time);
  frame->step = step;
  return file.failure();
}

std::string RemoveAll(const std::vector<std::string> &paths) {
  for (const std::string &path : paths) {
    std::error_code code;
    fs::remove(path, code);
    if (code) return "cannot remove " + path + ": " + code.message();
  }
  return "";
}

}  // namespace

bool EarlierRun::Holds(const std::string &dir, const std::string &file) {
  std::error_code code;
  const fs::path folder = fs::path(file).parent_path();
  return fs::equivalent(dir, folder.empty() ? fs::path(".") : folder, code) && !code;
}

PetscErrorCode EarlierRun::Look(MPI_Comm comm, const std::string &dir, PetscInt step, const std::string &columns) {
  PetscFunctionBeginUser;
  comm_ = comm;
  dir_ = dir;
  step_ = step;
  int rank;
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  PetscCall(CheckFailure(comm, rank == 0 ? LookAt(columns) : ""));
  std::string names;  // all ranks number the coming frames
  for (const auto &[name, frames] : kept_) names += name + "\n";
  int length = static_cast<int>(names.size());
  PetscCallMPI(MPI_Bcast(&length, 1, MPI_INT, 0, comm));
  names.resize(static_cast<std::size_t>(length));
  PetscCallMPI(MPI_Bcast(&names[0], length, MPI_CHAR, 0, comm));
  for (std::size_t at = 0; at < names.size();) {
    const std::size_t end = names.find('\n', at);
    std::vector<KeptFrame> &frames = kept_[names.substr(at, end - at)];
    at = end + 1;
    int bytes = static_cast<int>(frames.size() * sizeof(KeptFrame));
    PetscCallMPI(MPI_Bcast(&bytes, 1, MPI_INT, 0, comm));
    frames.resize(static_cast<std::size_t>(bytes) / sizeof(KeptFrame));
    PetscCallMPI(MPI_Bcast(frames.data(), bytes, MPI_BYTE, 0, comm));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

std::string EarlierRun::LookAt(const std::string &columns) {
  std::error_code code;
  for (fs::directory_iterator entry(dir_, code), end; !code && entry != end; entry.increment(code)) {
    const std::string name = entry->path().filename().string(), path = entry->path().string();
    std::string head;
    if (IsLeftover(name) || name == "summary.json") leftovers_.push_back(path);
    if (NumberIn(name, ".h5", &head) > step_ && head == "checkpoint") later_.push_back(path);
    KeptFrame frame;
    frame.number = NumberIn(name, ".hdf", &head);
    if (frame.number < 0) continue;
    const std::string failure = ReadFrame(path, &frame);
    if (!failure.empty())
      return "-output " + dir_ + " holds a frame that cannot be read: " + failure +
             ". Take it away, or give another -output";
    if (frame.step > step_)
      later_.push_back(path);
    else
      kept_[head].push_back(frame);
  }
  if (code) return "cannot read the output folder " + dir_ + ": " + code.message();
  for (auto &[name, frames] : kept_)
    std::sort(frames.begin(), frames.end(), [](const auto &a, const auto &b) { return a.number < b.number; });
  return ScanHistories(columns);
}

/// Checks the first line and finds the first row that the coming run will write again: that of the step itself.
std::string EarlierRun::ScanHistories(const std::string &columns) {
  const std::string path = dir_ + "/histories.csv";
  std::error_code code;
  if (!fs::exists(path, code)) return "";
  std::ifstream file(path, std::ios::binary);
  std::string line;
  if (!std::getline(file, line)) return "cannot read " + path + ": " + std::strerror(errno);
  if (line != columns)
    return "the histories of this run are not those of " + path + ", in which it would go on: there the columns are '" +
           line + "', and now " + (columns.empty() ? std::string("there are none") : "'" + columns + "'") +
           ". Give another -output, or the same -histories";
  csv_bytes_ = static_cast<long long>(line.size()) + 1;
  while (std::getline(file, line)) {
    if (std::atoll(line.c_str()) >= step_ || file.eof()) break;  // without an end of line a row is not whole
    csv_bytes_ += static_cast<long long>(line.size()) + 1;
  }
  return "";
}

PetscErrorCode EarlierRun::Begin() {
  PetscFunctionBeginUser;
  int rank;
  PetscCallMPI(MPI_Comm_rank(comm_, &rank));
  std::string failure;
  if (rank == 0) {
    failure = RemoveAll(leftovers_);
    if (failure.empty()) failure = SceneFile(dir_);
    const std::string path = dir_ + "/histories.csv", part = path + ".part";
    std::error_code code;
    if (failure.empty() && csv_bytes_ >= 0) {
      fs::copy_file(path, part, fs::copy_options::overwrite_existing, code);
      if (!code) fs::resize_file(part, static_cast<std::uintmax_t>(csv_bytes_), code);
      if (!code) fs::rename(part, path, code);
      if (code) failure = "cannot cut " + path + " back to step " + std::to_string(step_) + ": " + code.message();
    }
  }
  PetscCall(CheckFailure(comm_, failure));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode EarlierRun::RemoveLater() {
  PetscFunctionBeginUser;
  PetscCall(CheckFailure(comm_, RemoveAll(later_)));
  PetscFunctionReturn(PETSC_SUCCESS);
}

}  // namespace cdem
