// Small strain and fixed node pairs hold only so far: how far a state is from their limits.
#pragma once
#include "forces/tables.hpp"

namespace cdem {

inline constexpr double kSlipLimit = 0.1;      ///< of a face
inline constexpr double kRotationLimit = 1.0;  ///< degrees

/// Largest values over all ranks and where they are.
struct Validity {
  double slip = 0, slip_at[3] = {0, 0, 0};          ///< tangential shift of a spring over the size of its face
  double rotation = 0, rotation_at[3] = {0, 0, 0};  ///< mean rotation of an element [degrees]
};

/// The largest value over the ranks and its place [3] (collective). [in,out] value, place: of this rank at first.
PetscErrorCode LargestOverRanks(MPI_Comm comm, double *value, double *place);

/// [in] u: host, [n_local][3] m. Collective.
PetscErrorCode CheckValidity(const Tables &tables, const double *u, Validity *validity);

}  // namespace cdem
