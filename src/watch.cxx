// The part of Simulation that looks: when somebody wants the state, what they get, and the end of the run.
#include "core/events.hpp"
#include "simulation.hpp"

#include <algorithm>
#include <utility>

namespace cdem {

/// Steps between two looks at the energy, and in runs with output between two states that are kept. An observation costs
/// up to three force evaluations, and on a small scene on a GPU as much as ten steps.
static constexpr PetscInt kCheckInterval = 2000;

PetscInt Simulation::StepsToNext(PetscInt step, PetscReal time, PetscReal dt) {
  PetscInt n = std::min(monitors_.ToNext(step, time, dt), kCheckInterval - (step - stage_step_) % kCheckInterval);
  if (!output_dir_.empty()) n = std::min(n, frame_interval_.ToNext(step, time, dt));
  if (relaxation_) n = std::min(n, StepsToCheck(step));
  if (checkpoints_.Active()) n = std::min(n, checkpoints_.ToNext(step, time, dt));
  return n;
}

PetscErrorCode Simulation::MonitorTS(TS, PetscInt step, PetscReal time, Vec, void *ctx) {
  Simulation &run = *static_cast<Simulation *>(ctx);
  PetscFunctionBeginUser;
  const bool resumed_at_end = step == run.first_step_ && run.AtEnd() && !run.balanced_;
  if (run.relaxation_ && (step == run.stage_step_ || resumed_at_end)) PetscCall(run.CheckBalance(step));
  if (step > run.stage_step_ || run.stage_ == 0) PetscCall(run.Watch(step, time));  // else the stage before has looked
  PetscFunctionReturn(PETSC_SUCCESS);
}

bool Simulation::AtEnd() const {
  TSConvergedReason reason = TS_CONVERGED_ITERATING;
  (void)TSGetConvergedReason(ts_, &reason);
  return reason != TS_CONVERGED_ITERATING;
}

PetscErrorCode Simulation::Watch(PetscInt step, double time) {
  PetscFunctionBeginUser;
  double dt;
  PetscCall(TSCentralGetLastStep(ts_, &dt));
  const bool last = AtEnd();
  steps_ = step;
  time_ = Now().relax ? stage_time_ : time;  // a relaxation advances no time
  const double reached = dt > 0 ? dt : dt_;
  const double begin = MPI_Wtime();
  const bool first = step == first_step_ && !goes_on_;
  const bool frame = !output_dir_.empty() && (first || last || frame_interval_.Due(step, time, reached));
  const bool checkpoint = checkpoints_.Due(step, time, reached, last, first_step_);
  const bool check = (step - stage_step_) % kCheckInterval == 0 || last || frame || checkpoint;
  Observed observed;
  if (check || monitors_.Observes(step, time, reached, last)) {
    PetscCall(PetscLogEventBegin(events.observe, nullptr, nullptr, nullptr, nullptr));
    std::vector<double> schedule(3 * Now().tables.size());
    FillSchedule(time - stage_time_, reached, schedule.data());
    PetscCall(backend_->Observe(MakeArgs(dt, reached), schedule.data(), &observed));
    PetscCall(SumOverRanks(comm_, &observed));
    last_ = observed;
    PetscCall(PetscLogEventEnd(events.observe, nullptr, nullptr, nullptr, nullptr));
    PetscCall(CheckGrowth(step, time, observed));  // before anything of this state is written
    if (check) PetscCall(KeepGoodState(step));
  }
  if (monitors_.Due(step, time, reached, last)) {
    Sight sight;
    sight.step = step;
    sight.first_step = first_step_;
    sight.last_step = last_step_;
    sight.time = time;
    for (std::int64_t n : n_cells_) sight.elements += static_cast<double>(n);
    sight.breakable = static_cast<double>(n_breakable_);
    sight.observed = observed;
    if (monitors_.Audits(step, time, reached, last)) {
      AuditSums sums;
      PetscCall(TakeAudit(&sums));
      balance_ = book_.Of(sums);
      sight.energies = {{"kinetic", sums.kinetic}, {"strain", sums.strain}, {"spring", sums.spring}};
      for (const BalanceTerm &term : kBalanceTerms) sight.energies.push_back({term.name, term.value(balance_)});
    }
    sight.wall = MPI_Wtime() - wall_start_ - wall_output_;
    PetscCall(monitors_.Print(sight, reached, last));
  }
  wall_watch_ += MPI_Wtime() - begin;
  if (frame) PetscCall(WriteFrame(step, time));
  if (checkpoint) PetscCall(WriteCheckpoint(step));
  wall_output_ += MPI_Wtime() - begin;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode Simulation::WriteFrame(PetscInt step, double time) {
  PetscFunctionBeginUser;
  PetscCall(PetscLogEventBegin(events.frame, nullptr, nullptr, nullptr, nullptr));
  const double *u, *v;
  const Histories *history;
  PetscCall(backend_->Download(&u, &v, &history));
  double dt;
  PetscCall(TSCentralGetLastStep(ts_, &dt));
  const double reached = dt > 0 ? dt : dt_;
  std::vector<double> schedule(3 * Now().tables.size()), v_now, stress(6 * static_cast<std::size_t>(mesh_.n_owned));
  FillSchedule(time - stage_time_, reached, schedule.data());
  ElementResults elements;
  SpringResults springs;
  elements.stress = stress.data();
  springs.want_each = true;
  PetscCall(ObserveOnHost(tables_, static_cast<int>(mesh_.n_owned), u, v, *history, MakeArgs(dt, reached),
                          schedule.data(), &elements, &springs, &v_now, &last_));
  PetscCall(SumOverRanks(comm_, &last_));
  std::vector<double> since;  // displacements from the origin that was set last
  const double *reported = u;
  if (!origin_.empty()) {
    since.assign(u, u + 3 * static_cast<std::size_t>(tables_.n_local));
    for (std::size_t i = 0; i < since.size(); ++i) since[i] -= origin_[i];
    reported = since.data();
  }
  PetscCall(fields_.Write(step, time + pseudo_time_, reported, v_now, stress, springs, *history));
  last_frame_ = step;
  PetscCall(WatchValidity(u));
  const bool end = AtEnd() && (stage_ + 1 == scenes_.size() || (relaxation_ && !balanced_));
  if (end && !recorder_.Empty()) PetscCall(recorder_.RecordLast(step, time_, u, v_now.data()));
  PetscCall(PetscLogEventEnd(events.frame, nullptr, nullptr, nullptr, nullptr));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode Simulation::WatchValidity(const double *u) {
  PetscFunctionBeginUser;
  PetscCall(CheckValidity(tables_, u, &validity_));
  const Validity &v = validity_;
  if (v.slip > kSlipLimit && !std::exchange(warned_slip_, true))
    PetscCall(PetscPrintf(
        comm_,
        "warning     the spring at (%g, %g, %g) has shifted by %.3g of its face at step %lld: node pairs are "
        "fixed, so results are good up to about %g\n",
        v.slip_at[0], v.slip_at[1], v.slip_at[2], v.slip, static_cast<long long>(steps_), kSlipLimit));
  if (v.rotation > kRotationLimit && !std::exchange(warned_rotation_, true))
    PetscCall(PetscPrintf(
        comm_,
        "warning     the element at (%g, %g, %g) has turned by %.3g degrees at step %lld: strains are small "
        "ones, so results are good up to about %g degree\n",
        v.rotation_at[0], v.rotation_at[1], v.rotation_at[2], v.rotation, static_cast<long long>(steps_),
        kRotationLimit));
  PetscFunctionReturn(PETSC_SUCCESS);
}

}  // namespace cdem
