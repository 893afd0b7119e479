// The part of Simulation that writes checkpoints, and starts from one.
#include "core/checksum.hpp"
#include "core/error.hpp"
#include "core/events.hpp"
#include "core/random.hpp"
#include "loads/supports.hpp"
#include "simulation.hpp"

#include <algorithm>

namespace cdem {

/// How long the stages before one run, and their tables: what shapes a checkpoint and is no option of its scene.
static std::int64_t OfStagesBefore(const std::vector<Scene> &scenes, std::size_t stage) {
  std::uint64_t h = 10;
  for (std::size_t s = 0; s < stage; ++s) {
    const Scene &scene = scenes[s];
    h = MixBits(h, scene.relax);
    if (scene.relax) {
      for (double value : {scene.relaxation.ratio, scene.relaxation.kinetic}) h = MixReal(h, value);
      h = MixBits(h, static_cast<std::uint64_t>(scene.relaxation.max_steps));
    } else {
      h = MixReal(h, scene.has_end_time ? scene.end_time : 0);
      h = MixBits(h, static_cast<std::uint64_t>(scene.has_end_step ? scene.end_step : -1));
    }
    h = MixReal(h, scene.dt_given ? scene.dt : -scene.safety);
    h = MixBits(h, KeyNumber(scene.limit));
    h = MixBits(h, OfTables(scene.tables));
  }
  return static_cast<std::int64_t>(h);
}

/// Brings values [n_owned][3] to the ghosts too: [n_local][3].
static PetscErrorCode AddGhosts(const Nodes &nodes, std::vector<double> *values) {
  PetscFunctionBeginUser;
  values->resize(3 * static_cast<std::size_t>(nodes.n_local));
  if (!nodes.halo) PetscFunctionReturn(PETSC_SUCCESS);
  double *ghosts = values->data() + 3 * static_cast<std::size_t>(nodes.n_owned);
  MPI_Datatype unit;
  PetscCallMPI(MPI_Type_contiguous(3, MPI_DOUBLE, &unit));
  PetscCallMPI(MPI_Type_commit(&unit));
  PetscCall(PetscSFBcastBegin(nodes.halo, unit, values->data(), ghosts, MPI_REPLACE));
  PetscCall(PetscSFBcastEnd(nodes.halo, unit, values->data(), ghosts, MPI_REPLACE));
  PetscCallMPI(MPI_Type_free(&unit));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode Simulation::ReadRestart() {
  PetscFunctionBeginUser;
  PetscCall(checkpoints_.ReadOptions(options_, output_dir_));
  PetscCall(options_.Text("restart", &restart_file_));
  if (restart_file_.empty()) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(restart_.Open(comm_, restart_file_));
  first_step_ = restart_.step();
  first_time_ = restart_.time();
  first_stage_ = static_cast<std::size_t>(std::max<PetscInt>(0, restart_.Integer("stage")));
  stage_step_ = restart_.Integer("stage_step");
  stage_time_ = restart_.Number("stage_time");
  pseudo_time_ = restart_.Number("pseudo_time");
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
  if (stage_ > 0)
    checkpoint_scene_.fingerprint.emplace_back("sum: lengths or time tables of the stages before",
                                               OfStagesBefore(scenes_, stage_));
  checkpoint_scene_.stage = static_cast<int>(stage_);
  std::vector<GivenOption> options;
  PetscCall(ListOptions(&options));
  checkpoint_scene_.options = SceneOptions(options);
  if (Resumes()) PetscCall(restart_.CheckScene(checkpoint_scene_));
  PetscFunctionReturn(PETSC_SUCCESS);
}

bool Simulation::KeepsStep(bool dt_given) const {
  return Resumes() && !dt_given && restart_.Number("safety") == Now().safety;
}

PetscErrorCode Simulation::CheckEnd() {
  PetscFunctionBeginUser;
  const Scene &scene = Now();
  const std::string stage = Staged() ? "stage '" + scene.name + "'" : "the scene";
  const long long done = first_step_ - stage_step_, most = scene.relax ? scene.relaxation.max_steps : scene.end_step;
  const double spent = first_time_ - stage_time_;
  CdemCheck(most >= done, comm_,
            "-%s_max_steps is %lld, but %s is at step %lld: steps count from the start of %s; give a later end",
            scene.relax ? "relax" : "ts", most, restart_file_.c_str(), done, stage.c_str());
  CdemCheck(scene.relax || !scene.has_end_time || spent < scene.end_time + 1e-6 * dt_, comm_,
            "-ts_max_time is %g s, but %s is at %g s: time counts from the start of %s; give a later end",
            scene.end_time, restart_file_.c_str(), spent, stage.c_str());
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode Simulation::LoadCheckpoint() {
  PetscFunctionBeginUser;
  if (restart_file_.empty()) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(CheckEnd());
  std::vector<double> u, v;
  Histories history;
  PetscCall(restart_.ReadState(checkpoint_scene_, &u, &v, &history));
  PetscCall(restart_.ReadNodes(checkpoint_scene_, "acceleration", &history.acceleration));
  PetscCall(backend_->Upload(u.data(), v.data(), history));
  PetscCall(restart_.ReadNodes(checkpoint_scene_, "origin", &origin_));
  int reset = !origin_.empty();  // a rank may own no node
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &reset, 1, MPI_INT, MPI_MAX, comm_));
  if (reset) PetscCall(AddGhosts(nodes_, &origin_));
  CentralState state;
  state.step = first_step_;
  state.base_step = static_cast<PetscInt>(restart_.Number("base_step"));
  state.time = first_time_;
  state.base_time = restart_.Number("base_time");
  state.dt = restart_.Number("run_dt");
  state.dt_old = restart_.Number("dt_old");
  PetscCall(TSCentralSetState(ts_, state));
  PetscCall(LoadRelaxation());
  PetscFunctionReturn(PETSC_SUCCESS);
}

/// Before a backend copies the tables.
PetscErrorCode Simulation::LoadHeld() {
  PetscFunctionBeginUser;
  if (restart_file_.empty()) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(restart_.ReadNodes(checkpoint_scene_, "held", &held_));
  int holds = !held_.empty();
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &holds, 1, MPI_INT, MPI_MAX, comm_));
  holds_ = holds != 0;
  if (holds_) AddLoads(held_, &tables_);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode Simulation::LoadRelaxation() {
  PetscFunctionBeginUser;
  if (!relaxation_) PetscFunctionReturn(PETSC_SUCCESS);
  to_keep_ = {restart_.Number("relax_peak"), restart_.Number("relax_rising"), restart_.Number("relax_alpha"),
              static_cast<int>(restart_.Integer("relax_calm"))};
  const RelaxPlan &plan = relaxation_->plan();
  const bool same = restart_.Number("relax_ratio") == plan.ratio && restart_.Number("relax_kinetic") == plan.kinetic;
  if (!same) to_keep_.calm = 0;  // what was calm by other limits counts no more
  relaxation_->Recall(to_keep_);
  if (FindsDamping()) alpha_ = relaxation_->Alpha();
  BalanceMemory memory;
  PetscCall(restart_.ReadNodes(checkpoint_scene_, "checked_displacement", &memory.u));
  PetscCall(restart_.ReadNodes(checkpoint_scene_, "checked_residual", &memory.residual));
  PetscCall(backend_->UploadBalance(memory));
  balanced_ = same && to_keep_.calm >= 2;
  if (balanced_) PetscCall(TSSetMaxSteps(ts_, first_step_));  // it has ended there
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode Simulation::WriteMeshes() {
  PetscFunctionBeginUser;
  const auto end = scenes_.begin() + static_cast<std::ptrdiff_t>(stage_) + 1;
  const auto number = std::count_if(scenes_.begin(), end, [](const Scene &scene) { return scene.removes; });
  PetscCall(fields_.WriteMesh(number > 0 ? Now().removed : std::vector<char>(), static_cast<int>(number)));
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
  if (!origin_.empty()) PetscCall(recorder_.SetOrigin(origin_.data()));
  fields_.Open(output_dir_, mesh_, nodes_, tables_, face_interface_, of_laws_);
  PetscCall(WriteMeshes());
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
                     {"base_time", state.base_time},
                     {"stage", static_cast<double>(stage_)},
                     {"stage_step", static_cast<double>(stage_step_)},
                     {"stage_time", stage_time_},
                     {"pseudo_time", pseudo_time_}};
  for (const auto &[name, value] : book_.Numbers()) numbers[name] = value;
  const double *u, *v;
  const Histories *history;
  const AuditArrays *audit;
  PetscCall(backend_->Download(&u, &v, &history));
  PetscCall(backend_->DownloadAudit(&audit));
  NodeFields more;
  const auto reset = [](const Scene &scene) { return scene.reset; };
  if (std::any_of(scenes_.begin() + 1, scenes_.begin() + 1 + static_cast<std::ptrdiff_t>(stage_), reset))
    more.emplace_back("origin", origin_.data());
  if (holds_) more.emplace_back("held", held_.data());
  if (tables_.combined) more.emplace_back("acceleration", history->acceleration.data());
  if (relaxation_) {
    numbers.insert({{"relax_peak", to_keep_.peak},
                    {"relax_rising", to_keep_.rising},
                    {"relax_alpha", to_keep_.alpha},
                    {"relax_calm", to_keep_.calm},
                    {"relax_ratio", relaxation_->plan().ratio},
                    {"relax_kinetic", relaxation_->plan().kinetic}});
    const BalanceMemory *memory;
    PetscCall(backend_->DownloadBalance(&memory));
    more.emplace_back("checked_displacement", memory->u.data());
    more.emplace_back("checked_residual", memory->residual.data());
  }
  PetscCall(checkpoints_.Write(checkpoint_scene_, step, numbers, u, v, more, *history, *audit));
  last_checkpoint_ = step;
  PetscCall(PetscLogEventEnd(events.frame, nullptr, nullptr, nullptr, nullptr));
  PetscFunctionReturn(PETSC_SUCCESS);
}

}  // namespace cdem
