// The folder of a run: refused when it holds results, scene.opts at the start, histories.csv as the run goes on, and
// summary.json at its end.
#pragma once
#include "core/petsc.hpp"

#include <cstdio>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace cdem {

/// Replaces path by text through a temporary file and a rename, so that a reader or a kill never sees half of it.
/// Call on one rank.
PetscErrorCode WriteFileSafely(const std::string &path, const std::string &text);

/// Makes the folder, or refuses one that holds results unless overwrite (then what an earlier run wrote there is
/// removed, and nothing else); writes scene.opts (every option in force). Collective.
PetscErrorCode PrepareOutputDir(MPI_Comm comm, const std::string &dir, bool overwrite);

/// Writes scene.opts (every option in force); the text of the failure, or "". Call on one rank.
std::string SceneFile(const std::string &dir);

/// histories.csv: a header "step,time,<name>,...", then one row a recorded step, 17 digits. Rows are appended and flushed
/// by rank 0. A failed write is an error.
class HistoryFile {
 public:
  ~HistoryFile();
  /// Its first line, without the end.
  static std::string Header(const std::vector<std::string> &names);
  /// [in] append: goes on behind the rows that are there.
  PetscErrorCode Open(MPI_Comm comm, const std::string &dir, const std::vector<std::string> &names,
                      bool append = false);
  /// values[row][column] on rank 0.
  PetscErrorCode Append(const std::vector<PetscInt> &steps, const std::vector<double> &times,
                        const std::vector<std::vector<double>> &values);

 private:
  MPI_Comm comm_ = MPI_COMM_NULL;
  std::FILE *file_ = nullptr;
  std::string path_;
};

/// summary.json, written safely by rank 0.
PetscErrorCode WriteSummary(MPI_Comm comm, const std::string &dir, const nlohmann::json &summary);

}  // namespace cdem
