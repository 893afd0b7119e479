// The part of Simulation that belongs to a stage: its tables, its step, its TS, and the way to the next one.
#include "core/error.hpp"
#include "core/events.hpp"
#include "core/petsc_refusal.hpp"
#include "forces/params.hpp"
#include "forces/references.hpp"
#include "forces/single_check.hpp"
#include "loads/supports.hpp"
#include "simulation.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace cdem {

PetscErrorCode Simulation::BuildStage() {
  PetscFunctionBeginUser;
  const Scene &scene = Now();
  const bool removals = std::any_of(scene.removed.begin(), scene.removed.end(), [](char gone) { return gone != 0; });
  const std::vector<char> removed = removals ? scene.removed : std::vector<char>();
  PetscCall(PetscLogEventBegin(events.tables, nullptr, nullptr, nullptr, nullptr));
  device_tables_.reset();
  tables_ = Tables();
  PetscCall(CheckForms(mesh_, scene.materials, &remarks_));
  PetscCall(BuildTables(mesh_, nodes_, face_interface_, scene.materials, scene.joints, removed, &tables_));
  PetscCall(CheckSizes(mesh_, scene.materials, &remarks_));
  PetscCall(CheckJoints(mesh_, interface_names_, scene.materials, scene.joints, tables_, &remarks_));
  tables_.n_tables = static_cast<int>(scene.tables.size());
  tables_.beta = scene.beta;
  std::copy_n(scene.gravity, 3, tables_.gravity);
  alpha_ = scene.alpha;
  local_ = scene.local;
  const RelaxDamping damping = scene.relaxation.damping;
  if (scene.relax && local_ == 0 && (damping == RelaxDamping::kLocal || damping == RelaxDamping::kCombined))
    local_ = 0.8;
  tables_.damped = local_ > 0 || (scene.relax && scene.relaxation.scaling);
  tables_.combined = scene.relax && damping == RelaxDamping::kCombined;
  if (single_) {
    const std::string why = WhyNotSingle(tables_, book_.on);
    PetscCall(CheckFailure(comm_, why.empty() ? why : "-precision single: this scene needs double precision: " + why));
    CdemCheck(
        !scene.relax || scene.relaxation.ratio >= 1e-6, comm_,
        "-precision single and -relax_ratio %g: the rounding of the elements' forces alone leaves more than that out "
        "of balance; give 1e-6 or more",
        scene.relaxation.ratio);
  }
  PetscCall(BuildRecords(mesh_, nodes_, scene.boundaries, scene.materials, removed, histories_, &tables_));
  PetscCall(input_.Begin(tables_));
  PetscCall(CountStage());
  PetscCall(FindLawFields(tables_, &of_laws_));
  PetscCall(PetscLogEventEnd(events.tables, nullptr, nullptr, nullptr, nullptr));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode Simulation::CountStage() {
  PetscFunctionBeginUser;
  std::int64_t counts[kShapes + 3] = {};
  for (const ElementTable &t : tables_.elements) {
    const auto own = std::count_if(t.cell.begin(), t.cell.end(), [&](int c) { return c < mesh_.n_owned; });
    counts[static_cast<int>(t.shape)] += own;
    if (t.breaks) counts[kShapes + 2] += own;
  }
  for (std::size_t f = 0; f < mesh_.faces.size(); ++f)
    counts[kShapes] += face_interface_[f] >= 0 && mesh_.faces[f].cell[0] < mesh_.n_owned;
  for (const SpringTable &t : tables_.springs)
    counts[kShapes + 1] += std::count(t.counted.begin(), t.counted.end(), std::uint8_t{1});
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, counts, kShapes + 3, MPI_INT64_T, MPI_SUM, comm_));
  std::copy_n(counts, kShapes, n_cells_);
  n_interface_faces_ = counts[kShapes];
  n_springs_ = counts[kShapes + 1];
  n_breakable_ = counts[kShapes + 2];
  PetscFunctionReturn(PETSC_SUCCESS);
}

/// Elements and springs from which on a GPU finds the sharp step: with fewer the CPU needs no more than 0.1 s, in which the
/// linear algebra of a GPU hardly starts; and small scenes have the same step on both to the last bit.
static constexpr std::int64_t kSharpOnDevice = 20000;

PetscErrorCode Simulation::FindSharpStep() {
  PetscFunctionBeginUser;
  Mat on_device = nullptr;  // else on the host
#ifdef CDEM_HAVE_CUDA
  if (device_ == "cuda" && std::accumulate(n_cells_, n_cells_ + kShapes, n_springs_) >= kSharpOnDevice) {
    Phase("device");
    PetscCall(CopyToDevice());  // masses are final
    Phase("critical_step");
    PetscCall(CreateCudaElasticOperator(tables_, device_tables_, &on_device));
  }
#endif
  PetscCall(ComputeSharpStep(mesh_, nodes_, tables_, Now().materials, bound_, &sharp_, on_device));
  PetscCall(MatDestroy(&on_device));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode Simulation::FindLimit() {
  PetscFunctionBeginUser;
  Phase("step_bound");
  const Scene &scene = Now();
  const bool scaled = scene.relax && scene.relaxation.scaling;
  const bool given = scene.dt_given || KeepsStep(scene.dt_given);
  bound_known_ = scaled || !(given && scene.check == "off");
  sharp_known_ = bound_known_ && scene.limit == "sharp";
  if (bound_known_) PetscCall(ComputeStepBound(tables_, scene.materials, &bound_));
  if (scaled) ScaleMasses(scene.materials, bound_.element_w2 + bound_.spring_w2, &tables_);
  Phase("critical_step");
  if (sharp_known_) PetscCall(FindSharpStep());
  if (sharp_known_ && !sharp_.converged) remarks_.push_back(NotSharpText(sharp_));
  // A force that opposes the motion decelerates by up to 1 + local of it: as a body that much stiffer.
  if (local_ > 0 && bound_known_)
    bound_.dt = CriticalStep((1 + local_) * (bound_.element_w2 + bound_.spring_w2), scene.beta);
  if (local_ > 0 && sharp_known_)
    sharp_.dt = std::max(bound_.dt, RoundedStep(CriticalStep((1 + local_) * sharp_.w2, scene.beta)));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode Simulation::ChooseStep() {
  PetscFunctionBeginUser;
  const Scene &scene = Now();
  const bool kept = KeepsStep(scene.dt_given), given = scene.dt_given || kept;
  dt_ = kept ? restart_.Number("dt") : scene.dt;
  const PetscInt done = Resumes() ? first_step_ - stage_step_ : 0;
  const double left = scene.end_time - (Resumes() ? first_time_ - stage_time_ : 0);
  if (!given) {
    dt_ = scene.safety * dt_critical();
    CdemCheck(std::isfinite(dt_), comm_, "the critical step is not finite: give -ts_dt");
    if (scene.has_end_time && !scene.relax && left > 0) dt_ = left / std::ceil(left / dt_);
  } else if (!kept && bound_known_ && dt_ > dt_critical()) {
    const std::string above = StepAboveText(dt_, bound_, sharp_known_ ? &sharp_ : nullptr);
    CdemCheck(scene.check != "error", comm_, "%s. Use a smaller -ts_dt (or none), or go on with -ts_central_check warn",
              above.c_str());
    remarks_.push_back(above + ": the run may be unstable");
  }
  last_step_ = PETSC_INT_MAX;
  if (!scene.relax && scene.has_end_step) last_step_ = stage_step_ + scene.end_step;
  if (!scene.relax && scene.has_end_time && left / dt_ < static_cast<double>(last_step_ - stage_step_ - done))
    last_step_ = stage_step_ + done + static_cast<PetscInt>(std::ceil(left / dt_ - 1e-6));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/// [in] dt_old: the step that u and v come from [s]; 0: v holds velocities at the time of u.
PetscErrorCode Simulation::CreateTS(double dt_old) {
  PetscFunctionBeginUser;
  const Scene &scene = Now();
  PetscBool given;
  PetscCall(PetscOptionsHasName(nullptr, nullptr, "-ts_max_steps", &given));
  if (given && scene.has_end_step)  // TS reads it too, and knows no 1e3
    PetscCall(PetscOptionsSetValue(nullptr, "-ts_max_steps", std::to_string(scene.end_step).c_str()));
  PetscCall(CreateTSCentral(comm_, this, batch_, u_, v_, &ts_));
  PetscCall(TSSetTimeStep(ts_, dt_));
  PetscCall(SetFromOptions(
      comm_, "time stepper", [](void *ts) { return TSSetFromOptions(static_cast<TS>(ts)); }, ts_));
  PetscCall(TSMonitorSet(ts_, MonitorTS, this, nullptr));  // not one that -ts_monitor_cancel would remove
  TSType type;
  PetscCall(TSGetType(ts_, &type));
  CdemCheck(std::string(type) == "central", comm_,
            "-ts_type %s: cdem steps with central differences only; leave it out", type);
  PetscCall(TSSetStepNumber(ts_, stage_step_));
  PetscCall(TSSetTime(ts_, stage_time_));
  PetscCall(TSSetTimeStep(ts_, dt_));
  const bool timed = scene.has_end_time && !scene.relax;
  const PetscInt steps = scene.relax ? scene.relaxation.max_steps : scene.end_step;
  PetscCall(TSSetMaxTime(ts_, timed ? stage_time_ + scene.end_time : PETSC_MAX_REAL));
  PetscCall(TSSetMaxSteps(ts_, steps < PETSC_INT_MAX - stage_step_ ? stage_step_ + steps : PETSC_INT_MAX));
  PetscCall(TSCentralSetLastStep(ts_, dt_old));
  relaxation_ = scene.relax ? std::make_unique<Relaxation>(scene.relaxation) : nullptr;
  to_keep_ = RelaxMemory();
  balanced_ = false;
  if (relaxation_) PetscCall(TSSetApplicationContext(ts_, this));
  if (relaxation_)
    PetscCall(TSSetPostStep(ts_, WatchBalance));  // a monitor's word would be lost: the next step clears it
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode Simulation::EndStage() {
  PetscFunctionBeginUser;
  double time;
  PetscCall(TSGetTime(ts_, &time));
  if (Now().relax) {
    pseudo_time_ += time - stage_time_;
    if (!balanced_) PetscCall(ReportImbalance());
    PetscCall(StopMotion());
  }
  for (const auto &[phase, seconds] : backend_->Phases()) solve_phases_[phase] += seconds;
  stage_summaries_.push_back(StageSummary());
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode Simulation::FindReactions(std::vector<double> *reaction) {
  PetscFunctionBeginUser;
  const std::vector<Boundary> &boundaries = Now().boundaries;
  if (!KeepsReactions(boundaries, scenes_[stage_ + 1].boundaries)) PetscFunctionReturn(PETSC_SUCCESS);
  holds_ = true;
  const double *u, *v;
  const Histories *history;
  double dt_old, time;
  PetscCall(TSCentralGetLastStep(ts_, &dt_old));
  PetscCall(TSGetTime(ts_, &time));
  PetscCall(backend_->Download(&u, &v, &history));
  std::vector<double> schedule(3 * Now().tables.size());
  FillSchedule(time - stage_time_, dt_, schedule.data());
  ElementResults elements;
  SpringResults springs;
  // What is out of balance where nothing were prescribed is what the supports carry.
  std::vector<std::uint8_t> kind(tables_.records.kind.size(), 0);
  std::swap(kind, tables_.records.kind);
  PetscCall(ObserveOnHost(tables_, static_cast<int>(mesh_.n_owned), u, v, *history, MakeArgs(dt_old, dt_),
                          schedule.data(), &elements, &springs, nullptr, nullptr, reaction));
  std::swap(kind, tables_.records.kind);
  for (double &force : *reaction) force = -force;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode Simulation::NextStage() {
  PetscFunctionBeginUser;
  const double begin = MPI_Wtime();
  const double *u, *v;
  const Histories *history;
  double dt_old;
  PetscCall(TSCentralGetLastStep(ts_, &dt_old));
  PetscCall(backend_->Download(&u, &v, &history));
  const std::size_t n = 3 * static_cast<std::size_t>(tables_.n_owned);
  const std::vector<double> u_end(u, u + 3 * static_cast<std::size_t>(tables_.n_local)), v_end(v, v + n);
  const Histories before = *history;
  AuditSums at_end, at_start;
  if (book_.on) PetscCall(TakeAudit(&at_end));
  std::vector<double> reaction;
  PetscCall(FindReactions(&reaction));
  PetscCall(TSDestroy(&ts_));
  PetscCall(VecDestroy(&u_));
  PetscCall(VecDestroy(&v_));
  const Tables old = std::move(tables_);
  backend_.reset();

  ++stage_;
  stage_time_ = time_;
  stage_step_ = steps_;
  PetscCall(BuildStage());
  PetscCall(FindLimit());
  PetscCall(ChooseStep());
  PetscCall(IdentifyScene());
  if (holds_) {
    held_.resize(n);
    const Scene &last = scenes_[stage_ - 1];
    PetscCall(
        HoldReactions(mesh_, nodes_, last.boundaries, old, last.relax, Now().boundaries, tables_, reaction, &held_));
    AddLoads(held_, &tables_);
  }
  Histories after;
  PetscCall(TransferHistories(mesh_, old, before, tables_, u_end.data(), &after));
  PetscCall(CreateBackend());
  PetscCall(backend_->Upload(u_end.data(), v_end.data(), after));
  if (Now().reset) {
    origin_ = u_end;
    PetscCall(recorder_.SetOrigin(origin_.data()));
  }
  if (Now().removes && !output_dir_.empty()) PetscCall(WriteMeshes());
  PetscCall(CreateTS(dt_old));
  if (book_.on) {
    PetscCall(TakeAudit(&at_start));
    book_.NextStage(at_end, at_start);
  }
  start_energy_ = -1;
  good_ = GoodState();
  PetscCall(PrintStage());
  wall_stages_ += MPI_Wtime() - begin;
  PetscFunctionReturn(PETSC_SUCCESS);
}

}  // namespace cdem
