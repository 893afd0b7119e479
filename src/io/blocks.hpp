// Rows that ranks hold in any order, and the contiguous blocks of global numbers in which a file holds them: it does not
// depend on the ranks.
#pragma once
#include "io/hdf5_file.hpp"

#include <cstdint>

namespace cdem {

/// Makes the star forest from this rank's rows to the blocks of all ranks (collective), and this rank's block.
/// [in] numbers: global number of each row, from 0 without gaps over all ranks. [in,out] sf: an old one is destroyed.
/// Errors: more than PETSc's integers count; a number that is missing or there twice.
PetscErrorCode CreateBlocks(MPI_Comm comm, const std::vector<std::int64_t> &numbers, const char *what, PetscSF *sf,
                            Hdf5Block *block);

/// The same to take rows out of a file of total rows: a row may be wanted by several ranks, or by none.
PetscErrorCode CreateWantedBlocks(MPI_Comm comm, const std::vector<std::int64_t> &numbers, std::int64_t total,
                                  const char *what, PetscSF *sf, Hdf5Block *block);

/// From rows to the block, and from the block to rows; width: values of the type a row.
template <class T>
PetscErrorCode ToBlock(PetscSF sf, MPI_Datatype type, int width, const T *rows, std::vector<T> *block) {
  PetscFunctionBeginUser;
  MPI_Datatype unit;
  PetscCallMPI(MPI_Type_contiguous(width, type, &unit));
  PetscCallMPI(MPI_Type_commit(&unit));
  PetscCall(PetscSFReduceBegin(sf, unit, rows, block->data(), MPI_REPLACE));
  PetscCall(PetscSFReduceEnd(sf, unit, rows, block->data(), MPI_REPLACE));
  PetscCallMPI(MPI_Type_free(&unit));
  PetscFunctionReturn(PETSC_SUCCESS);
}

template <class T>
PetscErrorCode FromBlock(PetscSF sf, MPI_Datatype type, int width, const std::vector<T> &block, T *rows) {
  PetscFunctionBeginUser;
  MPI_Datatype unit;
  PetscCallMPI(MPI_Type_contiguous(width, type, &unit));
  PetscCallMPI(MPI_Type_commit(&unit));
  PetscCall(PetscSFBcastBegin(sf, unit, block.data(), rows, MPI_REPLACE));
  PetscCall(PetscSFBcastEnd(sf, unit, block.data(), rows, MPI_REPLACE));
  PetscCallMPI(MPI_Type_free(&unit));
  PetscFunctionReturn(PETSC_SUCCESS);
}

}  // namespace cdem
