// The way of a general library, for comparison: the stiffness of a linear scene as a matrix of PETSc, which every step
// multiplies by the displacements.
#pragma once
#include "forces/backend.hpp"

#include <string>

namespace cdem {

/// Raises the error of a scene that cannot go the way `assembled` (collective). [in] audited: the energy balance is kept.
PetscErrorCode CheckAssembled(const Tables &tables, bool audited);

/// The stiffness of a scene that CheckAssembled lets pass [N/m]. [in] type: of the matrix, unless -central_mat_type names
/// another. [out] way: the header's words. Errors: a type that is not there.
PetscErrorCode CreateStiffness(const Tables &tables, MatType type, Mat *stiffness, Way *way);

/// Memory of the matrix where it multiplies [bytes]: values, columns and starts of rows.
std::size_t StiffnessBytes(Mat stiffness);

/// The way on the CPU.
class AssembledWay {
 public:
  AssembledWay() = default;
  AssembledWay(const AssembledWay &) = delete;
  AssembledWay &operator=(const AssembledWay &) = delete;
  ~AssembledWay();
  /// [in] u, f: [n_owned][3], where the displacements [m] stand and the forces [N] go.
  PetscErrorCode Create(const Tables &tables, double *u, double *f);
  /// f = K (u + beta v).
  PetscErrorCode Forces(const double *v);
  const Way &way() const { return way_; }
  std::size_t Bytes() const;

 private:
  Mat stiffness_ = nullptr;
  Vec u_ = nullptr, f_ = nullptr;
  std::vector<double> damped_;  ///< u + beta v; empty without beta
  const double *displacement_ = nullptr;
  double beta_ = 0;
  Way way_;
};

}  // namespace cdem
