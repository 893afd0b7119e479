#include "io/blocks.hpp"

#include "core/error.hpp"

#include <algorithm>

namespace cdem {

PetscErrorCode CreateWantedBlocks(MPI_Comm comm, const std::vector<std::int64_t> &numbers, std::int64_t total,
                                  const char *what, PetscSF *sf, Hdf5Block *block) {
  PetscFunctionBeginUser;
  CdemCheck(total <= PETSC_INT_MAX, comm, "%lld %s are too many for a PETSc with 32-bit integers",
            static_cast<long long>(total), what);
  PetscLayout layout;
  PetscInt begin, end;
  PetscCall(PetscLayoutCreateFromSizes(comm, PETSC_DECIDE, static_cast<PetscInt>(total), 1, &layout));
  PetscCall(PetscLayoutGetRange(layout, &begin, &end));
  *block = {static_cast<hsize_t>(total), static_cast<hsize_t>(begin), static_cast<hsize_t>(end - begin)};

  const bool good = std::all_of(numbers.begin(), numbers.end(), [&](std::int64_t i) { return i >= 0 && i < total; });
  int bad = !good, any_bad;
  std::vector<PetscSFNode> roots(numbers.size());
  for (std::size_t i = 0; good && i < numbers.size(); ++i) {
    PetscMPIInt owner;
    PetscCall(PetscLayoutFindOwnerIndex(layout, static_cast<PetscInt>(numbers[i]), &owner, &roots[i].index));
    roots[i].rank = owner;
  }
  PetscCall(PetscLayoutDestroy(&layout));
  PetscCallMPI(MPI_Allreduce(&bad, &any_bad, 1, MPI_INT, MPI_MAX, comm));
  PetscCheck(!any_bad, comm, PETSC_ERR_PLIB, "global numbers of %s are not within 0 and their count", what);
  PetscCall(PetscSFDestroy(sf));
  PetscCall(PetscSFCreate(comm, sf));
  PetscCall(PetscSFSetGraph(*sf, end - begin, static_cast<PetscInt>(numbers.size()), nullptr, PETSC_COPY_VALUES,
                            roots.data(), PETSC_COPY_VALUES));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CreateBlocks(MPI_Comm comm, const std::vector<std::int64_t> &numbers, const char *what, PetscSF *sf,
                            Hdf5Block *block) {
  PetscFunctionBeginUser;
  const std::int64_t n = static_cast<std::int64_t>(numbers.size());
  std::int64_t total;
  PetscCallMPI(MPI_Allreduce(&n, &total, 1, MPI_INT64_T, MPI_SUM, comm));
  PetscCall(CreateWantedBlocks(comm, numbers, total, what, sf, block));
  const PetscInt *degree;
  PetscCall(PetscSFComputeDegreeBegin(*sf, &degree));
  PetscCall(PetscSFComputeDegreeEnd(*sf, &degree));
  int bad = !std::all_of(degree, degree + block->rows, [](PetscInt d) { return d == 1; }), any_bad;
  PetscCallMPI(MPI_Allreduce(&bad, &any_bad, 1, MPI_INT, MPI_MAX, comm));
  PetscCheck(!any_bad, comm, PETSC_ERR_PLIB, "global numbers of %s are not given once each", what);
  PetscFunctionReturn(PETSC_SUCCESS);
}

}  // namespace cdem
