// What frames show of the elements' histories.
#pragma once
#include "forces/host_passes.hpp"

namespace cdem {

/// Numbers of the owned cells, from committed histories; empty where no element of any rank has such a law.
struct ElementFields {
  std::vector<double> plastic_strain;  ///< plastic shear strain, mean over the volume
  std::vector<double> broken;          ///< 0 intact, 1 in tension, 2 in shear
  std::vector<double> broken_time;     ///< s; NaN while intact
};

/// Laws of the scene that have such fields (collective).
PetscErrorCode FindElementFields(const Tables &tables, bool *plastic, bool *breaks);

/// [in] plastic, breaks: which fields to fill.
void FillElementFields(const Tables &tables, int n_owned_cells, const std::vector<ElementHistories> &history,
                       bool plastic, bool breaks, ElementFields *fields);

}  // namespace cdem
