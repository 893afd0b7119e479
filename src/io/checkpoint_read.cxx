#include "core/checksum.hpp"
#include "core/error.hpp"
#include "core/random.hpp"
#include "io/blocks.hpp"
#include "io/checkpoint.hpp"
#include "io/checkpoint_layout.hpp"

#include <algorithm>

namespace cdem {

namespace {

/// The part of a number of rows that this rank reads for the checksum.
void MyShare(MPI_Comm comm, std::int64_t rows, std::int64_t *begin, std::int64_t *end) {
  int rank = 0, size = 1;
  MPI_Comm_rank(comm, &rank);
  MPI_Comm_size(comm, &size);
  const std::int64_t share = rows / size, more = rows % size;
  *begin = share * rank + std::min<std::int64_t>(rank, more);
  *end = *begin + share + (rank < more);
}

std::vector<GivenOption> ParseOptions(const std::string &text) {
  std::vector<GivenOption> options;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    const std::string line = text.substr(at, end - at);
    const std::size_t tab = line.find('\t');
    at = end + 1;
    if (line.empty()) continue;
    const bool has_value = tab != std::string::npos;
    options.push_back({line.substr(0, tab), has_value ? line.substr(tab + 1) : "", has_value});
  }
  return options;
}

}  // namespace

PetscErrorCode CheckpointReader::Open(MPI_Comm comm, const std::string &path) {
  PetscFunctionBeginUser;
  comm_ = comm;
  path_ = path;
  file_ = std::make_unique<Hdf5Reader>(comm, path);
  const std::string foreign = "is no checkpoint: give -restart one of the files checkpoint_<step>.h5 of a run";
  PetscCall(file_->Open(checkpoint::kTop, foreign));
  CdemCheck(file_->Word("Type") == checkpoint::kType, comm, "%s %s", path.c_str(), foreign.c_str());
  const long long version = file_->Integer("Version");
  CdemCheck(version >= 1 && version <= checkpoint::kVersion, comm,
            "%s has the layout %lld of another cdem; this one reads layouts 1 to %d", path.c_str(), version,
            checkpoint::kVersion);
  PetscCall(CheckContent());
  for (const std::string &name : file_->Datasets()) {
    if (name.rfind("numbers/", 0) != 0) continue;
    double value = 0;
    file_->Read(name, H5T_NATIVE_DOUBLE, 0, 1, &value);
    numbers_[name.substr(8)] = value;
  }
  PetscCall(file_->Check());
  for (const char *name : checkpoint::kNumbers)
    CdemCheck(numbers_.count(name) > 0, comm, "%s lacks the number '%s': it was written by another cdem", path.c_str(),
              name);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/// Every rank reads its share of every dataset, and the checksum of all of them must be that of the file.
PetscErrorCode CheckpointReader::CheckContent() {
  PetscFunctionBeginUser;
  constexpr std::int64_t kMostBytes = 1 << 24;
  std::uint64_t sum = 0;
  std::vector<char> data;
  const std::vector<std::string> names = file_->Datasets();
  PetscCall(file_->Check());
  for (const std::string &name : names) {
    const std::int64_t rows = file_->Rows(name), bytes = static_cast<std::int64_t>(file_->RowBytes(name));
    std::int64_t begin, end;
    MyShare(comm_, std::max<std::int64_t>(rows, 0), &begin, &end);
    const std::int64_t most = std::max<std::int64_t>(1, kMostBytes / std::max<std::int64_t>(bytes, 1));
    for (std::int64_t at = begin; at < end && bytes > 0 && file_->failure().empty(); at += most) {
      const std::int64_t n = std::min(most, end - at);
      data.resize(static_cast<std::size_t>(n * bytes));
      file_->ReadAsStored(name, at, n, data.data());
      sum += SumOfRows(KeyNumber(name), static_cast<std::uint64_t>(at), static_cast<std::size_t>(n),
                       static_cast<std::size_t>(bytes), data.data());
    }
  }
  PetscCall(file_->Check());
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &sum, 1, MPI_UINT64_T, MPI_SUM, comm_));
  CdemCheck(static_cast<std::int64_t>(sum) == file_->Integer("Checksum"), comm_,
            "%s is damaged: its content does not have its checksum; take an earlier checkpoint", path_.c_str());
  PetscFunctionReturn(PETSC_SUCCESS);
}

double CheckpointReader::Number(const char *name) const {
  const auto found = numbers_.find(name);
  return found == numbers_.end() ? 0 : found->second;
}

PetscErrorCode CheckpointReader::ReadText(const std::string &name, std::string *text) {
  PetscFunctionBeginUser;
  const std::int64_t length = std::max<std::int64_t>(0, file_->Rows(name));
  text->resize(static_cast<std::size_t>(length));
  file_->Read(name, H5T_NATIVE_UINT8, 0, length, &(*text)[0]);
  PetscCall(file_->Check());
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CheckpointReader::CheckScene(const CheckpointScene &scene) {
  PetscFunctionBeginUser;
  std::string text;
  PetscCall(ReadText("scene/options", &text));
  Fingerprint was;
  for (const auto &[what, now] : scene.fingerprint) {
    std::int64_t value = 0;
    if (file_->Rows("scene/" + what) != 1) continue;
    file_->Read("scene/" + what, H5T_NATIVE_INT64, 0, 1, &value);
    was.emplace_back(what, value);
  }
  PetscCall(file_->Check());
  const std::string model = FingerprintDifference(was, scene.fingerprint);
  const std::string options = SceneDifference(ParseOptions(text), scene.options, scene.stage);
  const std::string unsaid =
      std::string(
          " (the options that describe it are the same: the content of a file that they name is another, or "
          "-mesh or -dm_refine is") +
      (scene.stage > 0 ? ", or how long an earlier stage runs)" : ")");
  const std::string reason = options.empty() ? model + unsaid : options + (model.empty() ? "" : " (" + model + ")");
  CdemCheck(options.empty() && model.empty(), comm_,
            "%s is a checkpoint of another scene: %s. How long it runs, output, monitors, histories, device, ranks, "
            "-ts_dt and later stages may change, nothing else",
            path_.c_str(), reason.c_str());
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CheckpointReader::ReadHistory(const HistoryRows &kind, Histories *history) {
  PetscFunctionBeginUser;
  const std::string head = kind.name + "/";
  const std::int64_t total = file_->Rows(head + "state");
  CdemCheck(total == kind.total, comm_, "%s has %lld rows of %s, and the scene %lld: it was written by another cdem",
            path_.c_str(), static_cast<long long>(total), kind.name.c_str(), static_cast<long long>(kind.total));
  PetscSF sf = nullptr;
  Hdf5Block b;
  PetscCall(CreateWantedBlocks(comm_, kind.number, kind.total, kind.name.c_str(), &sf, &b));
  const std::int64_t offset = static_cast<std::int64_t>(b.offset), rows = static_cast<std::int64_t>(b.rows);
  const std::size_t n = kind.number.size();
  HistoryData data;
  std::vector<std::int64_t> place(b.rows * static_cast<std::size_t>(kind.places)), my_place(n * kind.places);
  std::vector<std::uint8_t> state(b.rows);
  std::vector<double> value(b.rows * static_cast<std::size_t>(kind.states)), time(kind.timed ? b.rows : 0);
  data.state.resize(n);
  data.value.resize(n * static_cast<std::size_t>(kind.states));
  data.broken_time.resize(kind.timed ? n : 0);
  int width = 0;
  file_->Rows(head + "value", &width);
  CdemCheck(kind.states == 0 || width == std::max(kind.states, 1), comm_,
            "%s has %d numbers a row of %s, and this cdem %d: it was written by another one", path_.c_str(), width,
            kind.name.c_str(), kind.states);
  file_->Read(head + "place", H5T_NATIVE_INT64, offset, rows, place.data());
  file_->Read(head + "state", H5T_NATIVE_UINT8, offset, rows, state.data());
  if (kind.states > 0) file_->Read(head + "value", H5T_NATIVE_DOUBLE, offset, rows, value.data());
  if (kind.timed) file_->Read(head + "broken_time", H5T_NATIVE_DOUBLE, offset, rows, time.data());
  PetscCall(file_->Check());
  PetscCall(FromBlock(sf, MPI_INT64_T, kind.places, place, my_place.data()));
  PetscCall(FromBlock(sf, MPI_UINT8_T, 1, state, data.state.data()));
  if (kind.states > 0) PetscCall(FromBlock(sf, MPI_DOUBLE, kind.states, value, data.value.data()));
  if (kind.timed) PetscCall(FromBlock(sf, MPI_DOUBLE, 1, time, data.broken_time.data()));
  PetscCall(PetscSFDestroy(&sf));
  PetscCall(CheckFailure(comm_, my_place == kind.place ? ""
                                                       : path_ + " has its " + kind.name +
                                                             " in another order: it was written by another cdem"));
  PutRows(kind, data, history);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CheckpointReader::ReadNodes(const CheckpointScene &scene, const std::string &name,
                                           std::vector<double> *values) {
  PetscFunctionBeginUser;
  values->clear();
  int width = 0;
  const std::string set = "nodes/" + name;
  const std::int64_t total = file_->Rows(set, &width);
  if (total < 0) PetscFunctionReturn(PETSC_SUCCESS);
  CdemCheck(total == scene.nodes->n_global && width == 3, comm_, "%s: its %s are not those of %lld nodes",
            path_.c_str(), set.c_str(), static_cast<long long>(scene.nodes->n_global));
  PetscSF sf = nullptr;
  Hdf5Block b;
  PetscCall(CreateWantedBlocks(comm_, scene.nodes->global, scene.nodes->n_global, "nodes", &sf, &b));
  std::vector<double> block(3 * b.rows);
  file_->Read(set, H5T_NATIVE_DOUBLE, static_cast<std::int64_t>(b.offset), static_cast<std::int64_t>(b.rows),
              block.data());
  PetscCall(file_->Check());
  values->resize(3 * static_cast<std::size_t>(scene.tables->n_owned));
  PetscCall(FromBlock(sf, MPI_DOUBLE, 3, block, values->data()));
  PetscCall(PetscSFDestroy(&sf));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CheckpointReader::ReadState(const CheckpointScene &scene, std::vector<double> *u, std::vector<double> *v,
                                           Histories *history) {
  PetscFunctionBeginUser;
  const Tables &tables = *scene.tables;
  for (auto [name, field] : {std::pair<const char *, std::vector<double> *>{"displacement", u}, {"velocity", v}}) {
    CdemCheck(file_->Rows(std::string("nodes/") + name) >= 0, comm_, "%s lacks the %s of the nodes", path_.c_str(),
              name);
    PetscCall(ReadNodes(scene, name, field));
  }
  *history = Histories{StartElements(tables), StartSprings(tables)};
  std::vector<HistoryRows> kinds;
  PetscCall(FindHistoryRows(*scene.mesh, *scene.nodes, tables, &kinds));
  for (const HistoryRows &kind : kinds) PetscCall(ReadHistory(kind, history));
  PetscFunctionReturn(PETSC_SUCCESS);
}

}  // namespace cdem
