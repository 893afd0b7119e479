// Elements that break, and with them the springs of their faces.
#pragma once
#include "forces/host_passes.hpp"

namespace cdem {

/// Breaks the springs on the faces of broken elements, on every rank that has them (collective).
/// [in] elements: histories after the pass over the elements. [in,out] released: [n_cells], kept from step to step.
PetscErrorCode ReleaseSprings(const Tables &tables, const std::vector<ElementHistories> &elements,
                              std::vector<std::uint8_t> *released, std::vector<SpringHistory> *springs);

}  // namespace cdem
