// One run: owns mesh, tables, state, TS and what watches them. Set-up is in simulation.cxx, the stages of a run in stage.cxx,
// its steps in advance.cxx, what looks at them in watch.cxx, relaxation in relax.cxx, what it says in report.cxx.
#pragma once
#include "core/options.hpp"
#include "energy.hpp"
#include "forces/backend.hpp"
#include "forces/form_check.hpp"
#include "forces/input_bound.hpp"
#include "forces/joint_check.hpp"
#include "forces/step_text.hpp"
#include "forces/validity.hpp"
#include "io/checkpoint.hpp"
#include "io/earlier_run.hpp"
#include "io/watch.hpp"
#include "joints/network.hpp"
#include "scene.hpp"
#include "time/ts_central.hpp"

#include <map>

namespace cdem {

class Simulation final : public Stepper {
 public:
  explicit Simulation(MPI_Comm comm) : comm_(comm), options_(comm) {}
  ~Simulation() override;

  /// Reads and checks everything, builds tables and state, prints the header. Nothing is written before all is checked.
  PetscErrorCode SetUp();
  /// Runs to the end.
  PetscErrorCode Solve();
  /// Last rows of the histories, summary.json, timing lines. Error: a relaxation that did not reach balance.
  PetscErrorCode Finish();

  // What tests and other programs may look at.
  Vec u() const { return u_; }
  Vec v() const { return v_; }  ///< at half steps
  const Mesh &mesh() const { return mesh_; }
  const Nodes &nodes() const { return nodes_; }
  const Tables &tables() const { return tables_; }
  const std::vector<int> &face_interface() const { return face_interface_; }
  const std::vector<JointSet> &joint_sets() const { return joint_sets_; }
  const std::vector<Material> &materials() const { return Now().materials; }
  const StepBound &bound() const { return bound_; }
  const SharpStep &sharp() const { return sharp_; }
  double dt_critical() const { return sharp_known_ ? sharp_.dt : bound_.dt; }  ///< s
  double dt() const { return dt_; }
  Backend &backend() { return *backend_; }
  /// The energy balance at the last row of -monitor_energy.
  const Balance &balance() const { return balance_; }

  PetscErrorCode Advance(const StepPlan &plan) override;
  PetscInt StepsToNext(PetscInt step, PetscReal time, PetscReal dt) override;

 private:
  /// Begins a phase of the set-up for wall_phases_, or goes on with it; the one before ends. Later it does nothing.
  void Phase(const char *name);
  PetscErrorCode ReadInput();
  PetscErrorCode BuildModel();
  PetscErrorCode ChooseDevice();
  PetscErrorCode CopyToDevice();
  PetscErrorCode CreateBackend();
  PetscErrorCode SetInitialStress();
  PetscErrorCode SetInitialVelocity();

  // stages
  const Scene &Now() const { return scenes_[stage_]; }
  bool Staged() const { return !scenes_[0].name.empty(); }
  PetscErrorCode BuildStage();  ///< tables of the present stage, with all their checks
  PetscErrorCode CountStage();
  PetscErrorCode FindLimit();  ///< the critical step of the present stage, and before it masses that are scaled
  PetscErrorCode FindSharpStep();
  PetscErrorCode ChooseStep();
  PetscErrorCode CreateTS(double dt_old);
  PetscErrorCode NextStage();
  PetscErrorCode EndStage();
  PetscErrorCode PrintStage();
  /// Reactions of the supports at the end of the stage, where the next one keeps some (else empty) [n_owned][3] N.
  PetscErrorCode FindReactions(std::vector<double> *reaction);
  nlohmann::json StageSummary() const;

  // relaxation
  static PetscErrorCode WatchBalance(TS ts);
  PetscErrorCode CheckBalance(PetscInt step);
  PetscInt StepsToCheck(PetscInt step) const;
  PetscErrorCode StopMotion();
  PetscErrorCode ReportImbalance();
  bool FindsDamping() const;  ///< the checks choose the damping by mass

  // stability.cxx: the energy balance, and runs whose energy grows without a cause
  PetscErrorCode ReadAudit();
  PetscErrorCode TakeAudit(AuditSums *sums);
  PetscErrorCode BeginAudit();
  PetscErrorCode CheckGrowth(PetscInt step, double time, const Observed &observed);
  PetscErrorCode KeepGoodState(PetscInt step);
  PetscErrorCode WriteGoodState(std::string *said);
  std::string LikelyCause(double dt) const;

  // restart.cxx
  PetscErrorCode ReadRestart();
  bool Resumes() const { return !restart_file_.empty() && stage_ == first_stage_; }  ///< the stage is the checkpoint's
  /// By what checkpoints know it; the one to start from must be of this scene. [in] wanted: also where none is asked for.
  PetscErrorCode IdentifyScene(bool wanted = false);
  bool KeepsStep(bool dt_given) const;  ///< the step is that of the checkpoint
  PetscErrorCode CheckEnd();            ///< it lies behind the checkpoint
  PetscErrorCode LoadCheckpoint();
  PetscErrorCode LoadRelaxation();
  PetscErrorCode LoadHeld();
  PetscErrorCode OpenOutput();
  PetscErrorCode WriteMeshes();  ///< for the frames, of what is there in the present stage
  PetscErrorCode WriteCheckpoint(PetscInt step);
  PetscErrorCode PrintHeader();
  PetscErrorCode PrintJointSets();
  PetscErrorCode WriteJointSets();
  nlohmann::json Summary() const;
  static PetscErrorCode MonitorTS(TS ts, PetscInt step, PetscReal time, Vec u, void *ctx);
  PetscErrorCode Watch(PetscInt step, double time);
  bool AtEnd() const;  ///< TS has a reason to stop
  PetscErrorCode WriteFrame(PetscInt step, double time);
  PetscErrorCode WatchValidity(const double *u);
  PetscErrorCode FirstFailure(const Failure &failure, int *step);
  PetscErrorCode ReportFailure(const StepPlan &plan, const Failure &failure);
  StepArgs MakeArgs(double dt_old, double dt) const;
  void FillSchedule(double t, double dt, double *row) const;  ///< t: since the stage began [s]

  MPI_Comm comm_;
  Options options_;
  Mesh mesh_;
  Nodes nodes_;
  std::vector<std::string> interface_names_, remarks_;
  std::vector<int> face_interface_;
  std::vector<JointSet> joint_sets_;
  std::vector<Scene> scenes_;
  std::size_t stage_ = 0;
  std::vector<History> histories_;
  Tables tables_;
  std::shared_ptr<DeviceTables> device_tables_;  // a GPU's copy, until the backend has it
  std::unique_ptr<Backend> backend_;
  Vec u_ = nullptr, v_ = nullptr;
  TS ts_ = nullptr;

  // time
  double dt_ = 0;
  StepBound bound_;
  SharpStep sharp_;
  bool bound_known_ = false, sharp_known_ = false;
  PetscInt last_step_ = PETSC_INT_MAX;       // of the stage, as far as known
  double stage_time_ = 0, pseudo_time_ = 0;  // s; at the stage's beginning; spent in relaxations before it
  PetscInt stage_step_ = 0;                  // at the stage's beginning
  std::vector<double> origin_;               // [n_local][3] of reported displacements [m]; empty: none was reset

  bool holds_ = false;        // forces stay where supports have left:
  std::vector<double> held_;  // [n_owned][3] N

  // relaxation
  std::unique_ptr<Relaxation> relaxation_;  // NULL in dynamic stages
  double alpha_ = 0, local_ = 0;            // damping by mass now [1/s], and of nodes
  RelaxMemory to_keep_;                     // after the last regular check, for checkpoints
  bool balanced_ = false;
  std::string failure_;  // why the run ended early; "": it did not

  // watching
  std::string output_dir_, device_ = "auto";
  bool output_overwrite_ = false;
  PetscInt batch_ = 0, per_block_ = 32;
  std::string way_ = "auto";
  bool single_ = false;  ///< arithmetic of elements in single precision
  bool batch_given_ = false;
  Interval frame_interval_;
  Monitors monitors_;
  HistoryRecorder recorder_;
  FieldOutput fields_;

  // the energy balance, and what is kept of the last state that passed its check
  EnergyBook book_;
  Balance balance_;
  InputBound input_;          // of this stage
  double start_energy_ = -1;  // J, of this stage; below 0: not yet seen
  struct GoodState {
    PetscInt step = -1;
    double time = 0;
    CentralState central;
    std::vector<double> u, v;
    Histories history;
    AuditArrays audit;
  } good_;
  PetscInt last_frame_ = -1, last_checkpoint_ = -1;  // steps

  // checkpoints
  std::string restart_file_;     // "": the run starts at rest
  bool goes_on_ = false;         // in the output folder of the run that wrote it
  std::size_t first_stage_ = 0;  // where this run starts
  PetscInt first_step_ = 0;
  double first_time_ = 0;
  CheckpointReader restart_;
  CheckpointWriter checkpoints_;
  CheckpointScene checkpoint_scene_;
  EarlierRun earlier_;

  // figures of the run
  std::vector<std::pair<std::string, double>> wall_phases_;  // of the set-up
  std::size_t phase_ = 0;                                    // the present one, once there is any
  double wall_setup_ = 0, wall_solve_ = 0, wall_output_ = 0, wall_start_ = 0;
  double wall_watch_ = 0;  // of wall_output_: observations and monitors
  std::int64_t n_cells_[kShapes] = {0, 0, 0}, n_interface_faces_ = 0, n_springs_ = 0, n_breakable_ = 0;
  PetscInt steps_ = 0;
  double time_ = 0;
  Observed last_;
  Validity validity_;  // at the last frame or the end
  bool warned_slip_ = false, warned_rotation_ = false;
  LawFields of_laws_;  // of some stage
  nlohmann::json stage_summaries_ = nlohmann::json::array();
  double wall_stages_ = 0;
  double stage_begin_ = 0, output_before_ = 0;    // when the stage began; wall_output_ by then
  std::map<std::string, double> solve_phases_{};  // of all stages so far
};

}  // namespace cdem
