// One HDF5 file that all ranks write together.
#pragma once
#include "core/petsc.hpp"

#include <hdf5.h>
#include <string>
#include <vector>

namespace cdem {

/// This rank's contiguous rows of a dataset.
struct Hdf5Block {
  hsize_t total, offset, rows;
};

/// A file written collectively: every rank makes the same calls, whatever fails on it. The first failure is kept; Open,
/// Write and Finish tell all ranks of it, as one clear error, and nothing stays of the file. Its bytes do not depend on
/// the ranks or the time of day.
class Hdf5File {
 public:
  /// Silences HDF5's own printing while it lives. path is the temporary name.
  Hdf5File(MPI_Comm comm, std::string path);
  ~Hdf5File();
  Hdf5File(const Hdf5File &) = delete;
  Hdf5File &operator=(const Hdf5File &) = delete;

  /// Creates the file with its top group. bytes: of all the data to come, refused here when there is no room for them.
  PetscErrorCode Open(const char *top, std::int64_t bytes);
  /// The top group, and a new group in it.
  hid_t top() const { return top_; }
  hid_t Group(const char *name);
  /// Attributes of the top group: a vector of integers (int64), a word (fixed length, ASCII).
  void Integers(const char *name, const std::vector<std::int64_t> &values);
  void Word(const char *name, const std::string &word);
  /// Makes name in the top group stand for target of another file, named relative to this one.
  void Link(const char *name, const std::string &file, const std::string &target);
  /// A dataset [total][components], or [total] where components is 0; type in the file, memory that of data (host).
  PetscErrorCode Write(hid_t group, const char *name, hid_t type, hid_t memory, const Hdf5Block &block, int components,
                       const void *data);
  /// Closes the file and gives it its name: from now on it counts as written. [in] durable: when it has the name, it is on
  /// the disk, and outlives a loss of power too.
  PetscErrorCode Finish(const std::string &name, bool durable = false);

 private:
  template <class T>
  T Keep(T result);
  PetscErrorCode Check();
  void PutAttribute(const char *name, hid_t type, hid_t memory, hid_t space, const void *data);
  void Close();

  MPI_Comm comm_;
  int rank_ = 0;
  bool abandoned_ = false;
  std::string path_, failure_;
  hid_t file_ = -1, top_ = -1, transfer_ = -1, dataset_ = -1;
  std::vector<hid_t> groups_;
  H5E_auto2_t printer_ = nullptr;
  void *printer_data_ = nullptr;
};

}  // namespace cdem
