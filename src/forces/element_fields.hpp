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

/// Fields that only some laws have.
struct LawFields {
  bool plastic = false;  ///< plastic_strain
  bool broken = false;   ///< broken, broken_time
  bool damage = false;   ///< damage, of interfaces
};

/// [in,out] there: those of the laws of these tables are added (collective).
PetscErrorCode FindLawFields(const Tables &tables, LawFields *there);

/// [in] wanted: which fields to fill.
void FillElementFields(const Tables &tables, int n_owned_cells, const std::vector<ElementHistories> &history,
                       const LawFields &wanted, ElementFields *fields);

/// Damage of a spring, from 0 to 1: that of its history; of laws without one, whether it is broken. [in] state: as a
/// committing evaluation would leave it.
double DamageOf(const SpringTable &table, const SpringHistory &history, std::uint8_t state, int i);

}  // namespace cdem
