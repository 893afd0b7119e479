#include "forces/assembled.hpp"

#include "core/error.hpp"
#include "forces/rows.hpp"

#include <climits>
#include <cstring>

namespace cdem {

PetscErrorCode CheckAssembled(const Tables &tables, bool audited) {
  PetscFunctionBeginUser;
  const std::string why = audited ? "the energy balance is kept (-monitor_energy)" : NoRows(tables);
  CdemCheck(why.empty(), tables.comm, "-central_way assembled: this scene cannot go that way: %s", why.c_str());
  PetscFunctionReturn(PETSC_SUCCESS);
}

/// Whether PETSc has such a matrix on one rank.
static PetscErrorCode HasType(const char *type, bool *has) {
  void (*create)(void) = nullptr;
  PetscFunctionBeginUser;
  *has = false;
  for (const char *head : {"", "seq"}) {
    PetscCall(PetscFunctionListFind(MatList, (std::string(head) + type).c_str(), &create));
    *has = *has || create;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/// Sizes, type and room for the rows.
static PetscErrorCode CreateEmpty(const Tables &t, const StiffnessRows &rows, MatType type, Mat *stiffness) {
  PetscFunctionBeginUser;
  const PetscInt n = 3 * static_cast<PetscInt>(t.n_owned);
  PetscCall(MatCreate(PETSC_COMM_SELF, stiffness));
  PetscCall(MatSetSizes(*stiffness, n, n, n, n));
  PetscCall(MatSetBlockSize(*stiffness, 3));
  PetscCall(MatSetOptionsPrefix(*stiffness, "central_"));
  char given[64] = "";
  PetscBool set = PETSC_FALSE;
  bool has = true;
  PetscCall(PetscOptionsGetString(nullptr, nullptr, "-central_mat_type", given, sizeof given, &set));
  if (set) PetscCall(HasType(given, &has));
  CdemCheck(has, t.comm,
            "-central_mat_type %s: this PETSc has no such matrix; baij, aij, sbaij, and on a GPU aijcusparse are some",
            given);
  PetscCall(MatSetType(*stiffness, type));
  PetscCall(MatSetFromOptions(*stiffness));
  std::vector<PetscInt> all(t.n_owned), upper(t.n_owned);
  for (int i = 0; i < t.n_owned; ++i) {
    all[i] = rows.start[i + 1] - rows.start[i];
    for (int k = rows.start[i]; k < rows.start[i + 1]; ++k) upper[i] += rows.column[k] >= i;
  }
  PetscCall(MatXAIJSetPreallocation(*stiffness, 3, all.data(), nullptr, upper.data(), nullptr));
  PetscBool symmetric;
  PetscCall(
      PetscObjectTypeCompareAny(reinterpret_cast<PetscObject>(*stiffness), &symmetric, MATSBAIJ, MATSEQSBAIJ, ""));
  if (symmetric) PetscCall(MatSetOption(*stiffness, MAT_IGNORE_LOWER_TRIANGULAR, PETSC_TRUE));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CreateStiffness(const Tables &t, MatType type, Mat *stiffness, Way *way) {
  PetscFunctionBeginUser;
  const StiffnessRows rows = AssembleRows(t);
  CdemCheck(9 * rows.column.size() < INT_MAX, t.comm,
            "-central_way assembled: %zu nonzeros are more than 32-bit numbers count", 9 * rows.column.size());
  PetscCall(CreateEmpty(t, rows, type, stiffness));
  std::vector<PetscInt> columns;
  std::vector<double> values;
  for (PetscInt i = 0; i < t.n_owned; ++i) {
    const int first = rows.start[i], n = rows.start[i + 1] - first;
    columns.assign(rows.column.begin() + first, rows.column.begin() + first + n);
    values.resize(9 * static_cast<std::size_t>(n));
    for (int k = 0; k < n; ++k)  // three rows of 3 n numbers
      for (int m = 0; m < 9; ++m)
        values[static_cast<std::size_t>(m / 3) * 3 * n + 3 * k + m % 3] =
            rows.block[9 * (static_cast<std::size_t>(first) + k) + m];
    PetscCall(MatSetValuesBlocked(*stiffness, 1, &i, n, columns.data(), values.data(), INSERT_VALUES));
  }
  PetscCall(MatAssemblyBegin(*stiffness, MAT_FINAL_ASSEMBLY));
  PetscCall(MatAssemblyEnd(*stiffness, MAT_FINAL_ASSEMBLY));
  MatInfo info;
  MatType made;
  char size[32];
  PetscCall(MatGetInfo(*stiffness, MAT_LOCAL, &info));
  PetscCall(MatGetType(*stiffness, &made));
  PetscCall(PetscSNPrintf(size, sizeof size, "%.4g", static_cast<double>(StiffnessBytes(*stiffness)) / (1 << 20)));
  *way = {"assembled", std::string("stiffness as a matrix of PETSc (") + made + "), " +
                           std::to_string(static_cast<long long>(info.nz_used)) + " nonzeros, " + size +
                           " MiB; a product a step, for comparison"};
  PetscFunctionReturn(PETSC_SUCCESS);
}

std::size_t StiffnessBytes(Mat stiffness) {
  MatInfo info;
  PetscInt n = 0;
  MatType type = nullptr;
  if (!stiffness || MatGetInfo(stiffness, MAT_LOCAL, &info) || MatGetLocalSize(stiffness, &n, nullptr) ||
      MatGetType(stiffness, &type))
    return 0;
  const bool blocks = type && std::strstr(type, "baij");
  const std::size_t nonzeros = static_cast<std::size_t>(info.nz_used), block = blocks ? 9 : 1;
  return 8 * nonzeros + sizeof(PetscInt) * (nonzeros / block + static_cast<std::size_t>(n) / (blocks ? 3 : 1) + 1);
}

AssembledWay::~AssembledWay() {
  (void)MatDestroy(&stiffness_);
  (void)VecDestroy(&u_);
  (void)VecDestroy(&f_);
}

PetscErrorCode AssembledWay::Create(const Tables &t, double *u, double *f) {
  PetscFunctionBeginUser;
  const PetscInt n = 3 * static_cast<PetscInt>(t.n_owned);
  PetscCall(CreateStiffness(t, MATBAIJ, &stiffness_, &way_));
  displacement_ = u;
  beta_ = t.beta;
  if (beta_ != 0) damped_.resize(n);
  PetscCall(VecCreateSeqWithArray(PETSC_COMM_SELF, 3, n, beta_ != 0 ? damped_.data() : u, &u_));
  PetscCall(VecCreateSeqWithArray(PETSC_COMM_SELF, 3, n, f, &f_));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode AssembledWay::Forces(const double *v) {
  PetscFunctionBeginUser;
  PetscScalar *values;
  PetscCall(VecGetArray(u_, &values));  // PETSc must know that they change
  for (std::size_t i = 0; i < damped_.size(); ++i) values[i] = displacement_[i] + beta_ * v[i];
  PetscCall(VecRestoreArray(u_, &values));
  PetscCall(MatMult(stiffness_, u_, f_));
  PetscFunctionReturn(PETSC_SUCCESS);
}

std::size_t AssembledWay::Bytes() const { return StiffnessBytes(stiffness_) + 8 * damped_.size(); }

}  // namespace cdem
