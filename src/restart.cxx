// The part of Simulation that writes checkpoints, and starts from one.
#include "core/error.hpp"
#include "core/events.hpp"
#include "simulation.hpp"

namespace cdem {

PetscErrorCode Simulation::ReadRestart() {
  PetscFunctionBeginUser;
  PetscCall(checkpoints_.ReadOptions(options_, output_dir_));
  PetscCall(options_.Text("restart", &restart_file_));
  if (restart_file_.empty()) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(restart_.Open(comm_, restart_file_));
  first_step_ = restart_.step();
  first_time_ = restart_.time();
  PetscMPIInt rank;
  int holds = 0;
  PetscCallMPI(MPI_Comm_rank(comm_, &rank));
  if (rank == 0 && !output_dir_.empty()) holds = EarlierRun::Holds(output_dir_, restart_file_);
  PetscCallMPI(MPI_Bcast(&holds, 1, MPI_INT, 0, comm_));
  goes_on_ = holds != 0;
  CdemCheck(
      !goes_on_ || !output_overwrite_, comm_,
      "-output_overwrite would remove the checkpoint that the run starts from, %s: leave it out to go on in %s, or "
      "give another -output",
      restart_file_.c_str(), output_dir_.c_str());
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode Simulation::IdentifyScene(bool wanted) {
  PetscFunctionBeginUser;
  if (!wanted && !checkpoints_.Active() && restart_file_.empty()) PetscFunctionReturn(PETSC_SUCCESS);
  checkpoint_scene_.mesh = &mesh_;
  checkpoint_scene_.nodes = &nodes_;
  checkpoint_scene_.tables = &tables_;
  checkpoint_scene_.audited = book_.on;
  PetscCall(TakeFingerprint(mesh_, nodes_, face_interface_, tables_, Now().tables, &checkpoint_scene_.fingerprint));
  std::vector<GivenOption> options;
  PetscCall(ListOptions(&options));
  checkpoint_scene_.options = SceneOptions(options);
  if (!restart_file_.empty()) PetscCall(restart_.CheckScene(checkpoint_scene_));
  PetscFunctionReturn(PETSC_SUCCESS);
}

bool Simulation::KeepsStep(bool dt_given) const {
  return !restart_file_.empty() && !dt_given && restart_.Number("safety") == Now().safety;
}

PetscErrorCode Simulation::LoadCheckpoint() {
  PetscFunctionBeginUser;
  if (restart_file_.empty()) PetscFunctionReturn(PETSC_SUCCESS);
  CdemCheck(Now().end_step >= first_step_, comm_,
            "-ts_max_steps is %lld, but %s is at step %lld: steps count from the start of the scene; give a later end",
            static_cast<long long>(Now().end_step), restart_file_.c_str(), static_cast<long long>(first_step_));
  CdemCheck(!Now().has_end_time || first_time_ < Now().end_time + 1e-6 * dt_, comm_,
            "-ts_max_time is %g s, but %s is at %g s: time counts from the start of the scene; give a later end",
            Now().end_time, restart_file_.c_str(), first_time_);
  std::vector<double> u, v;
  Histories history;
  PetscCall(restart_.ReadState(checkpoint_scene_, &u, &v, &history));
  PetscCall(backend_->Upload(u.data(), v.data(), history));
  CentralState state;
  state.step = first_step_;
  state.base_step = static_cast<PetscInt>(restart_.Number("base_step"));
  state.time = first_time_;
  state.base_time = restart_.Number("base_time");
  state.dt = restart_.Number("run_dt");
  state.dt_old = restart_.Number("dt_old");
  PetscCall(TSCentralSetState(ts_, state));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode Simulation::OpenOutput() {
  PetscFunctionBeginUser;
  if (output_dir_.empty()) PetscFunctionReturn(PETSC_SUCCESS);
  if (goes_on_) {
    std::vector<std::string> names;
    for (const History &h : histories_) names.push_back(h.name);
    PetscCall(earlier_.Look(comm_, output_dir_, first_step_, names.empty() ? "" : HistoryFile::Header(names)));
    PetscCall(earlier_.Begin());
  } else {
    PetscCall(PrepareOutputDir(comm_, output_dir_, output_overwrite_));
  }
  PetscCall(WriteJointSets());
  PetscCall(recorder_.Open(comm_, output_dir_, histories_, goes_on_));
  PetscCall(fields_.Open(output_dir_, mesh_, nodes_, tables_, face_interface_, with_plastic_, with_broken_));
  if (!goes_on_) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(fields_.Continue(&earlier_));
  PetscCall(earlier_.RemoveLater());
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode Simulation::WriteCheckpoint(PetscInt step) {
  PetscFunctionBeginUser;
  PetscCall(PetscLogEventBegin(events.frame, nullptr, nullptr, nullptr, nullptr));
  CentralState state;
  PetscCall(TSCentralGetState(ts_, &state));
  Numbers numbers = {{"step", static_cast<double>(step)},
                     {"time", state.time},
                     {"dt", dt_},
                     {"safety", Now().safety},
                     {"dt_old", state.dt_old},
                     {"run_dt", state.dt},
                     {"base_step", static_cast<double>(state.base_step)},
                     {"base_time", state.base_time}};
  for (const auto &[name, value] : book_.Numbers()) numbers[name] = value;
  const double *u, *v;
  const Histories *history;
  const AuditArrays *audit;
  PetscCall(backend_->Download(&u, &v, &history));
  PetscCall(backend_->DownloadAudit(&audit));
  PetscCall(checkpoints_.Write(checkpoint_scene_, step, numbers, u, v, *history, *audit));
  last_checkpoint_ = step;
  PetscCall(PetscLogEventEnd(events.frame, nullptr, nullptr, nullptr, nullptr));
  PetscFunctionReturn(PETSC_SUCCESS);
}

}  // namespace cdem
