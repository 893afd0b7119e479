// Stiffness of single elements and springs.
#pragma once
#include "forces/tables.hpp"

#include <array>

namespace cdem {

/// Stiffness of some elements of a table: by the bodies of the loops, on one unit displacement after the other.
/// [in] elements: rows of the table. Returns [element][corner of the force][corner of the displacement][3][3] N/m.
std::vector<double> ElementMatrices(const Tables &tables, const ElementTable &table, const std::vector<int> &elements);

/// Stiffness of a spring of a linear law: [3][3] N/m, internal force on an end by the displacement of the same end; by that
/// of the other end it is the opposite.
std::array<double, 9> SpringMatrix(const SpringTable &table, int spring);

}  // namespace cdem
