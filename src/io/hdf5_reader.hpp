// One HDF5 file that ranks read, each what it wants.
#pragma once
#include "io/hdf5_file.hpp"

#include <cstdint>

namespace cdem {

/// Reads what Hdf5File writes. Calls of one rank alone keep the first failure; Open and Check tell all ranks of it, as one
/// clear error.
class Hdf5Reader {
 public:
  /// Silences HDF5's own printing while it lives.
  Hdf5Reader(MPI_Comm comm, std::string path);
  ~Hdf5Reader();
  Hdf5Reader(const Hdf5Reader &) = delete;
  Hdf5Reader &operator=(const Hdf5Reader &) = delete;

  /// Opens the file and its top group; [in] foreign: what to say of an HDF5 file without it. Collective.
  PetscErrorCode Open(const char *top, const std::string &foreign);
  /// The same for a file that one rank alone reads; the text of the failure, or "".
  std::string OpenAlone(const char *top, const std::string &foreign);
  /// Raises the first failure of any rank. Collective.
  PetscErrorCode Check();
  const std::string &failure() const { return failure_; }

  /// Attributes of the top group; -1 and "" where they are missing.
  std::int64_t Integer(const char *name);
  std::string Word(const char *name);
  /// Paths of all datasets below the top group, in the order of their names.
  std::vector<std::string> Datasets();
  /// Rows of a dataset and values a row (0: it has one dimension); rows -1: there is none.
  std::int64_t Rows(const std::string &name, int *components = nullptr);
  /// Reads rows [offset, offset + rows) into data.
  void Read(const std::string &name, hid_t memory, std::int64_t offset, std::int64_t rows, void *data);
  /// Bytes of a row of a dataset of those rows, and the rows as they are in memory, for checksums.
  std::size_t RowBytes(const std::string &name);
  void ReadAsStored(const std::string &name, std::int64_t offset, std::int64_t rows, void *data);

 private:
  void Fail(const std::string &what);

  MPI_Comm comm_;
  std::string path_, failure_;
  hid_t file_ = -1, top_ = -1;
  H5E_auto2_t printer_ = nullptr;
  void *printer_data_ = nullptr;
};

}  // namespace cdem
