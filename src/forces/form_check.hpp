// Which element form a region's elements have.
#pragma once
#include "forces/tables.hpp"

#include <string>

namespace cdem {

/// Number of a form in the list of its shape; -1: that shape has none of that name.
int FormNumber(Shape shape, const std::string &name);

/// Every region's elements have the form that its material asks for, and law and form fit (collective). remarks receives
/// forms that are no good for the law.
PetscErrorCode CheckForms(const Mesh &mesh, const std::vector<Material> &materials, std::vector<std::string> *remarks);

}  // namespace cdem
