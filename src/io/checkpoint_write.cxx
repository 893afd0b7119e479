#include "core/checksum.hpp"
#include "core/error.hpp"
#include "core/options.hpp"
#include "core/random.hpp"
#include "io/blocks.hpp"
#include "io/checkpoint.hpp"
#include "io/checkpoint_layout.hpp"
#include "io/result_names.hpp"
#include "io/watch.hpp"

#include <algorithm>
#include <filesystem>

namespace cdem {

namespace fs = std::filesystem;

namespace {

/// A file of which every dataset goes into one checksum.
class SummedFile {
 public:
  SummedFile(MPI_Comm comm, const std::string &path) : comm_(comm), file_(comm, path) {}
  Hdf5File &file() { return file_; }
  PetscErrorCode Group(const std::string &name) {
    group_ = file_.Group(name.c_str());
    group_name_ = name;
    return PETSC_SUCCESS;
  }
  /// Type in the file and in memory are one: native doubles, int64 and bytes are what it holds on every machine there is.
  PetscErrorCode Put(const std::string &name, hid_t type, const Hdf5Block &block, int components, const void *data) {
    PetscFunctionBeginUser;
    PetscCall(file_.Write(group_, name.c_str(), type, type, block, components, data));
    const std::size_t bytes = H5Tget_size(type) * static_cast<std::size_t>(std::max(components, 1));
    sum_ += SumOfRows(KeyNumber(group_name_ + "/" + name), block.offset, block.rows, bytes, data);
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  /// One value, the same on all ranks.
  PetscErrorCode PutOne(const std::string &name, hid_t type, const void *value) {
    int rank;
    PetscFunctionBeginUser;
    PetscCallMPI(MPI_Comm_rank(comm_, &rank));
    PetscCall(Put(name, type, {1, 0, rank == 0 ? 1u : 0u}, 0, value));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  /// Rows of this rank, brought into the order of the file.
  template <class T>
  PetscErrorCode PutRows(const std::string &name, hid_t type, MPI_Datatype mpi, PetscSF sf, const Hdf5Block &block,
                         int components, const T *rows) {
    PetscFunctionBeginUser;
    const int width = std::max(components, 1);
    std::vector<T> values(block.rows * static_cast<std::size_t>(width));
    PetscCall(ToBlock(sf, mpi, width, rows, &values));
    PetscCall(Put(name, type, block, components, values.data()));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscErrorCode Finish(const std::string &name) {
    PetscFunctionBeginUser;
    PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &sum_, 1, MPI_UINT64_T, MPI_SUM, comm_));
    file_.Integers("Checksum", {static_cast<std::int64_t>(sum_)});
    PetscCall(file_.Finish(name, true));
    PetscFunctionReturn(PETSC_SUCCESS);
  }

 private:
  MPI_Comm comm_;
  Hdf5File file_;
  hid_t group_ = -1;
  std::string group_name_;
  std::uint64_t sum_ = 0;
};

PetscErrorCode PutHistory(const CheckpointScene &scene, const HistoryRows &kind, const Histories &history,
                          SummedFile *file) {
  PetscFunctionBeginUser;
  const HistoryData data = TakeRows(kind, history, kind.given);
  std::vector<std::int64_t> number, place;
  for (int row : kind.given) {
    number.push_back(kind.number[row]);
    for (int p = 0; p < kind.places; ++p) place.push_back(kind.place[static_cast<std::size_t>(kind.places) * row + p]);
  }
  PetscSF sf = nullptr;
  Hdf5Block block;
  PetscCall(CreateBlocks(scene.tables->comm, number, kind.name.c_str(), &sf, &block));
  PetscCall(file->Group(kind.name));
  PetscCall(file->PutRows("place", H5T_NATIVE_INT64, MPI_INT64_T, sf, block, kind.places, place.data()));
  PetscCall(file->PutRows("state", H5T_NATIVE_UINT8, MPI_UINT8_T, sf, block, 0, data.state.data()));
  if (kind.states > 0)
    PetscCall(file->PutRows("value", H5T_NATIVE_DOUBLE, MPI_DOUBLE, sf, block, kind.states, data.value.data()));
  if (kind.timed)
    PetscCall(file->PutRows("broken_time", H5T_NATIVE_DOUBLE, MPI_DOUBLE, sf, block, 0, data.broken_time.data()));
  PetscCall(PetscSFDestroy(&sf));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode PutAudit(const CheckpointScene &scene, const AuditRows &rows, const AuditArrays &audit,
                        SummedFile *file) {
  PetscFunctionBeginUser;
  PetscSF sf = nullptr;
  Hdf5Block block;
  const std::vector<double> values = TakeAuditRows(rows, *scene.mesh, *scene.tables, audit);
  PetscCall(CreateBlocks(scene.tables->comm, rows.given, rows.name.c_str(), &sf, &block));
  PetscCall(file->Group(rows.name));
  PetscCall(file->PutRows("value", H5T_NATIVE_DOUBLE, MPI_DOUBLE, sf, block, rows.width, values.data()));
  PetscCall(PetscSFDestroy(&sf));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/// Removes all checkpoints of a folder before the last two up to this step; the text of the failure, or "".
std::string RemoveOld(const std::string &dir, PetscInt step) {
  constexpr std::size_t kKept = 2;
  std::vector<std::pair<long long, fs::path>> there;
  std::error_code code;
  std::string head;
  for (fs::directory_iterator entry(dir, code), end; !code && entry != end; entry.increment(code)) {
    const long long of = NumberIn(entry->path().filename().string(), ".h5", &head);
    if (of >= 0 && of <= step && head == "checkpoint") there.emplace_back(of, entry->path());
  }
  std::sort(there.begin(), there.end());
  for (std::size_t i = 0; !code && i + kKept < there.size(); ++i) fs::remove(there[i].second, code);
  return code ? "cannot remove old checkpoints in " + dir + ": " + code.message() : "";
}

}  // namespace

PetscErrorCode CheckpointWriter::ReadOptions(Options &options, const std::string &dir) {
  PetscFunctionBeginUser;
  dir_ = dir;
  bool by_steps, by_time;
  PetscCall(options.Has("checkpoint_interval", &by_steps));
  PetscCall(options.Has("checkpoint_interval_time", &by_time));
  CdemCheck(!dir.empty() || !(by_steps || by_time), options.comm(),
            "-checkpoint_%s needs a folder for the checkpoints: give -output DIR too",
            by_steps ? "interval" : "interval_time");
  PetscCall(ReadInterval(options, "checkpoint_", &interval_));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CheckpointWriter::Write(const CheckpointScene &scene, PetscInt step, const Numbers &numbers,
                                       const double *u, const double *v, const NodeFields &more,
                                       const Histories &history, const AuditArrays &audit) {
  PetscFunctionBeginUser;
  const MPI_Comm comm = scene.tables->comm;
  int rank;
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  const std::string path = dir_ + "/checkpoint_" + std::to_string(step) + ".h5";
  std::vector<HistoryRows> kinds;
  PetscCall(FindHistoryRows(*scene.mesh, *scene.nodes, *scene.tables, &kinds));
  const std::int64_t vectors = 2 + static_cast<std::int64_t>(more.size());
  std::int64_t bytes = 24 * vectors * static_cast<std::int64_t>(scene.nodes->n_global) + (std::int64_t{1} << 18);
  for (const HistoryRows &kind : kinds) bytes += kind.total * (8 * (kind.places + kind.states + kind.timed) + 1);
  std::vector<AuditRows> audited;
  if (scene.audited) PetscCall(FindAuditRows(*scene.mesh, *scene.nodes, *scene.tables, &audited));
  for (const AuditRows &rows : audited) bytes += 8 * rows.total * rows.width;

  SummedFile file(comm, path + ".part");
  PetscCall(file.file().Open(checkpoint::kTop, bytes));
  file.file().Integers("Version", {checkpoint::kVersion});
  file.file().Word("Type", checkpoint::kType);
  PetscCall(file.Group("numbers"));
  for (const auto &[name, value] : numbers) PetscCall(file.PutOne(name, H5T_NATIVE_DOUBLE, &value));
  PetscCall(file.Group("scene"));
  std::string options;
  for (const GivenOption &option : scene.options)
    options += option.name + (option.has_value ? "\t" + option.value : "") + "\n";
  if (options.empty()) options = "\n";
  const hsize_t length = options.size();
  PetscCall(file.Put("options", H5T_NATIVE_UINT8, {length, 0, rank == 0 ? length : 0}, 0, options.data()));
  for (const auto &[what, value] : scene.fingerprint) PetscCall(file.PutOne(what, H5T_NATIVE_INT64, &value));

  PetscSF sf = nullptr;
  Hdf5Block block;
  PetscCall(CreateBlocks(comm, scene.nodes->global, "nodes", &sf, &block));
  PetscCall(file.Group("nodes"));
  NodeFields fields = {{"displacement", u}, {"velocity", v}};
  fields.insert(fields.end(), more.begin(), more.end());
  for (const auto &[name, values] : fields)
    PetscCall(file.PutRows(name, H5T_NATIVE_DOUBLE, MPI_DOUBLE, sf, block, 3, values));
  PetscCall(PetscSFDestroy(&sf));
  for (const HistoryRows &kind : kinds) PetscCall(PutHistory(scene, kind, history, &file));
  for (const AuditRows &rows : audited) PetscCall(PutAudit(scene, rows, audit, &file));
  PetscCall(file.Finish(path));
  PetscCall(CheckFailure(comm, rank == 0 ? RemoveOld(dir_, step) : ""));
  PetscFunctionReturn(PETSC_SUCCESS);
}

}  // namespace cdem
