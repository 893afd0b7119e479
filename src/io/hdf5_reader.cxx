#include "io/hdf5_reader.hpp"

#include "core/error.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <sys/stat.h>
#include <unistd.h>

namespace cdem {

Hdf5Reader::Hdf5Reader(MPI_Comm comm, std::string path) : comm_(comm), path_(std::move(path)) {
  H5Eget_auto2(H5E_DEFAULT, &printer_, &printer_data_);
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
}

Hdf5Reader::~Hdf5Reader() {
  if (top_ >= 0) H5Gclose(top_);
  if (file_ >= 0) H5Fclose(file_);
  H5Eset_auto2(H5E_DEFAULT, printer_, printer_data_);
}

void Hdf5Reader::Fail(const std::string &what) {
  if (failure_.empty()) failure_ = what;
}

PetscErrorCode Hdf5Reader::Check() { return CheckFailure(comm_, failure_); }

std::string Hdf5Reader::OpenAlone(const char *top, const std::string &foreign) {
  struct stat info;
  if (stat(path_.c_str(), &info) != 0 || access(path_.c_str(), R_OK) != 0)
    return failure_ = "cannot read " + path_ + ": " + std::strerror(errno);
  if (!S_ISREG(info.st_mode)) return failure_ = path_ + " is no file";
  if (H5Fis_hdf5(path_.c_str()) <= 0) return failure_ = path_ + " is no HDF5 file, or only the beginning of one";
  file_ = H5Fopen(path_.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  if (file_ < 0) return failure_ = path_ + " is cut short or damaged: HDF5 cannot open it";
  if (H5Lexists(file_, top, H5P_DEFAULT) > 0) top_ = H5Gopen2(file_, top, H5P_DEFAULT);
  if (top_ < 0) failure_ = path_ + " " + foreign;
  return failure_;
}

PetscErrorCode Hdf5Reader::Open(const char *top, const std::string &foreign) {
  PetscFunctionBeginUser;
  (void)OpenAlone(top, foreign);
  PetscCall(Check());
  PetscFunctionReturn(PETSC_SUCCESS);
}

std::int64_t Hdf5Reader::Integer(const char *name) {
  std::int64_t values[8] = {-1};
  if (top_ < 0 || H5Aexists(top_, name) <= 0) return -1;
  const hid_t attribute = H5Aopen(top_, name, H5P_DEFAULT), space = H5Aget_space(attribute);
  if (H5Sget_simple_extent_npoints(space) > 8 || H5Aread(attribute, H5T_NATIVE_INT64, values) < 0) values[0] = -1;
  H5Sclose(space);
  H5Aclose(attribute);
  return values[0];
}

std::string Hdf5Reader::Word(const char *name) {
  std::string word;
  if (top_ < 0 || H5Aexists(top_, name) <= 0) return word;
  const hid_t attribute = H5Aopen(top_, name, H5P_DEFAULT), type = H5Aget_type(attribute);
  if (H5Tget_class(type) == H5T_STRING && H5Tis_variable_str(type) == 0 && H5Tget_size(type) < 4096) {
    word.resize(H5Tget_size(type));
    if (H5Aread(attribute, type, &word[0]) < 0) word.clear();
  }
  H5Tclose(type);
  H5Aclose(attribute);
  return word;
}

std::vector<std::string> Hdf5Reader::Datasets() {
  std::vector<std::string> names;
  const H5L_iterate_t add = [](hid_t group, const char *name, const H5L_info_t *link, void *list) -> herr_t {
    if (link->type != H5L_TYPE_HARD) return 0;
    const hid_t object = H5Oopen(group, name, H5P_DEFAULT);
    if (object < 0) return -1;
    if (H5Iget_type(object) == H5I_DATASET) static_cast<std::vector<std::string> *>(list)->push_back(name);
    H5Oclose(object);
    return 0;
  };
  if (H5Lvisit(top_, H5_INDEX_NAME, H5_ITER_INC, add, &names) < 0) Fail(path_ + " is damaged: its list of contents");
  std::sort(names.begin(), names.end());
  return names;
}

std::int64_t Hdf5Reader::Rows(const std::string &name, int *components) {
  hsize_t size[2] = {0, 0};
  const std::size_t slash = name.find('/');
  if (slash != std::string::npos && H5Lexists(top_, name.substr(0, slash).c_str(), H5P_DEFAULT) <= 0) return -1;
  if (H5Lexists(top_, name.c_str(), H5P_DEFAULT) <= 0) return -1;
  const hid_t set = H5Dopen2(top_, name.c_str(), H5P_DEFAULT);
  if (set < 0) return -1;
  const hid_t space = H5Dget_space(set);
  const int dimensions = H5Sget_simple_extent_ndims(space);
  if (dimensions == 1 || dimensions == 2) H5Sget_simple_extent_dims(space, size, nullptr);
  H5Sclose(space);
  H5Dclose(set);
  if (dimensions < 1 || dimensions > 2) return -1;
  if (components) *components = static_cast<int>(size[1]);
  return static_cast<std::int64_t>(size[0]);
}

std::size_t Hdf5Reader::RowBytes(const std::string &name) {
  int components = 0;
  if (Rows(name, &components) < 0) return 0;
  const hid_t set = H5Dopen2(top_, name.c_str(), H5P_DEFAULT), type = H5Dget_type(set);
  const std::size_t size = H5Tget_size(type);
  H5Tclose(type);
  H5Dclose(set);
  return size * static_cast<std::size_t>(std::max(components, 1));
}

void Hdf5Reader::ReadAsStored(const std::string &name, std::int64_t offset, std::int64_t rows, void *data) {
  const hid_t set = H5Dopen2(top_, name.c_str(), H5P_DEFAULT), type = H5Dget_type(set);
  Read(name, type, offset, rows, data);
  H5Tclose(type);
  H5Dclose(set);
}

void Hdf5Reader::Read(const std::string &name, hid_t memory, std::int64_t offset, std::int64_t rows, void *data) {
  int components = 0;
  const std::int64_t total = Rows(name, &components);
  if (total < 0) return Fail(path_ + " is damaged or incomplete: there is no dataset " + name + " that can be read");
  if (offset + rows > total) return Fail(path_ + " is damaged: its dataset " + name + " is too short");
  if (rows == 0) return;
  const hid_t set = H5Dopen2(top_, name.c_str(), H5P_DEFAULT), space = H5Dget_space(set);
  const int dimensions = H5Sget_simple_extent_ndims(space);
  const hsize_t start[2] = {static_cast<hsize_t>(offset), 0};
  const hsize_t count[2] = {static_cast<hsize_t>(rows), static_cast<hsize_t>(components)};
  const hid_t here = H5Screate_simple(dimensions, count, nullptr);
  H5Sselect_hyperslab(space, H5S_SELECT_SET, start, nullptr, count, nullptr);
  if (H5Dread(set, memory, here, space, H5P_DEFAULT, data) < 0)
    Fail(path_ + " is damaged: its dataset " + name + " cannot be read");
  H5Sclose(here);
  H5Sclose(space);
  H5Dclose(set);
}

}  // namespace cdem
