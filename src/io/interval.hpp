// "Every N steps" or "every T seconds", as PETSc's monitors have it.
#pragma once
#include "core/petsc.hpp"

#include <algorithm>
#include <cmath>

namespace cdem {

struct Interval {
  PetscInt steps = 0;  ///< 0: not by steps
  double seconds = 0;  ///< 0: not by time

  bool Never() const { return steps <= 0 && seconds <= 0; }
  /// Whether something is due at this step, which ended a step of dt at this time (step 0: always).
  bool Due(PetscInt step, double time, double dt) const {
    if (Never()) return false;
    if (step == 0 || (steps > 0 && step % steps == 0)) return true;
    return seconds > 0 && Count(time, dt) > Count(time - dt, dt);
  }
  /// Steps from here to the next one that is due.
  PetscInt ToNext(PetscInt step, double time, double dt) const {
    PetscInt n = PETSC_INT_MAX;
    if (steps > 0) n = steps - step % steps;
    if (seconds > 0) {
      const double gap = ((Count(time, dt) + 1) * seconds - time) / dt;
      if (gap < static_cast<double>(n)) n = std::max<PetscInt>(1, static_cast<PetscInt>(std::ceil(gap - 1e-6)));
    }
    return n;
  }

 private:
  double Count(double time, double dt) const { return std::floor((time + 1e-6 * dt) / seconds); }
};

}  // namespace cdem
