// The elastic stiffness of a scene, scaled by its masses, as a matrix of PETSc that is applied and never assembled.
#pragma once
#include "forces/tables.hpp"

namespace cdem {

/// Creates the shell matrix M^(-1/2) K M^(-1/2) [1/s^2] over the components of the owned nodes (collective). K is the
/// elastic part of every block law in its own form, by the loops of a step, and every interface spring as an intact
/// linear one. Components that are prescribed have rows and columns of zeros. [in] tables: must outlive the matrix.
/// Vectors are those of MatCreateVecs: three components a node, in x = M^(1/2) u.
PetscErrorCode CreateElasticOperator(const Tables &tables, Mat *matrix);

}  // namespace cdem
