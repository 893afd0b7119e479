// One way of launching the bodies: it holds the state (u, v, spring histories) where it computes, advances batches of
// steps, and observes without touching the state.
#pragma once
#include "forces/audit.hpp"
#include "forces/balance.hpp"
#include "forces/host_passes.hpp"

#include <memory>
#include <string>
#include <utility>

namespace cdem {

/// A batch of steps of equal dt. The first kick may differ (start of the run, change of dt).
struct Batch {
  StepArgs first, rest;
  int n = 0;
  double base = 0;  ///< s; step j ends at base + (offset + j + 1) dt
  long long offset = 0;
  const double *schedule = nullptr;  ///< host, [n][n_tables][3]; NULL without records
  double *history = nullptr;         ///< host, [n][n_watch][6], filled by Advance; NULL without watched nodes
};

/// The first node whose velocity left the numbers: step within the batch and local node; step < 0: none.
struct Failure {
  int step = -1, node = -1;
};

/// Sums over what this rank counts, at u(n); the caller adds them over the ranks.
struct Observed {
  double kinetic = 0, strain = 0, spring = 0, form = 0, momentum[3] = {0, 0, 0};
  double residual_sum = 0, residual_count = 0;  ///< out-of-balance |component| over free components [N]
  double force_sum = 0, force_count = 0;        ///< |component| of corner and spring forces before summation [N]
  double broken = 0, springs = 0;
  double v_max2 = 0, u_max2 = 0;  ///< largest |v|^2, |u|^2
  double broken_elements = 0;
  double load_u = 0;  ///< loads and weight times u [J]

  /// Unbalanced force ratio: mean out of balance over mean before summation; 0/0 is in balance.
  double Unbalanced() const {
    const double residual = residual_count > 0 ? residual_sum / residual_count : 0;
    const double force = force_count > 0 ? force_sum / force_count : 0;
    return force > 0 ? residual / force : (residual > 0 ? 1 : 0);
  }
};

/// A way of computing a step.
struct Way {
  std::string name = "reference", text = "forces, springs, sums and update one after the other, in global order";
};

class Backend {
 public:
  virtual ~Backend() = default;
  /// "cpu, 8 lanes (AVX-512)" or the name of the GPU.
  virtual std::string Name() const = 0;
  /// The way of computing a step, and why it is this one.
  virtual Way WayOfStep() const { return {}; }
  /// Memory held for state and tables [bytes].
  virtual std::size_t Bytes() const = 0;
  /// Vecs of the owned nodes (block size 3) on the backend's own memory, behind which the ghosts lie.
  virtual PetscErrorCode CreateVecs(Vec *u, Vec *v) = 0;
  virtual PetscErrorCode Advance(const Batch &batch, Failure *failure) = 0;
  /// Energies, momentum and balance at u(n). [in] next: the arguments that the coming step would have.
  virtual PetscErrorCode Observe(const StepArgs &next, const double *schedule, Observed *observed) = 0;
  /// What a relaxation is steered by, at u(n) (collective). Arguments as for Observe. [out] observed: of this rank.
  virtual PetscErrorCode LookAtBalance(const StepArgs &next, const double *schedule, Observed *observed,
                                       BalanceTerms *terms) = 0;
  /// The last look counts: the next paths begin there.
  virtual PetscErrorCode KeepLook() = 0;
  /// Host copies of what those looks keep, and back.
  virtual PetscErrorCode DownloadBalance(const BalanceMemory **memory) = 0;
  virtual PetscErrorCode UploadBalance(const BalanceMemory &memory) = 0;
  /// Kinetic energy of the half-step velocities (collective) [J].
  virtual PetscErrorCode Kinetic(double *energy) = 0;
  /// Host copies of u, v [n_local][3] (ghosts up to date) and of the histories; pointers stay valid until the next call.
  virtual PetscErrorCode Download(const double **u, const double **v, const Histories **history) = 0;
  /// Sets u, v [n_owned][3] (host) and the histories: a run that goes on from a checkpoint or an earlier stage.
  virtual PetscErrorCode Upload(const double *u, const double *v, const Histories &history) = 0;
  /// The balance at u(n), with what is dissipated up to then (collective); only where the audit is on. Arguments as for
  /// Observe.
  virtual PetscErrorCode Audit(const StepArgs &next, const double *schedule, AuditSums *sums) = 0;
  /// Host copies of the audit's memory, and back; empty while it is off.
  virtual PetscErrorCode DownloadAudit(const AuditArrays **arrays) = 0;
  virtual PetscErrorCode UploadAudit(const AuditArrays &arrays) = 0;
  /// Wall time of the steps by phase [s]: elements, springs, nodes, halo. Empty where the phases run in one graph.
  virtual std::vector<std::pair<std::string, double>> Phases() const { return {}; }
  /// Waits until everything launched has run.
  virtual PetscErrorCode Synchronize() = 0;
};

/// How a backend computes.
struct BackendChoice {
  bool audit = false;           ///< energies are followed from step to step
  std::string way = "auto";     ///< its name, or "auto" for the fastest that the scene has
  bool single = false;          ///< arithmetic of elements in single precision, in the reference way
  int elements_per_block = 32;  ///< of a GPU
};

/// Errors: a way that the scene cannot go.
PetscErrorCode CreateHostBackend(const Tables &tables, int n_owned_cells, const BackendChoice &choice,
                                 std::unique_ptr<Backend> *backend);

/// At u(n), from host copies: v(n) [n_owned][3], and the element and spring results. Used by every backend for frames,
/// and by the host one for its observations. residual, where wanted: forces out of balance [n_owned][3] N.
PetscErrorCode ObserveOnHost(const Tables &tables, int n_owned_cells, const double *u, const double *v,
                             const Histories &history, const StepArgs &next, const double *schedule,
                             ElementResults *elements, SpringResults *springs, std::vector<double> *v_now,
                             Observed *observed, std::vector<double> *residual = nullptr);

class DeviceTables;  ///< Tables on a GPU: cuda/device_tables.cuh

#ifdef CDEM_HAVE_CUDA
/// True when this machine has a usable GPU.
bool CudaDeviceThere();
/// Starts the GPU and copies what is final once nodes have their masses; records of nodes follow with the backend.
/// [in] tables: must outlive the copy.
PetscErrorCode CopyToCuda(const Tables &tables, int n_owned_cells, std::shared_ptr<DeviceTables> *device);
/// The matrix of CreateElasticOperator for Vecs of the GPU (collective); histories on the device are not touched.
/// [in] device: the copy of these tables, still without history; it is shared, not copied again.
PetscErrorCode CreateCudaElasticOperator(const Tables &tables, std::shared_ptr<DeviceTables> device, Mat *matrix);
/// [in] device: the copy of these tables, which the backend steps on. Errors: a way that the scene cannot go.
PetscErrorCode CreateCudaBackend(const Tables &tables, std::shared_ptr<DeviceTables> device,
                                 const BackendChoice &choice, std::unique_ptr<Backend> *backend);
#endif

}  // namespace cdem
