#include "time/ts_central.hpp"

#include <petsc/private/tsimpl.h>

#include <algorithm>
#include <cmath>

namespace cdem {

namespace {

constexpr char kType[] = "central";
constexpr PetscInt kDefaultBatch = 1000;

struct Central {
  Stepper *stepper;
  PetscInt batch, base_step;
  PetscReal base_time, dt, dt_old;  // dt of the current run of equal steps, dt of the last step taken
};

PetscErrorCode Step(TS ts) {
  PetscFunctionBegin;
  Central *c = static_cast<Central *>(ts->data);
  const PetscReal left = ts->max_time - ts->ptime;
  PetscReal dt = ts->time_step;
  PetscInt n = 1;
  const PetscReal steps_left = left / dt;
  const bool whole = steps_left > 1 - 1e-6;  // else the last step is cut so that it lands on the end time
  if (whole) {
    n = std::min(c->batch, c->stepper->StepsToNext(ts->steps, ts->ptime, dt));
    n = std::min<PetscInt>(n, CdemRunStepsLeft(ts));
    n = std::max<PetscInt>(1, std::min(n, ts->max_steps - ts->steps));
    if (steps_left < n) n = std::max<PetscInt>(1, static_cast<PetscInt>(std::floor(steps_left + 1e-6)));
  } else {
    dt = left;
  }
  if (dt != c->dt) {
    c->dt = dt;
    c->base_step = ts->steps;
    c->base_time = ts->ptime;
  }
  StepPlan plan;
  plan.first = ts->steps;
  plan.base = c->base_time;
  plan.offset = ts->steps - c->base_step;
  plan.dt = dt;
  plan.dt_old = c->dt_old;
  plan.n = n;
  PetscCall(c->stepper->Advance(plan));
  c->dt_old = dt;
  ts->ptime = plan.Time(n);
  if (!whole || std::fabs(ts->max_time - ts->ptime) < 1e-6 * dt) ts->ptime = ts->max_time;
  ts->steps += n - 1;  // TSStep adds the last one
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SetUp(TS) {
  PetscFunctionBegin;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode Destroy(TS ts) {
  PetscFunctionBegin;
  delete static_cast<Central *>(ts->data);
  ts->data = nullptr;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode View(TS ts, PetscViewer viewer) {
  PetscFunctionBegin;
  const Central *c = static_cast<const Central *>(ts->data);
  PetscBool ascii;
  PetscCall(PetscObjectTypeCompare(reinterpret_cast<PetscObject>(viewer), PETSCVIEWERASCII, &ascii));
  if (ascii)
    PetscCall(PetscViewerASCIIPrintf(viewer, "  central differences, at most %lld steps in one TSStep\n",
                                     static_cast<long long>(c->batch)));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode Create(TS ts) {
  PetscFunctionBegin;
  ts->data = new Central{nullptr, kDefaultBatch, 0, 0, 0, 0};
  ts->ops->step = Step;
  ts->ops->setup = SetUp;
  ts->ops->destroy = Destroy;
  ts->ops->view = View;
  ts->usessnes = PETSC_FALSE;
  ts->default_adapt_type = TSADAPTNONE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

}  // namespace

PetscErrorCode RegisterTSCentral() {
  PetscFunctionBegin;
  PetscCall(TSRegister(kType, Create));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CreateTSCentral(MPI_Comm comm, Stepper *stepper, PetscInt batch, Vec u, Vec v, TS *ts) {
  PetscFunctionBegin;
  PetscCall(TSCreate(comm, ts));
  PetscCall(TSSetType(*ts, kType));
  PetscCall(TSSetProblemType(*ts, TS_NONLINEAR));
  Central *c = static_cast<Central *>((*ts)->data);
  c->stepper = stepper;
  PetscCall(TS2SetSolution(*ts, u, v));
  PetscCall(TSSetExactFinalTime(*ts, TS_EXACTFINALTIME_STEPOVER));  // Step() lands on the end time by itself
  if (batch > 0) c->batch = batch;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode TSCentralGetState(TS ts, CentralState *state) {
  PetscFunctionBegin;
  const Central *c = static_cast<const Central *>(ts->data);
  *state = {ts->steps, c->base_step, ts->ptime, c->base_time, c->dt, c->dt_old};
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode TSCentralSetState(TS ts, const CentralState &state) {
  PetscFunctionBegin;
  Central *c = static_cast<Central *>(ts->data);
  c->base_step = state.base_step;
  c->base_time = state.base_time;
  c->dt = state.dt;
  c->dt_old = state.dt_old;
  // A run that ended there was put onto its end; one that goes on past it has the time of its steps.
  const PetscReal counted = state.base_time + static_cast<PetscReal>(state.step - state.base_step) * state.dt;
  PetscReal time = std::fabs(counted - state.time) < 1e-6 * state.dt ? counted : state.time;
  if (std::fabs(ts->max_time - time) < 1e-6 * state.dt) time = ts->max_time;
  PetscCall(TSSetStepNumber(ts, state.step));
  PetscCall(TSSetTime(ts, time));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode TSCentralGetLastStep(TS ts, PetscReal *dt) {
  PetscFunctionBegin;
  *dt = static_cast<Central *>(ts->data)->dt_old;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode TSCentralSetLastStep(TS ts, PetscReal dt) {
  PetscFunctionBegin;
  static_cast<Central *>(ts->data)->dt_old = dt;
  PetscFunctionReturn(PETSC_SUCCESS);
}

}  // namespace cdem
