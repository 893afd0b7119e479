// The part of Simulation that follows the energy: its balance, and the end of a run whose energy grows without a cause.
#include "core/error.hpp"
#include "simulation.hpp"

#include <algorithm>
#include <cmath>

namespace cdem {

PetscErrorCode Simulation::ReadAudit() {
  PetscFunctionBeginUser;
  char text[PETSC_MAX_PATH_LEN] = "";
  PetscBool set, on = PETSC_TRUE;
  PetscCall(PetscOptionsGetString(nullptr, nullptr, "-monitor_energy", text, sizeof text, &set));
  const std::string value = text;
  if (value == "true" || value == "false")  // what YAML makes of a switch
    PetscCall(PetscOptionsGetBool(nullptr, nullptr, "-monitor_energy", &on, &set));
  book_.on = set && on;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/// The backend's sums at the time at which TS stands (collective).
PetscErrorCode Simulation::TakeAudit(AuditSums *sums) {
  PetscFunctionBeginUser;
  double dt, time;
  PetscCall(TSCentralGetLastStep(ts_, &dt));
  PetscCall(TSGetTime(ts_, &time));
  const double reached = dt > 0 ? dt : dt_;
  std::vector<double> schedule(3 * Now().tables.size());
  FillSchedule(time - stage_time_, reached, schedule.data());
  PetscCall(backend_->Audit(MakeArgs(dt, reached), schedule.data(), sums));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode Simulation::BeginAudit() {
  PetscFunctionBeginUser;
  if (!book_.on) PetscFunctionReturn(PETSC_SUCCESS);
  if (!restart_file_.empty() && restart_.Number("audit") != 0) {
    AuditArrays arrays;
    PetscCall(restart_.ReadAudit(checkpoint_scene_, &arrays));
    PetscCall(backend_->UploadAudit(arrays));
    book_.Resume(restart_.Number("audit_initial"), restart_.Number("audit_weight"));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  if (!restart_file_.empty())
    remarks_.push_back(
        "the energy balance begins at the restart: the run that wrote the checkpoint had none "
        "(-monitor_energy)");
  AuditSums sums;
  PetscCall(TakeAudit(&sums));
  book_.Begin(sums);
  PetscFunctionReturn(PETSC_SUCCESS);
}

std::string Simulation::LikelyCause(double dt) const {
  if (!bound_known_ || dt > dt_critical()) return "a time step above the critical one (leave out -ts_dt)";
  return "a strength, stiffness or load out of proportion";
}

/// How far the energy of an unstable run lies above all that can have come in when it is stopped.
static constexpr double kGrowth = 1000;

PetscErrorCode Simulation::CheckGrowth(PetscInt step, double time, const Observed &o) {
  PetscFunctionBeginUser;
  const double energy = o.kinetic + o.strain + o.spring;
  if (start_energy_ < 0) start_energy_ = energy;
  // not its own earlier values: a run that is looked at often would outgrow each of them a little
  const double known = std::max(std::fabs(o.load_u), input_.Energy(start_energy_));
  if (std::isfinite(energy) && energy <= kGrowth * known) PetscFunctionReturn(PETSC_SUCCESS);
  const double *u, *v;
  const Histories *history;
  PetscCall(backend_->Download(&u, &v, &history));
  double largest = 0, x[3] = {0, 0, 0};
  for (int i = 0; i < tables_.n_owned; ++i) {
    const double *at = v + 3 * static_cast<std::ptrdiff_t>(i);
    const double size = std::isfinite(Dot(at, at)) ? tables_.mass[i] * Dot(at, at) : PETSC_MAX_REAL;
    if (size <= largest) continue;
    largest = size;
    std::copy_n(&tables_.x[3 * static_cast<std::size_t>(i)], 3, x);
  }
  PetscCall(LargestOverRanks(comm_, &largest, x));
  std::string kept;
  PetscCall(WriteGoodState(&kept));
  CdemCheck(
      false, comm_,
      "the run became unstable: at step %lld (time %g s) its energy is %.3g J, where with all that loads and "
      "boundaries can have brought in it can be %.3g J at most; most of it moves at (%g, %g, %g). Likely cause: %s. "
      "%s",
      static_cast<long long>(step), time, energy, input_.Energy(start_energy_), x[0], x[1], x[2],
      LikelyCause(dt_).c_str(), kept.c_str());
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode Simulation::KeepGoodState(PetscInt step) {
  PetscFunctionBeginUser;
  if (output_dir_.empty()) PetscFunctionReturn(PETSC_SUCCESS);
  const double *u, *v;
  const Histories *history;
  const AuditArrays *audit;
  PetscCall(backend_->Download(&u, &v, &history));
  PetscCall(backend_->DownloadAudit(&audit));
  good_.step = step;
  PetscCall(TSGetTime(ts_, &good_.time));
  PetscCall(TSCentralGetState(ts_, &good_.central));
  good_.u.assign(u, u + 3 * static_cast<std::ptrdiff_t>(tables_.n_owned));
  good_.v.assign(v, v + 3 * static_cast<std::ptrdiff_t>(tables_.n_owned));
  good_.history = *history;
  good_.audit = *audit;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/// Puts the last state that passed its check onto the disk, as a frame and, where the scene can be restarted, as a
/// checkpoint. [out] said: where it is.
PetscErrorCode Simulation::WriteGoodState(std::string *said) {
  PetscFunctionBeginUser;
  *said =
      output_dir_.empty() ? "No state was written: there is no -output DIR" : "What was written before stays on disk";
  if (good_.step < 0) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(backend_->Upload(good_.u.data(), good_.v.data(), good_.history));
  if (book_.on) PetscCall(backend_->UploadAudit(good_.audit));
  PetscCall(TSCentralSetState(ts_, good_.central));
  steps_ = good_.step;
  time_ = Now().relax ? stage_time_ : good_.time;
  if (last_frame_ != good_.step) PetscCall(WriteFrame(good_.step, good_.time));
  const std::string step = std::to_string(good_.step);
  *said = "The last good state, of step " + step + ", is the last frame in " + output_dir_;
  if (!Staged() && !Now().relax && good_.step > first_step_) {
    if (!checkpoints_.Active() && restart_file_.empty()) PetscCall(IdentifyScene(true));
    if (last_checkpoint_ != good_.step) PetscCall(WriteCheckpoint(good_.step));
    *said += " and in checkpoint_" + step + ".h5";
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

}  // namespace cdem
