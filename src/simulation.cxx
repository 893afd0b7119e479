#include "simulation.hpp"

#include "core/error.hpp"
#include "core/events.hpp"
#include "mesh/interfaces.hpp"
#include "physics/laws.hpp"

#include <algorithm>
#include <cmath>

namespace cdem {

Simulation::~Simulation() {
  (void)TSDestroy(&ts_);
  (void)VecDestroy(&u_);
  (void)VecDestroy(&v_);
}

PetscErrorCode Simulation::SetUp() {
  PetscFunctionBeginUser;
  wall_start_ = MPI_Wtime();
  PetscCall(PetscLogStagePush(events.setup));
  PetscCall(ReadScene());
  PetscCall(BuildModel());
  Phase("step_bound");
  PetscCall(ChooseStep());
  Phase("device");
  PetscCall(CreateBackend());
  PetscCall(CreateTS());
  Phase("files");
  PetscCall(monitors_.ReadOptions(options_, last_step_));
  PetscCall(options_.CheckLeft());
  if (!output_dir_.empty()) {
    PetscCall(PrepareOutputDir(comm_, output_dir_, output_overwrite_));
    PetscCall(WriteJointSets());
    PetscCall(recorder_.Open(comm_, output_dir_, histories_));
    PetscCall(fields_.Open(output_dir_, mesh_, nodes_, tables_, face_interface_));
  }
  PetscCall(monitors_.Open(comm_, n_breakable_ > 0));
  PetscCall(PetscLogStagePop());
  wall_setup_ = MPI_Wtime() - wall_start_;
  wall_phases_.back().second += MPI_Wtime();
  PetscCall(PrintHeader());
  PetscFunctionReturn(PETSC_SUCCESS);
}

void Simulation::Phase(const char *name) {
  const double now = MPI_Wtime();
  if (!wall_phases_.empty()) wall_phases_.back().second += now;
  wall_phases_.emplace_back(name, -now);
}

PetscErrorCode Simulation::ReadScene() {
  PetscFunctionBeginUser;
  std::string solve = "dynamic";
  PetscCall(options_.Word("solve", &solve));
  PetscCall(options_.Word("device", &device_));
  PetscCall(options_.Text("output", &output_dir_));
  if (!output_dir_.empty()) {
    PetscCall(options_.Flag("output_overwrite", &output_overwrite_));
    PetscCall(ReadInterval(options_, "output_", &frame_interval_));
    PetscCall(fields_.Create(comm_, options_));
  }
  Phase("mesh");
  PetscCall(PetscLogEventBegin(events.mesh, nullptr, nullptr, nullptr, nullptr));
  PetscCall(CreateMesh(comm_, options_, &mesh_));
  PetscCall(PetscLogEventEnd(events.mesh, nullptr, nullptr, nullptr, nullptr));
  remarks_ = mesh_.remarks;
  Phase("joints");
  std::vector<FaceSet> joint_faces;
  PetscCall(CreateJointSets(mesh_, options_, &joint_sets_, &joint_faces, &remarks_));
  Phase("scene");
  PetscCall(SelectInterfaces(mesh_, options_, joint_faces, &interface_names_, &face_interface_));
  PetscCall(ReadMaterials(options_, mesh_.regions, &materials_, &remarks_));
  PetscCall(ReadJoints(options_, interface_names_, &joints_, &remarks_));
  PetscCall(ReadTables(options_, &table_names_, &time_tables_));
  PetscCall(ReadBoundaries(mesh_, options_, table_names_, &boundaries_));
  PetscCall(options_.Reals("gravity", 3, tables_.gravity));
  PetscCall(options_.Real("damping_alpha", &tables_.alpha));
  PetscCall(options_.Real("damping_beta", &tables_.beta));
  CdemCheck(tables_.alpha >= 0, comm_, "-damping_alpha is %g; it must be at least 0", tables_.alpha);
  CdemCheck(tables_.beta >= 0, comm_, "-damping_beta is %g; it must be at least 0", tables_.beta);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode Simulation::BuildModel() {
  PetscFunctionBeginUser;
  Phase("split");
  PetscCall(PetscLogEventBegin(events.split, nullptr, nullptr, nullptr, nullptr));
  PetscCall(CreateNodes(mesh_, face_interface_, &nodes_));
  PetscCall(PetscLogEventEnd(events.split, nullptr, nullptr, nullptr, nullptr));
  PetscCall(ReadHistories(mesh_, nodes_, options_, &histories_));
  if (!histories_.empty()) PetscCall(recorder_.ReadOptions(options_));
  if (output_dir_.empty() && !histories_.empty()) {
    remarks_.push_back("histories are declared but there is no -output DIR: they are not recorded");
    histories_.clear();
  }
  Phase("tables");
  PetscCall(PetscLogEventBegin(events.tables, nullptr, nullptr, nullptr, nullptr));
  PetscCall(CheckForms(mesh_, materials_, &remarks_));
  PetscCall(BuildTables(mesh_, nodes_, face_interface_, materials_, joints_, &tables_));
  PetscCall(CheckJoints(mesh_, interface_names_, materials_, joints_, tables_, &remarks_));
  tables_.n_tables = static_cast<int>(time_tables_.size());
  PetscCall(BuildRecords(mesh_, nodes_, boundaries_, histories_, &tables_));
  PetscCall(PetscLogEventEnd(events.tables, nullptr, nullptr, nullptr, nullptr));
  PetscCall(DMDestroy(&mesh_.dm));  // from here on the flat arrays serve
  std::int64_t counts[kShapes + 3] = {};
  for (PetscInt c = 0; c < mesh_.n_owned; ++c) ++counts[static_cast<int>(mesh_.cell_shape[c])];
  for (std::size_t f = 0; f < mesh_.faces.size(); ++f)
    counts[kShapes] += face_interface_[f] >= 0 && mesh_.faces[f].cell[0] < mesh_.n_owned;
  for (const SpringTable &t : tables_.springs)
    counts[kShapes + 1] += std::count(t.counted.begin(), t.counted.end(), std::uint8_t{1});
  for (const ElementTable &t : tables_.elements)
    if (t.breaks)
      counts[kShapes + 2] += std::count_if(t.cell.begin(), t.cell.end(), [&](int c) { return c < mesh_.n_owned; });
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, counts, kShapes + 3, MPI_INT64_T, MPI_SUM, comm_));
  std::copy_n(counts, kShapes, n_cells_);
  n_interface_faces_ = counts[kShapes];
  n_springs_ = counts[kShapes + 1];
  n_breakable_ = counts[kShapes + 2];
  PetscFunctionReturn(PETSC_SUCCESS);
}

/// -ts_dt, -ts_max_time and -ts_max_steps belong to TS; they are looked at here because the default step depends on them.
PetscErrorCode Simulation::ChooseStep() {
  PetscFunctionBeginUser;
  bool dt_given;
  std::string check = "error";
  PetscCall(options_.Word("ts_central_check", &check));
  PetscCall(options_.Real("ts_central_safety", &safety_));
  CdemCheck(safety_ > 0 && safety_ <= 1, comm_, "-ts_central_safety is %g; it must be above 0 and at most 1", safety_);
  PetscCall(options_.Real("ts_dt", &dt_, &dt_given));
  PetscCall(options_.Real("ts_max_time", &end_time_, &has_end_time_));
  PetscCall(options_.Int("ts_max_steps", &end_step_, &has_end_step_));
  if (has_end_step_)  // TS reads it too, and knows no 1e3
    PetscCall(PetscOptionsSetValue(nullptr, "-ts_max_steps", std::to_string(end_step_).c_str()));
  CdemCheck(has_end_time_ || has_end_step_, comm_,
            "how long to run? Give -ts_max_time in s, or -ts_max_steps, or both");
  CdemCheck(!has_end_time_ || (end_time_ > 0 && std::isfinite(end_time_)), comm_,
            "-ts_max_time is %g; it must be above 0", end_time_);
  CdemCheck(!has_end_step_ || end_step_ >= 0, comm_, "-ts_max_steps is %lld; it must be at least 0",
            static_cast<long long>(end_step_));
  CdemCheck(!dt_given || (dt_ > 0 && std::isfinite(dt_)), comm_, "-ts_dt is %g; it must be above 0", dt_);
  bound_known_ = !(dt_given && check == "off");
  if (bound_known_) PetscCall(ComputeStepBound(tables_, materials_, &bound_));
  if (!dt_given) {
    dt_ = safety_ * bound_.dt;
    CdemCheck(std::isfinite(dt_), comm_, "the critical step is not finite: give -ts_dt");
    if (has_end_time_) dt_ = end_time_ / std::ceil(end_time_ / dt_);
  } else if (bound_known_ && dt_ > bound_.dt) {
    CdemCheck(check != "error", comm_,
              "-ts_dt %g is above the critical step %g s. That number is a rigorous bound, up to 1.6 times below the "
              "exact limit "
              "(more where tetrahedra are flat): a larger step may still be stable. Use a smaller -ts_dt (or none), or "
              "go on with "
              "-ts_central_check warn",
              dt_, bound_.dt);
    remarks_.push_back("-ts_dt is above the bound of the critical step, " + std::to_string(dt_ / bound_.dt) +
                       " times: the run may be unstable");
  }
  last_step_ = end_step_;
  if (has_end_time_ && end_time_ / dt_ < static_cast<double>(end_step_))
    last_step_ = static_cast<PetscInt>(std::ceil(end_time_ / dt_ - 1e-6));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode Simulation::CreateBackend() {
  PetscFunctionBeginUser;
  std::string way = "auto";
  bool deterministic = false;
  PetscInt per_block = 32;
  PetscCall(options_.Word("central_way", &way));              // one way so far: the reference
  PetscCall(options_.Flag("deterministic", &deterministic));  // which is deterministic
  bool cuda = device_ == "cuda";
#ifdef CDEM_HAVE_CUDA
  if (device_ == "auto") cuda = CudaDeviceThere();
  CdemCheck(!cuda || CudaDeviceThere(), comm_,
            "-device cuda: this machine shows no usable NVIDIA GPU; use -device cpu");
  CdemCheck(!cuda || !tables_.releases, comm_,
            "-block_<region>_release_interfaces is computed on the CPU only so far: use -device cpu, or leave it out");
  if (cuda) {
    PetscCall(options_.Int("elements_per_block", &per_block));
    CdemCheck(per_block >= 32 && per_block <= 256 && per_block % 32 == 0, comm_,
              "-elements_per_block is %lld; it must be a multiple of 32 from 32 to 256",
              static_cast<long long>(per_block));
    PetscCall(CreateCudaBackend(tables_, static_cast<int>(mesh_.n_owned), static_cast<int>(per_block), &backend_));
  }
#else
  (void)per_block;
  CdemCheck(!cuda, comm_, "-device cuda: this cdem was built without CUDA; build it with ./bootstrap build --cuda");
#endif
  if (!backend_) PetscCall(CreateHostBackend(tables_, static_cast<int>(mesh_.n_owned), &backend_));
  device_ = cuda ? "cuda" : "cpu";
  PetscCall(backend_->CreateVecs(&u_, &v_));
  PetscCall(SetInitialVelocity());
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode Simulation::SetInitialVelocity() {
  PetscFunctionBeginUser;
  options_.Declare("velocity", mesh_.regions);
  bool any = false, set;
  std::vector<std::array<double, 3>> of_region(mesh_.regions.size(), {0, 0, 0});
  for (std::size_t r = 0; r < mesh_.regions.size(); ++r) {
    PetscCall(options_.Reals({"velocity", mesh_.regions[r], ""}, 3, of_region[r].data(), &set));
    any = any || set;
  }
  if (!any) PetscFunctionReturn(PETSC_SUCCESS);
  // A node shared by two regions has the velocity of its lowest-numbered cell's.
  PetscScalar *v;
  std::vector<char> done(tables_.n_owned, 0);
  PetscCall(VecGetArray(v_, &v));
  for (PetscInt c : SortedByGlobal(mesh_))
    for (int a = 0; a < Info(mesh_.cell_shape[c]).corners; ++a) {
      const PetscInt node = nodes_.Corners(c)[a];
      if (node < 0 || node >= nodes_.n_owned || std::exchange(done[node], char{1})) continue;
      std::copy_n(of_region[mesh_.cell_region[c]].data(), 3, v + 3 * static_cast<std::ptrdiff_t>(node));
    }
  PetscCall(VecRestoreArray(v_, &v));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode Simulation::CreateTS() {
  PetscFunctionBeginUser;
  PetscCall(options_.Int("ts_central_batch", &batch_, &batch_given_));
  CdemCheck(!batch_given_ || batch_ >= 1, comm_, "-ts_central_batch is %lld; it must be at least 1",
            static_cast<long long>(batch_));
  PetscCall(CreateTSCentral(comm_, this, batch_, u_, v_, &ts_));
  PetscCall(TSSetMaxTime(ts_, has_end_time_ ? end_time_ : PETSC_MAX_REAL));
  PetscCall(TSSetMaxSteps(ts_, end_step_));
  PetscCall(TSSetTimeStep(ts_, dt_));
  PetscCall(TSSetFromOptions(ts_));
  PetscCall(TSMonitorSet(ts_, MonitorTS, this, nullptr));  // not one that -ts_monitor_cancel would remove
  TSType type;
  PetscCall(TSGetType(ts_, &type));
  CdemCheck(std::string(type) == "central", comm_,
            "-ts_type %s: cdem steps with central differences only; leave it out", type);
  PetscCall(TSSetTimeStep(ts_, dt_));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode Simulation::Solve() {
  PetscFunctionBeginUser;
  PetscCall(PetscLogStagePush(events.solve));
  PetscCall(backend_->Synchronize());
  wall_start_ = MPI_Wtime();
  PetscCall(TSSolve(ts_, nullptr));
  PetscCall(backend_->Synchronize());
  wall_solve_ = MPI_Wtime() - wall_start_ - wall_output_;
  PetscCall(PetscLogStagePop());
  PetscFunctionReturn(PETSC_SUCCESS);
}

StepArgs Simulation::MakeArgs(double dt_old, double dt) const {
  StepArgs args;
  const double h = 0.5 * (dt_old + dt), half = 0.5 * tables_.alpha * h;
  args.dt = dt;
  args.keep = (1 - half) / (1 + half);
  args.kick = h / (1 + half);
  args.start = dt_old == 0;
  std::copy_n(tables_.gravity, 3, args.gravity);
  return args;
}

void Simulation::FillSchedule(double t, double dt, double *row) const {
  for (std::size_t k = 0; k < time_tables_.size(); ++k)
    for (int part = 0; part < 3; ++part) row[3 * k + part] = time_tables_[k].At(t + 0.5 * part * dt);
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
    schedule.resize(3 * time_tables_.size() * plan.n);
    for (PetscInt j = 0; j < plan.n; ++j) FillSchedule(plan.Time(j), plan.dt, &schedule[3 * time_tables_.size() * j]);
    batch.schedule = schedule.data();
  }
  history.resize(6 * static_cast<std::size_t>(tables_.n_watch) * plan.n);
  batch.history = history.data();
  Failure failure;
  PetscCall(backend_->Advance(batch, &failure));
  PetscCall(PetscLogEventEnd(events.batch, nullptr, nullptr, nullptr, nullptr));
  int good = batch.n;  // steps of the batch that are worth recording
  PetscCall(FirstFailure(failure, &good));
  if (!recorder_.Empty()) {
    const double begin = MPI_Wtime();
    for (PetscInt j = 0; j < std::min(good + 1, batch.n); ++j) times.push_back(plan.Time(j));
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
  std::string cause = "a strength, stiffness or load out of proportion";
  if (!bound_known_ || plan.dt > bound_.dt) cause = "a time step above the critical one (leave out -ts_dt)";
  CdemCheck(false, comm_,
            "the run became unstable: the velocity of the node at (%g, %g, %g) left the range of numbers in step %lld "
            "(time %g s). Likely cause: %s. What was written before stays on disk",
            x[0], x[1], x[2], static_cast<long long>(step), plan.Time(first.step + 1), cause.c_str());
  PetscFunctionReturn(PETSC_SUCCESS);
}

}  // namespace cdem
