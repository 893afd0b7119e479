// How much energy loads and moving boundaries can have brought into a body: a bound from their tables alone, against which
// the energy of a run is held.
#pragma once
#include "forces/tables.hpp"

namespace cdem {

/// For a body that stores and dissipates, with forces F at its nodes and prescribed velocities V at some of them,
///   d sqrt(E)/dt <= (|F| + w |V|) / sqrt(2),   |F|^2 = sum F^2/m,  |V|^2 = sum m V^2,
/// since the power of F is at most |F| sqrt(2 E), and that of the reactions R at most |V| |R|, where |R|^2 <= 2 w^2 E
/// with the highest frequency w (K M^-1 K <= w^2 K), which is at most 2/dt in a stable run.
class InputBound {
 public:
  /// A stage with these tables begins (collective).
  PetscErrorCode Begin(const Tables &tables);
  /// n steps of dt [s] are taken. [in] schedule: [n][n_tables][3] as for Batch, NULL without records.
  void Add(double dt, int n, const double *schedule);
  /// The bound [J] for a body that had this energy when the stage began.
  double Energy(double at_start) const;

 private:
  double weight_ = 0;                             // |F| of gravity [sqrt(J)/s]
  std::vector<double> force_, velocity_, place_;  // per table at the value 1: |F|, |V|, and |V| dt of displacements
  bool fresh_ = true;                             // no step yet: displacements may jump
  double root_ = 0;                               // sum of the right side [sqrt(J)]
};

}  // namespace cdem
