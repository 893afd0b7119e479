// The part of Simulation that speaks: the header at the start, the summary and the timing at the end.
#include "cdem_config.h"
#include "core/error.hpp"
#include "io/safe_file.hpp"
#include "simulation.hpp"

#include <algorithm>

namespace cdem {

static std::string PetscVersion() {
  char version[256];
  if (PetscGetVersion(version, sizeof version)) return "unknown";
  const std::string text = version;  // "Petsc Release Version 3.18.5, Feb 24, 2023"
  const std::size_t at = text.find("Version ");
  return at == std::string::npos ? text : text.substr(at + 8, text.find(',') - at - 8);
}

static std::string Names(const std::int64_t *n_cells) {
  std::string text;
  for (int s = 0; s < kShapes; ++s)
    if (n_cells[s] > 0) text += (text.empty() ? "" : ", ") + std::to_string(n_cells[s]) + " " + kShapeInfo[s].name;
  return text;
}

PetscErrorCode Simulation::PrintHeader() {
  PetscFunctionBeginUser;
  PetscMPIInt ranks;
  PetscCallMPI(MPI_Comm_size(comm_, &ranks));
  auto line = [&](const char *what, const std::string &text) {
    return PetscPrintf(comm_, "%-11s %s\n", what, text.c_str());
  };
  char text[256];
  PetscCall(PetscPrintf(comm_, "cdem %s (%s), PETSc %s%s\n", CDEM_VERSION, CDEM_GIT, PetscVersion().c_str(),
#ifdef CDEM_NO_CONTRACT
                        ", without fma contraction"
#else
                        ""
#endif
                        ));
  PetscCall(line("device", backend_->Name() + ", " + std::to_string(ranks) + (ranks > 1 ? " ranks" : " rank")));
  PetscCall(line("way", backend_->WayOfStep().name + ": " + backend_->WayOfStep().text));
  PetscCall(line("elements", Names(n_cells_) + (single_ ? ", in single precision" : "")));
  PetscCall(line("nodes", std::to_string(nodes_.n_global) + " in " + std::to_string(nodes_.n_blocks) +
                              (nodes_.n_blocks == 1 ? " block" : " blocks")));
  if (n_interface_faces_ > 0)
    PetscCall(
        line("interfaces", std::to_string(n_interface_faces_) + " faces, " + std::to_string(n_springs_) + " springs"));
  for (std::size_t i = 0; i < Now().joints.size(); ++i)
    if (Now().joints[i].kn < 0 || Now().joints[i].ks < 0) {
      std::snprintf(
          text, sizeof text,
          "%s: stiffness %g times that of the blocks: where every face is one, the body is %.3g times as stiff",
          interface_names_[i].c_str(), Now().joints[i].stiffness_factor,
          1 / (1 + 1 / Now().joints[i].stiffness_factor));
      PetscCall(line("", text));
    }
  PetscCall(PrintJointSets());
  if (!restart_file_.empty()) {
    std::snprintf(text, sizeof text, "from step %lld, time %.6g s, of ", static_cast<long long>(first_step_),
                  first_time_);
    const std::string files = output_dir_.empty() ? ""
                              : goes_on_          ? "; histories and frames go on there"
                                                  : "; histories and frames begin at that step in " + output_dir_;
    PetscCall(line("restart", text + restart_file_ + files));
  }
  std::snprintf(text, sizeof text, "dt %.6g s", dt_);
  std::string step = text;
  if (bound_known_) {
    step += CriticalStepText(dt_, bound_, sharp_known_ ? &sharp_ : nullptr);
  } else {
    step += ", the critical step was not computed";
  }
  PetscCall(line("step", step));
  PetscLogDouble bytes = 0;
  PetscCall(PetscMemoryGetCurrentUsage(&bytes));
  double total = bytes;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &total, 1, MPI_DOUBLE, MPI_SUM, comm_));
  std::snprintf(text, sizeof text, "%.3g GiB host, %.3g GiB state and tables of rank 0 on the device",
                total / (1 << 30), static_cast<double>(backend_->Bytes()) / (1 << 30));
  PetscCall(line("memory", text));
  for (const History &h : histories_) {
    std::snprintf(text, sizeof text, "%s of %s at the node (%g, %g, %g)", h.of.c_str(), h.name.c_str(), h.found[0],
                  h.found[1], h.found[2]);
    PetscCall(line("history", text));
  }
  PetscBool ts_monitor;
  PetscCall(PetscOptionsHasName(nullptr, nullptr, "-ts_monitor", &ts_monitor));
  if (ts_monitor && !batch_given_)
    PetscCall(
        line("note", "-ts_monitor prints when a batch of steps ends; for every N steps give -ts_central_batch N"));
  for (auto remark = remarks_.begin(); remark != remarks_.end(); ++remark)  // stages may say the same
    if (std::find(remarks_.begin(), remark, *remark) == remark) PetscCall(line("note", *remark));
  std::snprintf(text, sizeof text, "%.3g s", wall_setup_);
  PetscCall(line("set-up", text));
  PetscCall(PrintStage());
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode Simulation::PrintJointSets() {
  PetscFunctionBeginUser;
  for (const JointSet &set : joint_sets_) {
    char wanted[64] = "";
    if (set.p32 > 0) std::snprintf(wanted, sizeof wanted, " (%.6g wanted)", set.p32);
    if (set.count > 0) std::snprintf(wanted, sizeof wanted, " (%.6g centres per m^3 wanted)", set.count);
    PetscCall(PetscPrintf(comm_,
                          "%-11s %s: %zu discs, P32 %.6g 1/m%s; %lld faces, %.3g %% of those inside, with %.3g times "
                          "the discs' area\n",
                          "joints", set.name.c_str(), set.discs.size(), set.P32(), wanted,
                          static_cast<long long>(set.taken_faces), 100 * set.FaceShare(), set.AreaRatio()));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode Simulation::WriteJointSets() {
  PetscFunctionBeginUser;
  PetscMPIInt rank;
  PetscCallMPI(MPI_Comm_rank(comm_, &rank));
  std::string failure;
  if (rank == 0 && !joint_sets_.empty()) failure = ReplaceFile(output_dir_ + "/joints.csv", DiscTable(joint_sets_));
  PetscCall(CheckFailure(comm_, failure));
  PetscFunctionReturn(PETSC_SUCCESS);
}

nlohmann::json Simulation::Summary() const {
  nlohmann::json s, elements;
  PetscMPIInt ranks = 1;
  MPI_Comm_size(comm_, &ranks);
  double n = 0;
  for (int shape = 0; shape < kShapes; ++shape) {
    if (n_cells_[shape] > 0) elements[kShapeInfo[shape].name] = n_cells_[shape];
    n += static_cast<double>(n_cells_[shape]);
  }
  s["version"] = CDEM_VERSION;
  s["git"] = CDEM_GIT;
  s["petsc"] = PetscVersion();
  s["device"] = backend_->Name();
  s["way"] = backend_->WayOfStep().name;
  s["precision"] = single_ ? "single" : "double";
  s["ranks"] = ranks;
  s["elements"] = elements;
  s["nodes"] = nodes_.n_global;
  s["blocks"] = nodes_.n_blocks;
  s["interfaces"] = n_interface_faces_;
  s["springs"] = n_springs_;
  for (const JointSet &set : joint_sets_)
    s["joints"].push_back({{"name", set.name},
                           {"discs", set.discs.size()},
                           {"p32_wanted", set.p32 > 0 ? nlohmann::json(set.p32) : nlohmann::json()},
                           {"p32", set.P32()},
                           {"disc_area", set.disc_area},
                           {"faces", set.taken_faces},
                           {"face_share", set.FaceShare()},
                           {"face_area", set.taken_area},
                           {"area_ratio", set.AreaRatio()}});
  s["broken_springs"] = static_cast<std::int64_t>(last_.broken);
  if (n_breakable_ > 0) {
    s["breakable_blocks"] = n_breakable_;
    s["broken_blocks"] = last_.broken_elements / static_cast<double>(n_breakable_);
  }
  s["dt"] = dt_;
  s["dt_critical"] = bound_known_ ? nlohmann::json(dt_critical()) : nlohmann::json();
  s["dt_bound"] = bound_known_ ? nlohmann::json(bound_.dt) : nlohmann::json();
  if (!restart_file_.empty()) s["restart"] = {{"file", restart_file_}, {"step", first_step_}, {"time", first_time_}};
  s["steps"] = steps_;
  s["time"] = time_;
  s["wall"] = {{"setup", wall_setup_}, {"solve", wall_solve_}, {"output", wall_output_}, {"output_watch", wall_watch_}};
  for (const auto &[phase, seconds] : wall_phases_) s["wall"]["setup_" + phase] = seconds;
  for (const auto &[phase, seconds] : solve_phases_) s["wall"]["solve_" + phase] = seconds;
  s["element_steps_per_second"] = wall_solve_ > 0 ? n * static_cast<double>(steps_ - first_step_) / wall_solve_ : 0;
  PetscLogDouble bytes = 0;
  (void)PetscMemoryGetCurrentUsage(&bytes);
  s["memory"] = {{"host", bytes}, {"device", device_ == "cuda" ? static_cast<double>(backend_->Bytes()) : 0.0}};
  s["validity"] = {{"slip_over_face", validity_.slip}, {"rotation_degrees", validity_.rotation}};
  const bool known = balance_.known;  // of the balance: only while -monitor_energy is on
  s["energy"] = {{"kinetic", known ? balance_.sums.kinetic : last_.kinetic},
                 {"strain", known ? balance_.sums.strain : last_.strain},
                 {"spring", known ? balance_.sums.spring : last_.spring},
                 {"form", last_.form}};
  for (const BalanceTerm &term : kBalanceTerms)
    if (known) s["energy"][term.name] = term.value(balance_);
  if (!known) s["energy"]["error"] = nullptr;
  s["stages"] = stage_summaries_;
  return s;
}

nlohmann::json Simulation::StageSummary() const {
  const nlohmann::json all = Summary();
  nlohmann::json stage;
  if (Staged()) stage["name"] = Now().name;
  stage["solve"] = Now().relax ? "relax" : "dynamic";
  for (const char *key :
       {"elements", "springs", "time", "dt", "dt_critical", "dt_bound", "broken_springs", "energy", "validity"})
    stage[key] = all[key];
  stage["steps"] = steps_ - stage_step_;
  const double output = wall_output_ - output_before_;
  stage["wall"] = {{"solve", MPI_Wtime() - stage_begin_ - output}, {"output", output}};
  for (const auto &[phase, seconds] : backend_->Phases()) stage["wall"]["solve_" + phase] = seconds;
  if (n_breakable_ > 0) stage["broken_blocks"] = all["broken_blocks"];
  if (relaxation_) {
    stage["balanced"] = balanced_;
    stage["unbalanced_ratio"] = relaxation_->last().unbalanced;
    stage["kinetic_over_peak"] = relaxation_->peak() > 0 ? relaxation_->last().kinetic / relaxation_->peak() : 0.0;
  }
  return stage;
}

PetscErrorCode Simulation::PrintStage() {
  PetscFunctionBeginUser;
  if (!Staged()) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscPrintf(comm_, "stage       %s: %s from step %lld, time %.6g s, dt %.6g s; %s; %lld springs\n",
                        Now().name.c_str(), Now().relax ? "relax" : "dynamic", static_cast<long long>(stage_step_),
                        stage_time_, dt_, Names(n_cells_).c_str(), static_cast<long long>(n_springs_)));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode Simulation::Finish() {
  PetscFunctionBeginUser;
  if (output_dir_.empty()) {  // with output the last frame has looked
    const double *u, *v;
    const Histories *history;
    PetscCall(backend_->Download(&u, &v, &history));
    PetscCall(WatchValidity(u));
  }
  const nlohmann::json summary = Summary();
  PetscCall(PetscPrintf(comm_,
                        "done        %lld steps to %.6g s; solve %.4g s, output %.3g s, %.4g M element-steps/s\n",
                        static_cast<long long>(steps_), time_, wall_solve_, wall_output_,
                        summary["element_steps_per_second"].get<double>() / 1e6));
  if (!output_dir_.empty()) PetscCall(WriteSummary(comm_, output_dir_, summary));
  CdemCheck(failure_.empty(), comm_, "%s", failure_.c_str());
  PetscFunctionReturn(PETSC_SUCCESS);
}

}  // namespace cdem
