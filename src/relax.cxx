// The part of Simulation that brings a body to rest: checks of balance, and what the controller makes of them.
#include "core/error.hpp"
#include "core/events.hpp"
#include "simulation.hpp"

#include <algorithm>
#include <cmath>

namespace cdem {

/// Steps between two looks at the kinetic energy, in kinetic damping. Looking every few steps only, a mode whose period is
/// a multiple of that is always stopped where it began, and never ends.
static constexpr PetscInt kPeakInterval = 1;

/// Steps until the controller looks again.
PetscInt Simulation::StepsToCheck(PetscInt step) const {
  const PetscInt since = step - stage_step_, interval = relaxation_->plan().interval;
  const PetscInt n = interval - since % interval;
  return relaxation_->plan().damping == RelaxDamping::kKinetic ? std::min(n, kPeakInterval - since % kPeakInterval) : n;
}

/// Velocities become 0; the coming step is a first one.
PetscErrorCode Simulation::StopMotion() {
  PetscFunctionBeginUser;
  AuditSums before, after;
  if (book_.on) PetscCall(TakeAudit(&before));
  PetscCall(VecSet(v_, 0));
  PetscCall(TSCentralSetLastStep(ts_, 0));
  if (book_.on) {
    PetscCall(TakeAudit(&after));
    book_.Stop(before, after);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode Simulation::WatchBalance(TS ts) {
  Simulation *run;
  PetscInt step;
  PetscFunctionBeginUser;
  PetscCall(TSGetApplicationContext(ts, &run));
  PetscCall(TSGetStepNumber(ts, &step));
  const RelaxPlan &plan = run->relaxation_->plan();
  const PetscInt since = step - run->stage_step_;
  if (plan.damping == RelaxDamping::kKinetic && since % kPeakInterval == 0) {
    double kinetic;
    PetscCall(run->backend_->Kinetic(&kinetic));
    if (run->relaxation_->PassedPeak(kinetic)) PetscCall(run->StopMotion());
    run->to_keep_ = run->relaxation_->memory();
  }
  if (since % plan.interval == 0 || run->AtEnd()) PetscCall(run->CheckBalance(step));
  if (run->balanced_) PetscCall(TSSetConvergedReason(ts, TS_CONVERGED_USER));
  PetscFunctionReturn(PETSC_SUCCESS);
}

bool Simulation::FindsDamping() const {
  return relaxation_->plan().damping == RelaxDamping::kRayleigh && Now().alpha == 0;
}

/// Looks at the balance. A look that is not due, at an end by number of steps, steers nothing: a run that goes on from there
/// is the one that would not have ended.
PetscErrorCode Simulation::CheckBalance(PetscInt step) {
  PetscFunctionBeginUser;
  PetscCall(PetscLogEventBegin(events.observe, nullptr, nullptr, nullptr, nullptr));
  double dt_old, time;
  PetscCall(TSCentralGetLastStep(ts_, &dt_old));
  PetscCall(TSGetTime(ts_, &time));
  std::vector<double> schedule(3 * Now().tables.size());
  FillSchedule(time - stage_time_, dt_, schedule.data());
  BalanceTerms terms;
  PetscCall(backend_->LookAtBalance(MakeArgs(dt_old, dt_), schedule.data(), &last_, &terms));
  PetscCall(SumOverRanks(comm_, &last_));
  to_keep_ = relaxation_->memory();
  balanced_ = relaxation_->Check(
      {terms.kinetic, last_.strain + last_.spring, last_.Unbalanced(), terms.stiffness, terms.inertia});
  if ((step - stage_step_) % relaxation_->plan().interval == 0) {
    to_keep_ = relaxation_->memory();
    PetscCall(backend_->KeepLook());
    if (FindsDamping()) alpha_ = relaxation_->Alpha();
  }
  PetscCall(PetscLogEventEnd(events.observe, nullptr, nullptr, nullptr, nullptr));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode Simulation::ReportImbalance() {
  PetscFunctionBeginUser;
  const BalanceMemory *memory;
  PetscCall(backend_->DownloadBalance(&memory));
  double largest = 0, x[3] = {0, 0, 0};
  for (int i = 0; i < tables_.n_owned; ++i) {
    const double *force = &memory->now[3 * static_cast<std::size_t>(i)];
    const double size = std::sqrt(Dot(force, force));
    if (size <= largest) continue;
    largest = size;
    std::copy_n(&tables_.x[3 * static_cast<std::size_t>(i)], 3, x);
  }
  PetscCall(LargestOverRanks(comm_, &largest, x));
  const BalanceSums &sums = relaxation_->last();
  char text[700];
  std::snprintf(
      text, sizeof text,
      "%s%s%s not in balance after %lld steps: unbalanced force ratio %.3g (-relax_ratio %g), kinetic energy "
      "%.3g of its peak (-relax_kinetic %g); the largest force out of balance is %.3g N at (%g, %g, %g). A body "
      "that fails or hangs free never comes to rest; else give more -relax_max_steps or a larger ratio",
      Staged() ? "stage '" : "the body is", Now().name.c_str(), Staged() ? "' is" : "",
      static_cast<long long>(steps_ - stage_step_), sums.unbalanced, relaxation_->plan().ratio,
      relaxation_->peak() > 0 ? sums.kinetic / relaxation_->peak() : 0, relaxation_->plan().kinetic, largest, x[0],
      x[1], x[2]);
  failure_ = text;
  PetscFunctionReturn(PETSC_SUCCESS);
}

}  // namespace cdem
