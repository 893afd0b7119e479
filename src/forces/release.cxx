#include "forces/release.hpp"

namespace cdem {

PetscErrorCode ReleaseSprings(const Tables &tables, const std::vector<ElementHistories> &elements,
                              std::vector<std::uint8_t> *released, std::vector<SpringHistory> *springs) {
  PetscFunctionBeginUser;
  released->resize(tables.n_cells, 0);
  for (std::size_t g = 0; g < elements.size(); ++g) {
    const ElementTable &t = tables.elements[g];
    if (!t.judged) continue;
    for (int e = 0; e < t.n; ++e)
      if (elements[g].state[e] & (kBrokenTension | kBrokenShear)) (*released)[t.cell[e]] = 1;
  }
  if (tables.cells) {  // a spring may hang on an element that only another rank computes
    const std::vector<std::uint8_t> own(*released);
    PetscCall(PetscSFBcastBegin(tables.cells, MPI_BYTE, own.data(), released->data(), MPI_REPLACE));
    PetscCall(PetscSFBcastEnd(tables.cells, MPI_BYTE, own.data(), released->data(), MPI_REPLACE));
  }
  for (std::size_t g = 0; g < springs->size(); ++g) {
    const std::vector<int> &cell = tables.springs[g].cell;
    std::vector<std::uint8_t> &state = (*springs)[g].state;
    for (std::size_t i = 0; i < cell.size() / 2 && !state.empty(); ++i)
      for (int side = 0; side < 2; ++side)
        if (cell[2 * i + side] >= 0 && (*released)[cell[2 * i + side]]) state[i] |= kTensionLost | kCohesionLost;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

}  // namespace cdem
