// TS type "central": central differences with velocities at half steps, many steps in one TSStep.
#pragma once
#include "core/petsc.hpp"

namespace cdem {

/// A run of equal steps: step number first + j is at time base + (offset + j) dt.
struct StepPlan {
  PetscInt first = 0;  ///< ts->steps at its beginning
  PetscReal base = 0;  ///< s
  PetscInt offset = 0;
  PetscReal dt = 0, dt_old = 0;  ///< s; dt_old = 0 at the very beginning
  PetscInt n = 0;
  PetscReal Time(PetscInt j) const { return base + static_cast<PetscReal>(offset + j) * dt; }
};

/// Who does the steps.
class Stepper {
 public:
  virtual ~Stepper() = default;
  virtual PetscErrorCode Advance(const StepPlan &plan) = 0;
  /// How many steps may pass from this one on until somebody wants to see the state (at least 1).
  virtual PetscInt StepsToNext(PetscInt step, PetscReal time, PetscReal dt) = 0;
};

/// Registers the type; once after PetscInitialize.
PetscErrorCode RegisterTSCentral();
/// Creates a TS of this type for a stepper (borrowed) and the vectors of TS2SetSolution.
/// [in] batch: most steps in one TSStep; 0: 1000.
PetscErrorCode CreateTSCentral(MPI_Comm comm, Stepper *stepper, PetscInt batch, Vec u, Vec v, TS *ts);
/// Where a run stands: what a later one needs to take the same steps at the same times.
struct CentralState {
  PetscInt step = 0, base_step = 0;                       ///< base_step: where the run of equal steps began
  PetscReal time = 0, base_time = 0, dt = 0, dt_old = 0;  ///< s; dt of that run, dt_old of the last step taken
};
PetscErrorCode TSCentralGetState(TS ts, CentralState *state);
/// Before TSSolve, when the end is known.
PetscErrorCode TSCentralSetState(TS ts, const CentralState &state);
/// dt of the last step taken (0 before the first).
PetscErrorCode TSCentralGetLastStep(TS ts, PetscReal *dt);
/// Says that v holds velocities half a step of dt before u; 0: velocities at the time of u.
PetscErrorCode TSCentralSetLastStep(TS ts, PetscReal dt);

}  // namespace cdem
