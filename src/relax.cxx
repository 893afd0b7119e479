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

/// Kinetic energy of the half-step velocities [J], over all ranks; on the device, where v is there.
PetscErrorCode Simulation::Kinetic(double *energy) {
  PetscFunctionBeginUser;
  if (!mass_) {
    PetscScalar *mass;
    PetscCall(VecDuplicate(v_, &mass_));
    PetscCall(VecDuplicate(v_, &momentum_));
    PetscCall(VecGetArray(mass_, &mass));
    for (int i = 0; i < tables_.n_owned; ++i)
      for (int k = 0; k < 3; ++k) mass[3 * static_cast<std::size_t>(i) + k] = tables_.mass[i];
    PetscCall(VecRestoreArray(mass_, &mass));
  }
  PetscCall(VecPointwiseMult(momentum_, mass_, v_));
  PetscCall(VecDot(momentum_, v_, energy));
  *energy *= 0.5;
  PetscFunctionReturn(PETSC_SUCCESS);
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
    PetscCall(run->Kinetic(&kinetic));
    if (run->relaxation_->PassedPeak(kinetic)) PetscCall(run->StopMotion());
  }
  if (since % plan.interval == 0 || run->AtEnd()) PetscCall(run->CheckBalance(step));
  if (run->balanced_) PetscCall(TSSetConvergedReason(ts, TS_CONVERGED_USER));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode Simulation::CheckBalance(PetscInt step) {
  PetscFunctionBeginUser;
  PetscCall(PetscLogEventBegin(events.observe, nullptr, nullptr, nullptr, nullptr));
  const double *u, *v;
  const Histories *history;
  double dt_old, time;
  PetscCall(TSCentralGetLastStep(ts_, &dt_old));
  PetscCall(TSGetTime(ts_, &time));
  PetscCall(backend_->Download(&u, &v, &history));
  std::vector<double> schedule(3 * Now().tables.size()), residual;
  FillSchedule(time - stage_time_, dt_, schedule.data());
  ElementResults elements;
  SpringResults springs;
  PetscCall(ObserveOnHost(tables_, static_cast<int>(mesh_.n_owned), u, v, *history, MakeArgs(dt_old, dt_),
                          schedule.data(), &elements, &springs, nullptr, &last_, &residual));
  PetscCall(SumOverRanks(comm_, &last_));
  double path[2] = {0, 0};
  if (step > stage_step_)
    for (int i = 0; i < tables_.n_owned; ++i)
      for (int k = 0; k < 3; ++k) {
        const std::size_t at = 3 * static_cast<std::size_t>(i) + k;
        const double du = residual[at] == 0 ? 0 : u[at] - last_u_[at];  // prescribed components have no residual
        path[0] += du * (last_residual_[at] - residual[at]);
        path[1] += du * tables_.mass[i] * du;
      }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, path, 2, MPI_DOUBLE, MPI_SUM, comm_));
  last_u_.assign(u, u + 3 * static_cast<std::size_t>(tables_.n_owned));
  last_residual_ = std::move(residual);
  balanced_ = relaxation_->Check({last_.kinetic, last_.strain + last_.spring, last_.Unbalanced(), path[0], path[1]});
  if (relaxation_->plan().damping == RelaxDamping::kRayleigh && Now().alpha == 0) alpha_ = relaxation_->Alpha();
  PetscCall(PetscLogEventEnd(events.observe, nullptr, nullptr, nullptr, nullptr));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode Simulation::ReportImbalance() {
  PetscFunctionBeginUser;
  double largest = 0, x[3] = {0, 0, 0};
  for (int i = 0; i < tables_.n_owned; ++i) {
    const double *force = &last_residual_[3 * static_cast<std::size_t>(i)];
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
