// What can be said of an interface law only where the faces, their stiffness and the blocks beside them are known.
#pragma once
#include "forces/tables.hpp"

#include <string>

namespace cdem {

/// Checks the properties of every interface on its faces (collective). Error: strengths that its law cannot have on
/// springs of that stiffness. remarks receives interfaces beside which the cells are too large to resolve the failure.
PetscErrorCode CheckJoints(const Mesh &mesh, const std::vector<std::string> &names,
                           const std::vector<Material> &materials, const std::vector<Joint> &joints,
                           const Tables &tables, std::vector<std::string> *remarks);

}  // namespace cdem
