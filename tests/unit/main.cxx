// Unit tests run inside PETSc, which sees no option of the command line.
#include "core/error.hpp"
#include "core/start.hpp"

#include <cstdlib>
#include <filesystem>
#include <gtest/gtest.h>
#include <string>
#include <unistd.h>

namespace {

/// Open MPI 4 starts a daemon for a process that mpirun has not started, unless it is told that the process stays alone:
/// 0.3 s of each test. Such processes share the name of a folder, so each has its own place for it.
class Alone {
 public:
  Alone() {
    if (std::getenv("OMPI_COMM_WORLD_SIZE")) return;
    folder_ = std::filesystem::temp_directory_path() / ("cdem_unit_" + std::to_string(getpid()));
    setenv("OMPI_MCA_ess_singleton_isolated", "1", 1);
    setenv("OMPI_MCA_orte_tmpdir_base", folder_.c_str(), 1);
  }
  ~Alone() {
    std::error_code ignored;
    if (!folder_.empty()) std::filesystem::remove_all(folder_, ignored);
  }

 private:
  std::filesystem::path folder_;
};

}  // namespace

int main(int argc, char **argv) {
  testing::InitGoogleTest(&argc, argv);
  const Alone alone;
  int bare = 1;
  if (cdem::PrepareGpuMpi()) return 1;
  if (PetscInitialize(&bare, &argv, nullptr, nullptr)) return 1;
  if (cdem::InstallErrorHandler()) return 1;
  const int failed = RUN_ALL_TESTS();
  return PetscFinalize() ? 1 : failed;
}
