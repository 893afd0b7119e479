// The GPU backend: the reference way, captured in CUDA graphs on one rank, with a halo exchange a step on several; or the
// rows or stencils, in scenes that have them.
#pragma once
#include "cuda/assembled_way.cuh"
#include "cuda/device_tables.cuh"
#include "cuda/rows_way.cuh"
#include "cuda/stencil_way.cuh"

#include <memory>

namespace cdem {

class CudaBackend final : public Backend {
 public:
  CudaBackend(const Tables &tables, std::shared_ptr<DeviceTables> device, const BackendChoice &choice)
      : t_(tables), device_(std::move(device)), tables_(*device_) {
    launch_.block = choice.elements_per_block;
    launch_.single = choice.single;
  }
  ~CudaBackend() override;

  PetscErrorCode Create(bool audit, const std::string &way);

  // cuda_backend.cu
  std::string Name() const override;
  Way WayOfStep() const override { return way_; }
  std::size_t Bytes() const override;
  PetscErrorCode CreateVecs(Vec *u, Vec *v) override;
  PetscErrorCode Advance(const Batch &batch, Failure *failure) override;
  PetscErrorCode Download(const double **u, const double **v, const Histories **history) override;
  PetscErrorCode Upload(const double *u, const double *v, const Histories &history) override;
  PetscErrorCode Synchronize() override;

  // cuda_looks.cu
  PetscErrorCode Observe(const StepArgs &next, const double *schedule, Observed *observed) override;
  PetscErrorCode LookAtBalance(const StepArgs &next, const double *schedule, Observed *observed,
                               BalanceTerms *terms) override;
  PetscErrorCode KeepLook() override;
  PetscErrorCode DownloadBalance(const BalanceMemory **memory) override;
  PetscErrorCode UploadBalance(const BalanceMemory &memory) override;
  PetscErrorCode Kinetic(double *energy) override;
  PetscErrorCode Audit(const StepArgs &next, const double *schedule, AuditSums *sums) override;
  PetscErrorCode DownloadAudit(const AuditArrays **arrays) override;
  PetscErrorCode UploadAudit(const AuditArrays &arrays) override;

 private:
  PetscErrorCode ChooseWay(const std::string &way);
  NodeView View() const { return tables_.Nodes(u_.get(), v_.get(), schedule_.get(), history_.get()); }
  PetscErrorCode Reserve(int n);
  PetscErrorCode Prepare(const Batch &batch);
  PetscErrorCode Halo();
  /// Calls look() on the state as it is, with this row of the schedule.
  template <class Look>
  PetscErrorCode WithState(const double *schedule, Look &&look);

  const Tables &t_;
  LaunchArgs launch_;
  const std::shared_ptr<DeviceTables> device_;
  DeviceTables &tables_;
  DeviceArray<double> u_, v_, schedule_, history_;
  DeviceArray<BatchState> batch_;
  PinnedValue<BatchState> state_;          // the host side of batch_
  std::size_t scheduled_ = 0;              // doubles of schedule_ that are filled
  Vec vec_u_ = nullptr, vec_v_ = nullptr;  // borrowed
  StepGraphs graphs_;
  std::unique_ptr<RowsWay> rows_;  // where the scene goes that way
  std::unique_ptr<StencilWay> stencil_;
  std::unique_ptr<CudaAssembledWay> assembled_;  // where the user asks for it
  Way way_;
  MPI_Datatype unit_ = MPI_DATATYPE_NULL;
  std::vector<double> host_u_, host_v_;
  Histories host_history_;
  AuditArrays host_audit_;
  BalanceMemory host_balance_;
};

}  // namespace cdem
