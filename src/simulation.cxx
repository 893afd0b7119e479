#include "simulation.hpp"

#include "core/error.hpp"
#include "core/events.hpp"
#include "forces/references.hpp"
#include "io/viewer_check.hpp"
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
  PetscCall(ReadInput());
  PetscCall(BuildModel());
  PetscCall(IdentifyScene());
  PetscCall(LoadHeld());
  Phase("device");
  PetscCall(CreateBackend());
  PetscCall(SetInitialStress());
  PetscCall(SetInitialVelocity());
  PetscCall(CreateTS(0));
  PetscCall(LoadCheckpoint());
  PetscCall(BeginAudit());
  Phase("files");
  PetscCall(monitors_.ReadOptions(options_, scenes_.size() > 1 ? PETSC_INT_MAX : last_step_));
  PetscCall(options_.CheckLeft());
  PetscCall(OpenOutput());
  std::string energies;
  for (const BalanceTerm &term : kBalanceTerms) energies += std::string(" ") + term.name;
  PetscCall(monitors_.Open(comm_, n_breakable_ > 0, energies));
  PetscCall(PetscLogStagePop());
  const double now = MPI_Wtime();
  wall_setup_ = now - wall_start_;
  wall_phases_[phase_].second += now;
  PetscCall(PrintHeader());
  PetscFunctionReturn(PETSC_SUCCESS);
}

void Simulation::Phase(const char *name) {
  if (wall_setup_ > 0) return;
  const double now = MPI_Wtime();
  if (!wall_phases_.empty()) wall_phases_[phase_].second += now;
  const auto known = std::find_if(wall_phases_.begin(), wall_phases_.end(), [&](auto &p) { return p.first == name; });
  phase_ = static_cast<std::size_t>(known - wall_phases_.begin());
  if (known == wall_phases_.end()) wall_phases_.emplace_back(name, 0.0);
  wall_phases_[phase_].second -= now;
}

PetscErrorCode Simulation::ReadInput() {
  PetscFunctionBeginUser;
  PetscCall(options_.Word("device", &device_));
  PetscCall(options_.Text("output", &output_dir_));
  if (!output_dir_.empty()) {
    PetscCall(options_.Flag("output_overwrite", &output_overwrite_));
    PetscCall(ReadInterval(options_, "output_", &frame_interval_));
    PetscCall(fields_.Create(comm_, options_));
  }
  PetscCall(options_.Int("ts_central_batch", &batch_, &batch_given_));
  CdemCheck(!batch_given_ || batch_ >= 1, comm_, "-ts_central_batch is %lld; it must be at least 1",
            static_cast<long long>(batch_));
  PetscCall(ReadAudit());
  PetscCall(ReadRestart());
  PetscCall(CheckViewers(comm_, output_dir_));
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
  PetscCall(ReadScenes(options_, mesh_, interface_names_, face_interface_, &scenes_, &remarks_));
  CdemCheck(first_stage_ < scenes_.size(), comm_,
            "%s is of stage number %zu, and there are %zu: the stages up to that of a checkpoint must be the same",
            restart_file_.c_str(), first_stage_ + 1, scenes_.size());
  PetscCall(ChooseDevice());
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
  // Every stage is built and checked before anything is computed; the one that comes first stays.
  for (stage_ = scenes_.size(); stage_-- > 0;) {
    if (stage_ == first_stage_) continue;
    Phase("stages");
    PetscCall(BuildStage());
    PetscCall(FindLimit());
    PetscCall(ChooseStep());
  }
  stage_ = first_stage_;
  Phase("tables");
  PetscCall(BuildStage());
  PetscCall(FindLimit());
  Phase("tables");
  PetscCall(ChooseStep());
  PetscCall(DMDestroy(&mesh_.dm));  // from here on the flat arrays serve
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode Simulation::ChooseDevice() {
  PetscFunctionBeginUser;
  bool deterministic = false;
  PetscCall(options_.Word("central_way", &way_));
  PetscCall(options_.Flag("deterministic", &deterministic));
  CdemCheck((way_ == "auto" || way_ == "reference") || !deterministic, comm_,
            "-central_way %s and -deterministic: its sums have another order; leave one of them out", way_.c_str());
  if (deterministic) way_ = "reference";
  bool cuda = device_ == "cuda";
#ifdef CDEM_HAVE_CUDA
  if (device_ == "auto") cuda = CudaDeviceThere();
  CdemCheck(!cuda || CudaDeviceThere(), comm_,
            "-device cuda: this machine shows no usable NVIDIA GPU; use -device cpu");
  if (cuda) PetscCall(options_.Int("elements_per_block", &per_block_));
  CdemCheck(per_block_ >= 32 && per_block_ <= 256 && per_block_ % 32 == 0, comm_,
            "-elements_per_block is %lld; it must be a multiple of 32 from 32 to 256",
            static_cast<long long>(per_block_));
#else
  CdemCheck(!cuda, comm_, "-device cuda: this cdem was built without CUDA; build it with ./bootstrap build --cuda");
#endif
  CdemCheck(way_ != "rows" || cuda, comm_, "-central_way rows is a way of GPUs: use -device cuda, or leave it out");
  device_ = cuda ? "cuda" : "cpu";
  std::string precision = "double";
  PetscCall(options_.Word("precision", &precision));
  single_ = precision == "single";
  CdemCheck(!single_ || way_ == "auto" || way_ == "reference", comm_,
            "-precision single and -central_way %s: that way is one of double precision; leave one of them out",
            way_.c_str());
  if (single_) way_ = "reference";
  PetscFunctionReturn(PETSC_SUCCESS);
}

/// Only where the device is a GPU, and once a stage.
PetscErrorCode Simulation::CopyToDevice() {
  PetscFunctionBeginUser;
#ifdef CDEM_HAVE_CUDA
  if (device_ == "cuda" && !device_tables_)
    PetscCall(CopyToCuda(tables_, static_cast<int>(mesh_.n_owned), &device_tables_));
#endif
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode Simulation::CreateBackend() {
  PetscFunctionBeginUser;
  PetscCall(CopyToDevice());
  const BackendChoice choice = {book_.on, way_, single_, static_cast<int>(per_block_)};
#ifdef CDEM_HAVE_CUDA
  if (device_tables_) PetscCall(CreateCudaBackend(tables_, std::move(device_tables_), choice, &backend_));
#endif
  if (!backend_) PetscCall(CreateHostBackend(tables_, static_cast<int>(mesh_.n_owned), choice, &backend_));
  PetscCall(backend_->CreateVecs(&u_, &v_));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode Simulation::SetInitialStress() {
  PetscFunctionBeginUser;
  const std::vector<Material> &materials = Now().materials;
  const bool stressed = std::any_of(materials.begin(), materials.end(), [](const Material &m) { return m.stressed; });
  if (!stressed || !restart_file_.empty()) PetscFunctionReturn(PETSC_SUCCESS);
  Histories start;
  StartUnderStress(mesh_, nodes_, materials, tables_, &start);
  const std::vector<double> rest(3 * static_cast<std::size_t>(tables_.n_owned), 0.0);
  PetscCall(backend_->Upload(rest.data(), rest.data(), start));
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

}  // namespace cdem
