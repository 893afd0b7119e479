// What an earlier run has left in the output folder in which a restarted one goes on: frames and rows up to the step of the
// checkpoint stay, what is later goes, once everything has been checked.
#pragma once
#include "core/petsc.hpp"

#include <map>
#include <string>
#include <vector>

namespace cdem {

/// A frame that is there.
struct KeptFrame {
  long long number = 0, step = 0;  ///< number in its name
  double time = 0;                 ///< s
};

class EarlierRun {
 public:
  /// Whether a file lies in this folder.
  static bool Holds(const std::string &dir, const std::string &file);

  /// Looks at a folder and changes nothing (collective). [in] columns: first line of histories.csv as this run would have
  /// it, "" if it has none. Errors: other columns there, a frame that cannot be read.
  PetscErrorCode Look(MPI_Comm comm, const std::string &dir, PetscInt step, const std::string &columns);
  /// Cuts histories.csv back, writes scene.opts, removes summary.json and what a killed run has left.
  PetscErrorCode Begin();
  /// Frames of a series up to the step, in their order; on all ranks.
  const std::vector<KeptFrame> &Frames(const std::string &series) { return kept_[series]; }
  /// Removes the frames and checkpoints after the step; the series name them no more by now.
  PetscErrorCode RemoveLater();

 private:
  std::string LookAt(const std::string &columns);
  std::string ScanHistories(const std::string &columns);

  MPI_Comm comm_ = MPI_COMM_NULL;
  std::string dir_;
  PetscInt step_ = 0;
  std::map<std::string, std::vector<KeptFrame>> kept_;
  std::vector<std::string> later_, leftovers_;  // paths; rank 0
  long long csv_bytes_ = -1;                    // of histories.csv that stay; -1: there is none; rank 0
};

}  // namespace cdem
