// What steers a relaxation, on the GPU: src/forces/balance.hpp.
#include "cuda/device_tables.cuh"
#include "forces/balance.hpp"

namespace cdem {

namespace {

/// What checks keep, [n_owned][3]; share: [kBalanceShares][n_owned].
struct BalanceView {
  const double *u, *residual;  ///< at the last check that counts, or NULL
  double *now, *share;
};

/// [in] f: forces without damping, or NULL: there is none by stiffness.
template <class Has>
__global__ void __launch_bounds__(kBlock)
    BalanceKernel(NodeView n, StepArgs args, SlotLists lists, const double *mass, const double *f, BalanceView b) {
  const int i = blockIdx.x * blockDim.x + threadIdx.x;
  if (i >= n.n_owned) return;
  const long long at = 3ll * i;
  double damped[3], v_now[3], share[kBalanceShares];
  SumSlots(lists, SlotHead(lists, i), damped);
  const NodeSums s =
      ObserveNode<Has::kRecords, Has::kQuiet, Has::kDamped>(n, args, i, mass[i], f ? f + at : damped, damped, v_now);
  BalanceOfNode(mass[i], n.u + at, v_now, s.force, b.u ? b.u + at : nullptr, b.u ? b.residual + at : nullptr, share);
  for (int k = 0; k < 3; ++k) b.now[at + k] = s.force[k];
  for (int k = 0; k < kBalanceShares; ++k) b.share[static_cast<long long>(k) * n.n_owned + i] = share[k];
}

__global__ void __launch_bounds__(kBlock) KineticKernel(int n, const double *mass, const double *v, double *share) {
  const int i = blockIdx.x * blockDim.x + threadIdx.x;
  if (i < n) share[i] = 0.5 * mass[i] * Dot(v + 3ll * i, v + 3ll * i);
}

}  // namespace

/// Sums over the nodes of the first n rows of the shares.
PetscErrorCode DeviceTables::SumShares(int n, cudaStream_t stream, std::vector<double> *sums) {
  PetscFunctionBeginUser;
  const std::size_t nodes = static_cast<std::size_t>(t_->n_owned);
  std::vector<std::vector<Summands>> terms(n);
  for (int k = 0; k < n; ++k) terms[k] = {{balance_.share.get() + k * nodes, nullptr, nodes}};
  PetscCall(sum_.Sum(t_->comm, stream, terms, sums));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode DeviceTables::CreateBalance() {
  PetscFunctionBeginUser;
  const std::size_t nodes = static_cast<std::size_t>(t_->n_owned);
  if (balance_.share.size() > 0) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(balance_.share.Allocate(kBalanceShares * nodes));
  PetscCall(balance_.now.Allocate(3 * nodes));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode DeviceTables::LookAtBalance(const NodeView &nodes, const StepArgs &args, cudaStream_t stream,
                                           Observed *observed, BalanceTerms *terms) {
  PetscFunctionBeginUser;
  PetscCall(CreateBalance());
  PetscCall(Observe(nodes, args, stream, observed));  // leaves the forces in their slots
  if (t_->n_owned > 0) {
    auto kernel = VisitNodes(*t_, [](auto has) { return BalanceKernel<decltype(has)>; });
    const bool path = balance_.u.size() > 0;
    const BalanceView view = {path ? balance_.u.get() : nullptr, path ? balance_.residual.get() : nullptr,
                              balance_.now.get(), balance_.share.get()};
    NodeView seen = nodes;
    seen.last = nullptr;  // as in Observe
    kernel<<<Blocks(t_->n_owned, kBlock), kBlock, 0, stream>>>(seen, args, Lists(), mass_.get(),
                                                               t_->beta != 0 ? undamped_.get() : nullptr, view);
    CdemCuda(cudaGetLastError());
  }
  std::vector<double> sums;
  PetscCall(SumShares(kBalanceShares, stream, &sums));
  *terms = {sums[0], sums[1], sums[2]};
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode DeviceTables::KeepLook(const double *u, cudaStream_t stream) {
  PetscFunctionBeginUser;
  const std::size_t size = balance_.now.size();
  if (balance_.u.size() == 0) {
    PetscCall(balance_.u.Allocate(size));
    PetscCall(balance_.residual.Allocate(size));
  }
  if (size > 0) {
    const std::size_t bytes = size * sizeof(double);
    CdemCuda(cudaMemcpyAsync(balance_.u.get(), u, bytes, cudaMemcpyDeviceToDevice, stream));
    CdemCuda(cudaMemcpyAsync(balance_.residual.get(), balance_.now.get(), bytes, cudaMemcpyDeviceToDevice, stream));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode DeviceTables::DownloadBalance(BalanceMemory *memory) const {
  PetscFunctionBeginUser;
  PetscCall(balance_.u.Download(&memory->u));
  PetscCall(balance_.residual.Download(&memory->residual));
  PetscCall(balance_.now.Download(&memory->now));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode DeviceTables::UploadBalance(const BalanceMemory &memory) {
  PetscFunctionBeginUser;
  PetscCall(CreateBalance());
  PetscCall(balance_.u.Upload(memory.u));
  PetscCall(balance_.residual.Upload(memory.residual));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode DeviceTables::Kinetic(const double *v, cudaStream_t stream, double *energy) {
  PetscFunctionBeginUser;
  PetscCall(CreateBalance());
  if (t_->n_owned > 0)
    KineticKernel<<<Blocks(t_->n_owned, kBlock), kBlock, 0, stream>>>(t_->n_owned, mass_.get(), v,
                                                                      balance_.share.get());
  CdemCuda(cudaGetLastError());
  std::vector<double> sums;
  PetscCall(SumShares(1, stream, &sums));
  *energy = sums[0];
  PetscFunctionReturn(PETSC_SUCCESS);
}

}  // namespace cdem
