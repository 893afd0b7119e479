// Files that a kill or a full disk never leaves half written, and a failure on one rank told to all.
#pragma once
#include "core/error.hpp"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <string>

namespace cdem {

/// Replaces path by text: path.part is written and renamed. Returns what went wrong, or "".
inline std::string ReplaceFile(const std::string &path, const std::string &text) {
  const std::string part = path + ".part";
  std::FILE *file = std::fopen(part.c_str(), "wb");
  if (!file) return "cannot write " + part + ": " + std::strerror(errno);
  bool good = std::fwrite(text.data(), 1, text.size(), file) == text.size() && std::fflush(file) == 0;
  int code = errno;
  if (std::fclose(file) != 0 && good) {
    good = false;
    code = errno;
  }
  if (good && std::rename(part.c_str(), path.c_str()) == 0) return "";
  if (good) code = errno;
  std::remove(part.c_str());
  return "cannot write " + path + ": " + std::strerror(code);
}

/// Raises the failure (not "") of the lowest rank that has one, with the same text on every rank. Collective.
inline PetscErrorCode CheckFailure(MPI_Comm comm, std::string failure) {
  PetscFunctionBeginUser;
  int size, rank, first;
  PetscCallMPI(MPI_Comm_size(comm, &size));
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  const int mine = failure.empty() ? size : rank;
  PetscCallMPI(MPI_Allreduce(&mine, &first, 1, MPI_INT, MPI_MIN, comm));
  if (first == size) PetscFunctionReturn(PETSC_SUCCESS);
  int length = static_cast<int>(failure.size());
  PetscCallMPI(MPI_Bcast(&length, 1, MPI_INT, first, comm));
  failure.resize(static_cast<std::size_t>(length));
  PetscCallMPI(MPI_Bcast(&failure[0], length, MPI_CHAR, first, comm));
  CdemCheck(false, comm, "%s", failure.c_str());
  PetscFunctionReturn(PETSC_SUCCESS);
}

}  // namespace cdem
