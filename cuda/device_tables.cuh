// The tables on the device, and the launches of one step over them.
#pragma once
#include "cuda/audit_kernels.cuh"
#include "cuda/device_array.cuh"
#include "cuda/order_free_sum.cuh"
#include "cuda/dilatation.cuh"
#include "cuda/element_kernels.cuh"
#include "cuda/launch.cuh"
#include "cuda/node_kernels.cuh"
#include "cuda/spring_kernels.cuh"
#include "forces/backend.hpp"

namespace cdem {

/// Device copies of Tables, and the state of the springs.
class DeviceTables {
 public:
  /// Copies elements, springs and masses.
  PetscErrorCode Create(const Tables &tables, int n_owned_cells);
  /// Adds what steps need besides: records of nodes, and more memory. [in] audit: energies are followed from step to step.
  PetscErrorCode Complete(bool audit);
  std::size_t Bytes() const;

  /// Pointers of the nodes; schedule and history are the caller's device buffers.
  NodeView Nodes(double *u, double *v, const double *schedule, double *history) const;
  /// Fills the slots with the forces of intact elastic elements and springs; no history is read but those of laws of
  /// corners, which must be new, and none is written. [in] u: [n_local][3] m; param: of
  /// ElasticParams, or NULL where they are those of the scene; both device.
  PetscErrorCode LaunchElastic(const double *u, const double *param, const LaunchArgs &launch);
  SlotLists Lists(bool early = false) const { return {list_start_.get(), list_entry_.get(), slots_.get(), early}; }
  const double *inverse_mass() const { return inverse_mass_.get(); }
  /// Launches one step's kernels. [in] batch: device.
  PetscErrorCode LaunchStep(const NodeView &nodes, const StepArgs &args, BatchState *batch, const LaunchArgs &launch);
  /// Sums over what this rank counts; waits for them.
  PetscErrorCode Observe(const NodeView &nodes, const StepArgs &args, cudaStream_t stream, Observed *observed);
  /// The balance at u(n) over all ranks; the state is put back as it was.
  PetscErrorCode Audit(const NodeView &nodes, const StepArgs &args, BatchState *batch, const LaunchArgs &launch,
                       AuditSums *sums);
  /// What a relaxation is steered by; see Backend. [in] u: device.
  PetscErrorCode LookAtBalance(const NodeView &nodes, const StepArgs &args, cudaStream_t stream, Observed *observed,
                               BalanceTerms *terms);
  PetscErrorCode KeepLook(const double *u, cudaStream_t stream);
  PetscErrorCode Kinetic(const double *v, cudaStream_t stream, double *energy);
  PetscErrorCode DownloadBalance(BalanceMemory *memory) const;
  PetscErrorCode UploadBalance(const BalanceMemory &memory);
  PetscErrorCode DownloadAudit(AuditArrays *arrays) const;
  PetscErrorCode UploadAudit(const AuditArrays &arrays);
  bool audited() const { return audited_; }
  PetscErrorCode DownloadHistories(Histories *histories) const;
  PetscErrorCode UploadHistories(const Histories &histories);

 private:
  struct Elements {
    const ElementTable *host;
    DeviceArray<int> node, material, layer;
    DeviceArray<int> cell;          ///< where broken elements release their springs
    std::size_t average_start = 0;  ///< first slot among the integrals of all tables that average
    DeviceArray<std::uint8_t> counted, state;
    DeviceArray<double> value, broken_time;
    DeviceArray<double> work, each;  ///< of the audit: [kElementWorks][n_pad]; energies, once they are asked for
    DeviceArray<std::uint8_t> state_before;  ///< of the audit: state and value before the step
    DeviceArray<double> value_before;
  };
  struct Springs {
    const SpringTable *host;
    DeviceArray<int> a, b, joint;
    DeviceArray<int> cell;  ///< [n][2]; where broken elements release their springs
    DeviceArray<double> normal, area, kn, ks, history;
    DeviceArray<std::uint8_t> state, counted;
    DeviceArray<double> work, viscous, each;  ///< of the audit: [kSpringWorks][n_pad], [3][n_pad], energies
    DeviceArray<std::uint8_t> state_before;   ///< of the audit: state and history before the step
    DeviceArray<double> history_before;
  };
  /// Of relaxations: what their checks keep, and what is added up.
  struct Balance {
    DeviceArray<double> u, residual, now, share;
  };
  /// What an audit changes and puts back.
  struct Kept {
    std::vector<DeviceArray<double>> numbers;
    std::vector<DeviceArray<std::uint8_t>> states;
  };
  PetscErrorCode BuildSlotLists();
  PetscErrorCode CreateAverages();
  PetscErrorCode CreateRelease();
  PetscErrorCode LaunchMeans(int rates, const double *integral, double *mean, const LaunchArgs &launch);
  /// Around the element kernels, in scenes whose elements average: dilatations before them, pressures after them.
  PetscErrorCode LaunchDilatation(const double *u, const double *v, double beta, const LaunchArgs &launch);
  PetscErrorCode LaunchPressure(const LaunchArgs &launch);
  PetscErrorCode LaunchElements(const NodeView &nodes, const StepArgs &args, BatchState *batch,
                                const LaunchArgs &launch);
  /// After the elements, in scenes whose broken elements break the springs of their faces.
  PetscErrorCode LaunchRelease(const LaunchArgs &launch);
  PetscErrorCode LaunchSprings(const NodeView &nodes, const StepArgs &args, const LaunchArgs &launch);
  /// What a step has dissipated in a table that can do so; behind its forces.
  PetscErrorCode LaunchWork(const Elements &e, const ElementView &view, const StepArgs &args, bool last,
                            const LaunchArgs &launch);
  PetscErrorCode LaunchWork(const Springs &s, const SpringView &view, const StepArgs &args, const LaunchArgs &launch);
  PetscErrorCode LaunchNodes(const NodeView &nodes, const StepArgs &args, BatchState *batch, const LaunchArgs &launch);
  PetscErrorCode CreateAudit();
  PetscErrorCode HistoriesAreThoseBefore(cudaStream_t stream);  ///< for the audit of the coming step
  PetscErrorCode CreateBalance();
  PetscErrorCode SumShares(int n, cudaStream_t stream, std::vector<double> *sums);
  template <class F>
  void EachAudited(F &&f);  ///< f(array) with every array that an audit changes
  PetscErrorCode FillEnergies(const NodeView &nodes, const LaunchArgs &launch);  ///< of each element and spring
  NodeWorks Works() const { return {node_work_.get(), row_work_.get(), t_->records.n}; }
  ElementView View(const Elements &e, const double *u, const double *v, double beta, bool early = false) const;
  SpringView View(const Springs &s, const double *u, const double *v, double beta, bool early = false) const;
  PetscErrorCode AddPartial(int blocks, int columns, int maxima, std::size_t to, cudaStream_t stream);

  const Tables *t_ = nullptr;
  std::vector<Elements> elements_;
  std::vector<Springs> springs_;
  DeviceAverages averages_;
  DeviceArray<double> x_, mass_, inverse_mass_, block_param_, joint_param_, slots_;
  DeviceArray<int> list_start_, list_entry_;
  DeviceArray<int> record_, table_, load_start_, load_table_, watch_, quiet_;
  DeviceArray<std::uint8_t> kind_;
  DeviceArray<double> value_, load_, dashpot_;
  DeviceArray<double> weight_, last_;       // of damped nodes
  DeviceArray<std::uint8_t> released_;      // [n_cells], where they release their springs
  DeviceArray<double> partial_, undamped_;  // only once something is observed
  DeviceArray<double> observed_;            // [1 + element tables + spring tables][kNodeSums]
  bool audited_ = false;
  DeviceArray<double> node_work_, row_work_, speed_, half_, weight_u_;  // of the audit; the last two at nodes
  DeviceArray<std::uint8_t> load_wave_;
  Kept kept_;
  Balance balance_;
  OrderFreeSum sum_;
};

}  // namespace cdem
