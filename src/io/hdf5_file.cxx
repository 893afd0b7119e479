#include "io/hdf5_file.hpp"

#include "io/safe_file.hpp"

#include <algorithm>
#include <fcntl.h>
#include <filesystem>
#include <unistd.h>

namespace cdem {

namespace {

std::string SpaceLeft(const std::string &path) {
  std::error_code code;
  const auto space = std::filesystem::space(path, code);
  return code ? "" : " (" + std::to_string(space.available >> 20) + " MB are left there)";
}

// Asks the file system for the room before anything is written; the text of the failure, or "". A full disk met later,
// inside MPI-IO, gives no reason and can leave ranks waiting for each other.
std::string Reserve(const std::string &path, std::int64_t bytes) {
  const int file = open(path.c_str(), O_WRONLY | O_CREAT, 0666);
  if (file < 0) return "cannot write " + path + ": " + std::strerror(errno);
  int code = fallocate(file, FALLOC_FL_KEEP_SIZE, 0, bytes) == 0 ? 0 : errno;
  if (code == EOPNOTSUPP || code == ENOSYS) {  // as on NFS
    std::error_code unknown;
    const auto space = std::filesystem::space(path, unknown);
    code = !unknown && space.available < static_cast<std::uintmax_t>(bytes) ? ENOSPC : 0;
  }
  close(file);
  if (code != ENOSPC && code != EDQUOT && code != EFBIG) return "";
  const std::string failure = "cannot write " + path + " of " + std::to_string((bytes >> 20) + 1) + " MB: ";
  return failure + std::strerror(code) + SpaceLeft(path);
}

// Waits until a file, or the names in a folder, are on the disk.
bool OnDisk(const std::string &path) {
  const int file = open(path.empty() ? "." : path.c_str(), O_RDONLY);
  if (file < 0) return false;
  const bool good = fsync(file) == 0;
  const int code = errno;
  close(file);
  errno = code;
  return good;
}

}  // namespace

Hdf5File::Hdf5File(MPI_Comm comm, std::string path) : comm_(comm), path_(std::move(path)) {
  MPI_Comm_rank(comm, &rank_);
  H5Eget_auto2(H5E_DEFAULT, &printer_, &printer_data_);
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);  // failures become one message of ours
}

Hdf5File::~Hdf5File() {
  const bool unfinished = file_ >= 0;
  // After a failed write HDF5 would try again in closing, on some ranks only, and the others would wait for ever.
  if (!abandoned_) Close();
  if (unfinished && rank_ == 0) std::remove(path_.c_str());
  H5Eset_auto2(H5E_DEFAULT, printer_, printer_data_);
}

// Keeps the first failure, with HDF5's innermost reason.
template <class T>
T Hdf5File::Keep(T result) {
  if (result >= 0 || !failure_.empty()) return result;
  failure_ = "cannot write " + path_ + ": ";
  const H5E_walk2_t innermost = [](unsigned n, const H5E_error2_t *error, void *text) -> herr_t {
    if (n == 0 && error->desc) *static_cast<std::string *>(text) += error->desc;
    return 0;
  };
  H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, innermost, &failure_);
  failure_ += SpaceLeft(path_);
  return result;
}

PetscErrorCode Hdf5File::Check() { return CheckFailure(comm_, failure_); }

PetscErrorCode Hdf5File::Open(const char *top, std::int64_t bytes) {
  PetscFunctionBeginUser;
  bytes += 65536;  // HDF5's own
  if (rank_ == 0) {
    failure_ = Reserve(path_, bytes);
    if (!failure_.empty()) std::remove(path_.c_str());
  }
  PetscCall(Check());
  const hid_t access = Keep(H5Pcreate(H5P_FILE_ACCESS));
  Keep(H5Pset_fapl_mpio(access, comm_, MPI_INFO_NULL));
  file_ = Keep(H5Fcreate(path_.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, access));
  H5Pclose(access);
  transfer_ = Keep(H5Pcreate(H5P_DATASET_XFER));
  Keep(H5Pset_dxpl_mpio(transfer_, H5FD_MPIO_INDEPENDENT));  // of contiguous blocks: as fast, and a failing rank
                                                             // does not leave the others waiting for it
  dataset_ = Keep(H5Pcreate(H5P_DATASET_CREATE));
  Keep(H5Pset_fill_time(dataset_, H5D_FILL_TIME_NEVER));
  Keep(H5Pset_obj_track_times(dataset_, false));
  PetscCall(Check());
  if (rank_ == 0) Reserve(path_, bytes);  // creating the file has let go of it
  top_ = file_;
  top_ = Group(top);
  PetscCall(Check());
  PetscFunctionReturn(PETSC_SUCCESS);
}

hid_t Hdf5File::Group(const char *name) {
  groups_.push_back(Keep(H5Gcreate2(top_, name, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT)));
  return groups_.back();
}

void Hdf5File::PutAttribute(const char *name, hid_t type, hid_t memory, hid_t space, const void *data) {
  const hid_t attribute = Keep(H5Acreate2(top_, name, type, space, H5P_DEFAULT, H5P_DEFAULT));
  Keep(H5Awrite(attribute, memory, data));
  Keep(H5Aclose(attribute));
  H5Sclose(space);
}

void Hdf5File::Integers(const char *name, const std::vector<std::int64_t> &values) {
  const hsize_t size = values.size();
  PutAttribute(name, H5T_STD_I64LE, H5T_NATIVE_INT64, H5Screate_simple(1, &size, nullptr), values.data());
}

void Hdf5File::Word(const char *name, const std::string &word) {
  const hid_t type = Keep(H5Tcopy(H5T_C_S1));
  Keep(H5Tset_size(type, word.size()));
  Keep(H5Tset_strpad(type, H5T_STR_NULLPAD));
  PutAttribute(name, type, type, H5Screate(H5S_SCALAR), word.data());
  H5Tclose(type);
}

void Hdf5File::Link(const char *name, const std::string &file, const std::string &target) {
  Keep(H5Lcreate_external(file.c_str(), target.c_str(), top_, name, H5P_DEFAULT, H5P_DEFAULT));
}

PetscErrorCode Hdf5File::Write(hid_t group, const char *name, hid_t type, hid_t memory, const Hdf5Block &block,
                               int components, const void *data) {
  PetscFunctionBeginUser;
  const int dimensions = components > 0 ? 2 : 1;
  const hsize_t width = static_cast<hsize_t>(components), row = H5Tget_size(memory) * std::max<hsize_t>(width, 1);
  const hsize_t size[2] = {block.total, width};
  const hid_t space = Keep(H5Screate_simple(dimensions, size, nullptr));
  const hid_t set = Keep(H5Dcreate2(group, name, type, space, H5P_DEFAULT, dataset_, H5P_DEFAULT));
  PetscCall(Check());
  const hsize_t most = std::max<hsize_t>((hsize_t{1} << 30) / row, 1);  // MPI counts bytes in 31 bits
  for (hsize_t done = 0; done < block.rows && failure_.empty(); done += most) {
    const hsize_t start[2] = {block.offset + done, 0}, count[2] = {std::min(most, block.rows - done), width};
    const hid_t here = Keep(H5Screate_simple(dimensions, count, nullptr));
    Keep(H5Sselect_hyperslab(space, H5S_SELECT_SET, start, nullptr, count, nullptr));
    Keep(H5Dwrite(set, memory, here, space, transfer_, static_cast<const char *>(data) + done * row));
    H5Sclose(here);
  }
  H5Sclose(space);
  abandoned_ = true;  // unless no rank has failed
  PetscCall(Check());
  abandoned_ = false;
  Keep(H5Dclose(set));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode Hdf5File::Finish(const std::string &name, bool durable) {
  PetscFunctionBeginUser;
  if (durable && failure_.empty()) Keep(H5Fflush(file_, H5F_SCOPE_GLOBAL));  // every rank hands over what it wrote
  Close();
  if (rank_ == 0) {
    std::error_code ignored;  // cutting it to its own size lets go of what was reserved beyond it
    std::filesystem::resize_file(path_, std::filesystem::file_size(path_, ignored), ignored);
    if (durable && failure_.empty() && !OnDisk(path_)) failure_ = "cannot write " + path_ + ": " + std::strerror(errno);
    if (failure_.empty() && std::rename(path_.c_str(), name.c_str()) != 0)
      failure_ = "cannot rename " + path_ + " to " + name + ": " + std::strerror(errno);
    if (!failure_.empty()) std::remove(path_.c_str());
    if (durable && failure_.empty()) (void)OnDisk(std::filesystem::path(name).parent_path());  // not all can do it
  }
  PetscCall(Check());
  PetscFunctionReturn(PETSC_SUCCESS);
}

void Hdf5File::Close() {
  for (const hid_t group : groups_)
    if (group >= 0) Keep(H5Gclose(group));
  groups_.clear();
  for (const hid_t list : {transfer_, dataset_})
    if (list >= 0) H5Pclose(list);
  if (file_ >= 0) Keep(H5Fclose(file_));
  file_ = top_ = transfer_ = dataset_ = -1;
}

}  // namespace cdem
