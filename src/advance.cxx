// The part of Simulation that goes: the stages one after the other, and the batches of steps that TS asks for.
#include "core/error.hpp"
#include "core/events.hpp"
#include "simulation.hpp"

#include <algorithm>
#include <limits>

namespace cdem {

PetscErrorCode Simulation::Solve() {
  PetscFunctionBeginUser;
  PetscCall(PetscLogStagePush(events.solve));
  PetscCall(backend_->Synchronize());
  wall_start_ = MPI_Wtime();
  for (bool more = true; more;) {
    stage_begin_ = MPI_Wtime();
    output_before_ = wall_output_;
    PetscCall(TSSolve(ts_, nullptr));
    PetscCall(backend_->Synchronize());
    PetscCall(EndStage());
    more = failure_.empty() && stage_ + 1 < scenes_.size();
    if (more) PetscCall(NextStage());
  }
  wall_solve_ = MPI_Wtime() - wall_start_ - wall_output_ - wall_stages_;
  PetscCall(PetscLogStagePop());
  PetscFunctionReturn(PETSC_SUCCESS);
}

StepArgs Simulation::MakeArgs(double dt_old, double dt) const {
  StepArgs args;
  const double h = 0.5 * (dt_old + dt), half = 0.5 * alpha_ * h;
  args.dt = dt;
  args.keep = (1 - half) / (1 + half);
  args.kick = h / (1 + half);
  args.start = dt_old == 0;
  args.local = local_;
  args.alpha = alpha_;
  args.dt_old = dt_old;
  std::copy_n(tables_.gravity, 3, args.gravity);
  return args;
}

void Simulation::FillSchedule(double t, double dt, double *row) const {
  const std::vector<TimeTable> &tables = Now().tables;
  for (std::size_t k = 0; k < tables.size(); ++k)
    for (int part = 0; part < 3; ++part) row[3 * k + part] = tables[k].At(t + 0.5 * part * dt);
}

PetscErrorCode Simulation::Advance(const StepPlan &plan) {
  PetscFunctionBeginUser;
  PetscCall(PetscLogEventBegin(events.batch, nullptr, nullptr, nullptr, nullptr));
  Batch batch;
  batch.first = MakeArgs(plan.dt_old, plan.dt);
  batch.rest = MakeArgs(plan.dt, plan.dt);
  batch.n = static_cast<int>(plan.n);
  batch.base = plan.base;
  batch.offset = plan.offset;
  std::vector<double> schedule, history, times;
  if (tables_.records.n > 0) {
    const std::size_t row = 3 * Now().tables.size();
    schedule.resize(row * plan.n);
    for (PetscInt j = 0; j < plan.n; ++j) FillSchedule(plan.Time(j) - stage_time_, plan.dt, &schedule[row * j]);
    batch.schedule = schedule.data();
  }
  input_.Add(plan.dt, batch.n, batch.schedule);
  history.resize(6 * static_cast<std::size_t>(tables_.n_watch) * plan.n);
  batch.history = history.data();
  Failure failure;
  PetscCall(backend_->Advance(batch, &failure));
  PetscCall(PetscLogEventEnd(events.batch, nullptr, nullptr, nullptr, nullptr));
  int good = batch.n;  // steps of the batch that are worth recording
  PetscCall(FirstFailure(failure, &good));
  if (!recorder_.Empty()) {
    const double begin = MPI_Wtime();
    for (PetscInt j = 0; j < std::min(good + 1, batch.n); ++j)
      times.push_back(Now().relax ? stage_time_ : plan.Time(j));
    PetscCall(recorder_.Record(plan.first, times, history.data(), tables_.n_watch));
    wall_output_ += MPI_Wtime() - begin;
  }
  if (good < batch.n) PetscCall(ReportFailure(plan, failure));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode Simulation::FirstFailure(const Failure &failure, int *step) {
  PetscFunctionBeginUser;
  if (failure.step >= 0) *step = failure.step;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, step, 1, MPI_INT, MPI_MIN, comm_));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode Simulation::ReportFailure(const StepPlan &plan, const Failure &failure) {
  PetscFunctionBeginUser;
  struct {
    int step, rank;
  } mine = {failure.step < 0 ? std::numeric_limits<int>::max() : failure.step, 0}, first;
  PetscCallMPI(MPI_Comm_rank(comm_, &mine.rank));
  PetscCallMPI(MPI_Allreduce(&mine, &first, 1, MPI_2INT, MPI_MINLOC, comm_));
  double x[3] = {0, 0, 0};
  if (first.rank == mine.rank) std::copy_n(&tables_.x[3 * static_cast<std::size_t>(failure.node)], 3, x);
  PetscCallMPI(MPI_Bcast(x, 3, MPI_DOUBLE, first.rank, comm_));
  const PetscInt step = plan.first + first.step + 1;
  std::string kept;
  PetscCall(WriteGoodState(&kept));
  CdemCheck(false, comm_,
            "the run became unstable: the velocity of the node at (%g, %g, %g) left the range of numbers in step %lld "
            "(time %g s). Likely cause: %s. %s",
            x[0], x[1], x[2], static_cast<long long>(step), plan.Time(first.step + 1), LikelyCause(plan.dt).c_str(),
            kept.c_str());
  PetscFunctionReturn(PETSC_SUCCESS);
}

}  // namespace cdem
