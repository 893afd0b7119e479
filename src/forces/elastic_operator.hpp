// The elastic stiffness of a scene, scaled by its masses, as a matrix of PETSc that is applied and never assembled.
#pragma once
#include "forces/tables.hpp"

namespace cdem {

/// The law of blocks, by its number, as which a table counts: the elastic one, or where the form has a law of its own that
/// one, in which with ElasticParams nothing fails.
int ElasticLaw(const ElementTable &t);
/// Whether that is so for a table's form.
bool HasOwnLaws(const ElementTable &t);
/// Parameters for those laws: Tables::block_param [row][kMaxParams], in such forms without what could fail.
std::vector<double> ElasticParams(const Tables &tables);
/// The components of every owned node that nobody prescribes: bits 1, 2, 4 for x, y, z.
std::vector<std::uint8_t> FreeComponents(const Tables &tables);

/// Creates the shell matrix M^(-1/2) K M^(-1/2) [1/s^2] over the components of the owned nodes (collective). K is the
/// elastic part of every block law in its own form, by the loops of a step, and every interface spring as an intact
/// linear one. Components that are prescribed have rows and columns of zeros. [in] tables: must outlive the matrix.
/// Vectors are those of MatCreateVecs: three components a node, in x = M^(1/2) u. cuda/elastic_operator.cu has the same
/// for GPUs.
PetscErrorCode CreateElasticOperator(const Tables &tables, Mat *matrix);

}  // namespace cdem
