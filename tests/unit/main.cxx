// Unit tests run inside PETSc, which sees no option of the command line.
#include "core/error.hpp"
#include "core/start.hpp"

#include <gtest/gtest.h>

int main(int argc, char **argv) {
  testing::InitGoogleTest(&argc, argv);
  int bare = 1;
  if (cdem::PrepareGpuMpi()) return 1;
  if (PetscInitialize(&bare, &argv, nullptr, nullptr)) return 1;
  if (cdem::InstallErrorHandler()) return 1;
  const int failed = RUN_ALL_TESTS();
  return PetscFinalize() ? 1 : failed;
}
