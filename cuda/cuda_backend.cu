#include "core/error.hpp"
#include "core/events.hpp"
#include "cuda/cuda_backend.cuh"

#include <petscdevice_cuda.h>

#include <utility>

namespace cdem {

bool CudaDeviceThere() {
  int n = 0;
  const bool there = cudaGetDeviceCount(&n) == cudaSuccess && n > 0;
  if (!there) (void)cudaGetLastError();
  return there;
}

/// Element corners and springs up to which kernels overlap: 40,000 hexahedra gain 1 %, 1,000 gain 20 %, 1,000,000 would
/// lose 4 % (H200).
static constexpr std::size_t kOverlapSlots = 1000000;

CudaBackend::~CudaBackend() {
  graphs_.Drop();
  if (launch_.stream && launch_.stream != PetscDefaultCudaStream) cudaStreamDestroy(launch_.stream);
  if (unit_ != MPI_DATATYPE_NULL) MPI_Type_free(&unit_);
}

PetscErrorCode CudaBackend::Create(bool audit, const std::string &way) {
  PetscFunctionBeginUser;
  PetscCall(tables_.Complete(audit));
  PetscCall(u_.Allocate(3 * static_cast<std::size_t>(t_.n_local)));
  PetscCall(v_.Allocate(3 * static_cast<std::size_t>(t_.n_local)));
  PetscCall(batch_.Allocate(1));
  PetscCall(state_.Allocate());
  // One rank: a stream of our own, which can be captured. Several: PETSc's, on which PetscSF packs and unpacks; and so
  // where PETSc multiplies.
  if (t_.halo || way == "assembled")
    launch_.stream = PetscDefaultCudaStream;
  else
    CdemCuda(cudaStreamCreateWithFlags(&launch_.stream, cudaStreamNonBlocking));
  // -log_view_gpu_time asks for the time of every event: then each phase is waited for, and there are no graphs.
  PetscBool timed = PETSC_FALSE;
  PetscCall(PetscOptionsHasName(nullptr, nullptr, "-log_view_gpu_time", &timed));
  launch_.timed = timed;
  launch_.overlap = launch_.stream != PetscDefaultCudaStream && !timed && t_.n_slots < kOverlapSlots;
  PetscCall(ChooseWay(way));
  LaunchArgs load = launch_;
  load.load = true;
  PetscCall(tables_.LaunchStep(View(), {}, batch_.get(), load));
  PetscFunctionReturn(PETSC_SUCCESS);
}

std::string CudaBackend::Name() const {
  int device = 0;
  cudaDeviceProp properties;
  cudaGetDevice(&device);
  cudaGetDeviceProperties(&properties, device);
  return properties.name;
}
std::size_t CudaBackend::Bytes() const {
  return (rows_ ? rows_->Bytes() : 0) + (stencil_ ? stencil_->Bytes() : 0) + (assembled_ ? assembled_->Bytes() : 0) +
         tables_.Bytes() + u_.bytes() + v_.bytes() + schedule_.bytes() + history_.bytes();
}

PetscErrorCode CudaBackend::CreateVecs(Vec *u, Vec *v) {
  PetscFunctionBeginUser;
  const PetscInt n = 3 * static_cast<PetscInt>(t_.n_owned);
  PetscCall(VecCreateMPICUDAWithArrays(t_.comm, 3, n, PETSC_DECIDE, nullptr, u_.get(), u));
  PetscCall(VecCreateMPICUDAWithArrays(t_.comm, 3, n, PETSC_DECIDE, nullptr, v_.get(), v));
  vec_u_ = *u, vec_v_ = *v;
  if (t_.halo) {
    PetscCallMPI(MPI_Type_contiguous(3, MPIU_REAL, &unit_));
    PetscCallMPI(MPI_Type_commit(&unit_));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CudaBackend::Advance(const Batch &batch, Failure *failure) {
  PetscFunctionBeginUser;
  PetscScalar *u, *v;
  PetscCall(VecCUDAGetArray(vec_u_, &u));  // PETSc must know that the device copies change
  PetscCall(VecCUDAGetArray(vec_v_, &v));
  CdemCuda(cudaDeviceSynchronize());  // what PETSc did to the Vecs is done before our stream reads them
  PetscCall(Prepare(batch));
  const NodeView nodes = View();
  int done = 0;
  if (assembled_) {
    PetscCall(assembled_->Run(nodes, batch, batch_.get()));
  } else if (t_.halo || launch_.timed) {
    for (; done < batch.n; ++done) {
      PetscCall(Halo());
      PetscCall(tables_.LaunchStep(nodes, done == 0 ? batch.first : batch.rest, batch_.get(), launch_));
    }
  } else {
    if (!(batch.first == batch.rest)) {
      PetscCall(tables_.LaunchStep(nodes, batch.first, batch_.get(), launch_));
      ++done;
    }
    if (rows_)
      PetscCall(rows_->Run(nodes, batch.rest, batch_.get(), done, batch.n - done, launch_.stream));
    else if (stencil_)
      PetscCall(stencil_->Run(nodes, batch.rest, batch_.get(), done, batch.n - done, launch_));
    else
      PetscCall(graphs_.Run(batch.rest, launch_.stream, batch.n - done,
                            [&] { return tables_.LaunchStep(nodes, batch.rest, batch_.get(), launch_); }));
  }
  CdemCuda(cudaMemcpyAsync(state_.get(), batch_.get(), sizeof(BatchState), cudaMemcpyDeviceToHost, launch_.stream));
  if (t_.n_watch > 0)
    CdemCuda(cudaMemcpyAsync(batch.history, history_.get(),
                             6 * sizeof(double) * t_.n_watch * static_cast<std::size_t>(batch.n),
                             cudaMemcpyDeviceToHost, launch_.stream));
  CdemCuda(cudaStreamSynchronize(launch_.stream));
  PetscCall(VecCUDARestoreArray(vec_u_, &u));
  PetscCall(VecCUDARestoreArray(vec_v_, &v));
  const unsigned long long failed = state_.get()->failure;
  if (failed != ~0ull) *failure = Failure{static_cast<int>(failed >> 32), static_cast<int>(failed & 0xffffffffu)};
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CudaBackend::Download(const double **u, const double **v, const Histories **history) {
  PetscFunctionBeginUser;
  const PetscScalar *array;
  for (Vec vec : {vec_u_, vec_v_}) {  // a Vec that the host changed last is brought to the device first
    PetscCall(VecCUDAGetArrayRead(vec, &array));
    PetscCall(VecCUDARestoreArrayRead(vec, &array));
  }
  PetscCall(Halo());
  CdemCuda(cudaDeviceSynchronize());
  PetscCall(u_.Download(&host_u_));
  PetscCall(v_.Download(&host_v_));
  PetscCall(tables_.DownloadHistories(&host_history_));
  *u = host_u_.data();
  *v = host_v_.data();
  *history = &host_history_;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CudaBackend::Upload(const double *u, const double *v, const Histories &history) {
  PetscFunctionBeginUser;
  const std::size_t bytes = 3 * sizeof(double) * t_.n_owned;
  PetscScalar *array;
  for (auto [vec, from] : {std::pair<Vec, const double *>{vec_u_, u}, {vec_v_, v}}) {
    PetscCall(VecCUDAGetArrayWrite(vec, &array));
    CdemCuda(cudaMemcpy(array, from, bytes, cudaMemcpyHostToDevice));
    PetscCall(VecCUDARestoreArrayWrite(vec, &array));
  }
  PetscCall(tables_.UploadHistories(history));
  CdemCuda(cudaDeviceSynchronize());
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CudaBackend::Synchronize() {
  PetscFunctionBeginUser;
  CdemCuda(cudaDeviceSynchronize());
  PetscFunctionReturn(PETSC_SUCCESS);
}

/// The rows where a scene can go that way, then the stencils: each is the faster one wherever it fits.
PetscErrorCode CudaBackend::ChooseWay(const std::string &way) {
  PetscFunctionBeginUser;
  if (way == "reference") PetscFunctionReturn(PETSC_SUCCESS);
  if (way == "assembled") {
    assembled_ = std::make_unique<CudaAssembledWay>();
    PetscCall(assembled_->Create(t_, tables_.audited(), u_.get()));
    way_ = assembled_->way();
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  const std::string none = launch_.timed       ? "-log_view_gpu_time"
                           : tables_.audited() ? "the energy balance is kept (-monitor_energy)"
                                               : "";
  std::string why = none;
  if (why.empty() && way != "stencil") {
    auto rows = std::make_unique<RowsWay>();
    PetscCall(rows->Create(t_, &why));
    if (why.empty()) {
      way_ = {"rows", "assembled rows in the registers of " + std::to_string(rows->n_blocks()) +
                          (rows->n_blocks() == 1 ? " thread block" : " thread blocks, one cluster")};
      rows_ = std::move(rows);
      PetscFunctionReturn(PETSC_SUCCESS);
    }
  }
  std::string text = why.empty() ? "" : "not rows: " + why;
  if (none.empty() && way != "rows") {
    auto stencil = std::make_unique<StencilWay>();
    PetscCall(stencil->Create(t_, way == "stencil", &why));
    if (why.empty()) {
      way_ = {"stencil", stencil->Text()};
      stencil_ = std::move(stencil);
      PetscFunctionReturn(PETSC_SUCCESS);
    }
    text += "; not stencil: " + why;
  }
  CdemCheck(way == "auto", t_.comm, "-central_way %s: this scene cannot go that way: %s", way.c_str(), why.c_str());
  way_.text += " (" + text + ")";
  PetscFunctionReturn(PETSC_SUCCESS);
}

/// Room for the schedule and the history of n steps; only in scenes that have them.
PetscErrorCode CudaBackend::Reserve(int n) {
  PetscFunctionBeginUser;
  const std::size_t schedule = t_.records.n > 0 ? 3 * static_cast<std::size_t>(t_.n_tables) * n : 0;
  const std::size_t history = 6 * static_cast<std::size_t>(t_.n_watch) * n;
  if (schedule > schedule_.size() || history > history_.size()) {
    graphs_.Drop();  // they hold the old addresses
    if (stencil_) stencil_->Drop();
    PetscCall(schedule_.Allocate(schedule));
    scheduled_ = 0;
    PetscCall(history_.Allocate(history));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/// Brings schedule and batch state to the device, without waiting for either.
PetscErrorCode CudaBackend::Prepare(const Batch &batch) {
  PetscFunctionBeginUser;
  PetscCall(Reserve(batch.n));
  const std::size_t schedule = 3 * static_cast<std::size_t>(t_.n_tables) * batch.n;
  const bool constant = t_.n_tables == 1;  // table 0 is 1 at all times
  if (batch.schedule && schedule_.size() > 0 && !(constant && scheduled_ >= schedule)) {
    CdemCuda(cudaMemcpyAsync(schedule_.get(), batch.schedule, sizeof(double) * schedule, cudaMemcpyHostToDevice,
                             launch_.stream));
    scheduled_ = schedule;
  }
  *state_.get() = BatchState{0, -1, ~0ull, batch.base, batch.rest.dt, batch.offset};
  CdemCuda(cudaMemcpyAsync(batch_.get(), state_.get(), sizeof(BatchState), cudaMemcpyHostToDevice, launch_.stream));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CudaBackend::Halo() {
  PetscFunctionBeginUser;
  if (!t_.halo) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscLogEventBegin(events.halo, nullptr, nullptr, nullptr, nullptr));
  for (const DeviceArray<double> *field : {&u_, &v_}) {
    if (field == &v_ && t_.beta == 0 && !tables_.audited()) break;
    double *ghosts = field->get() + 3 * static_cast<std::size_t>(t_.n_owned);
    PetscCall(PetscSFBcastWithMemTypeBegin(t_.halo, unit_, PETSC_MEMTYPE_CUDA, field->get(), PETSC_MEMTYPE_CUDA, ghosts,
                                           MPI_REPLACE));
    PetscCall(PetscSFBcastEnd(t_.halo, unit_, field->get(), ghosts, MPI_REPLACE));
  }
  PetscCall(PetscLogEventEnd(events.halo, nullptr, nullptr, nullptr, nullptr));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CopyToCuda(const Tables &tables, int n_owned_cells, std::shared_ptr<DeviceTables> *device) {
  PetscFunctionBeginUser;
  PetscDeviceContext context;
  PetscCall(PetscDeviceInitialize(PETSC_DEVICE_CUDA));       // PETSc chooses the device of this rank
  PetscCall(PetscDeviceContextGetCurrentContext(&context));  // which settles PETSc's stream
  auto made = std::make_shared<DeviceTables>();
  PetscCall(made->Create(tables, n_owned_cells));
  *device = std::move(made);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CreateCudaBackend(const Tables &tables, std::shared_ptr<DeviceTables> device,
                                 const BackendChoice &choice, std::unique_ptr<Backend> *backend) {
  PetscFunctionBeginUser;
  auto made = std::make_unique<CudaBackend>(tables, std::move(device), choice);
  PetscCall(made->Create(choice.audit, choice.way));
  *backend = std::move(made);
  PetscFunctionReturn(PETSC_SUCCESS);
}

}  // namespace cdem
