#include "cuda/device_tables.cuh"

namespace cdem {

namespace {

constexpr int kCorners = TetBbar::kCorners;

__device__ __forceinline__ void GatherCorners(const ElementView &t, int e, const double *field, double q[kCorners][3]) {
#pragma unroll
  for (int a = 0; a < kCorners; ++a) {
    const long long node = 3ll * t.node[static_cast<long long>(a) * t.n_pad + e];
#pragma unroll
    for (int k = 0; k < 3; ++k) q[a][k] = field[node + k];
  }
}

/// Integrals of div u, and of div(beta v) with two rates.
__global__ void __launch_bounds__(kBlock) SwellingKernel(ElementView t) {
  const int e = blockIdx.x * blockDim.x + threadIdx.x;
  if (e >= t.n) return;
  double x[kCorners][3], q[kCorners][3];
  GatherCorners(t, e, t.x, x);
  WaitForPrevious(t.early);
  GatherCorners(t, e, t.u, q);
  const int rates = t.average.rates;
  t.average.swelling[static_cast<long long>(rates) * e] = TetBbar::Swelling(x, q);
  if (rates < 2) return;
  GatherCorners(t, e, t.v, q);
#pragma unroll
  for (int a = 0; a < kCorners; ++a)
#pragma unroll
    for (int k = 0; k < 3; ++k) q[a][k] = t.beta * q[a][k];
  t.average.swelling[2ll * e + 1] = TetBbar::Swelling(x, q);
}

/// Means of rows of nodes from the elements' integrals.
__global__ void __launch_bounds__(kBlock) MeanKernel(int n, int rates, bool early, const int *start, const int *entry,
                                                     const double *integral, const double *inverse, double *mean) {
  const int i = blockIdx.x * blockDim.x + threadIdx.x;
  if (i >= n * rates) return;
  const int row = i / rates, rate = i % rates;
  double sum = 0;
  WaitForPrevious(early);
  for (int at = start[row]; at < start[row + 1]; ++at)
    sum += integral[static_cast<long long>(rates) * entry[at] + rate];
  mean[i] = sum * inverse[row];
}

/// Brings the averaged pressure into the slots of the corner forces.
__global__ void __launch_bounds__(kBlock) PressKernel(ElementView t, const double *pressure) {
  const int e = blockIdx.x * blockDim.x + threadIdx.x;
  if (e >= t.n) return;
  double x[kCorners][3], f[kCorners][3], of_node[kCorners];
  GatherCorners(t, e, t.x, x);
  WaitForPrevious(t.early);
  NodeMeans(t.average, t.node, t.n_pad, e, pressure, 1, 0, of_node);
#pragma unroll
  for (int a = 0; a < kCorners; ++a)
#pragma unroll
    for (int k = 0; k < 3; ++k) f[a][k] = t.slot[3 * (static_cast<long long>(a) * t.n_pad + e) + k];
  TetBbar::Press(x, of_node, f);
#pragma unroll
  for (int a = 0; a < kCorners; ++a)
#pragma unroll
    for (int k = 0; k < 3; ++k) t.slot[3 * (static_cast<long long>(a) * t.n_pad + e) + k] = f[a][k];
}

}  // namespace

PetscErrorCode DeviceTables::CreateAverages() {
  PetscFunctionBeginUser;
  if (t_->layers == 0) PetscFunctionReturn(PETSC_SUCCESS);
  std::vector<int> start(t_->inverse_volume.size() + 1, 0), entry;
  const auto each = [&](auto &&f) {  // calls f(row, element) in the order in which the CPU adds
    for (const Elements &e : elements_)
      for (int i = 0; e.host->averages && i < e.host->n; ++i)
        for (int a = 0; a < kCorners; ++a)
          if (e.host->Node(a, i) < t_->n_owned)
            f(e.host->Layered(t_->layers, a, i), static_cast<int>(e.average_start) + i);
  };
  std::size_t slots = 0;
  for (Elements &e : elements_) {
    if (!e.host->averages) continue;
    e.average_start = slots;
    slots += e.host->n_pad;
    PetscCall(e.layer.Upload(e.host->layer));
  }
  each([&](std::size_t row, int) { ++start[row + 1]; });
  for (std::size_t row = 1; row < start.size(); ++row) start[row] += start[row - 1];
  entry.resize(start.back());
  std::vector<int> next(start.begin(), start.end() - 1);
  each([&](std::size_t row, int element) { entry[next[row]++] = element; });
  PetscCall(averages_.start.Upload(start));
  PetscCall(averages_.entry.Upload(entry));
  PetscCall(averages_.inverse_volume.Upload(t_->inverse_volume));
  const std::size_t nodes = static_cast<std::size_t>(t_->n_local) * t_->layers;
  const int rates = t_->beta != 0 ? 2 : 1;
  PetscCall(averages_.dilatation.Allocate(rates * nodes));
  PetscCall(averages_.pressure.Allocate(nodes));
  PetscCall(averages_.of_dilatation.Allocate(rates * slots));
  PetscCall(averages_.of_pressure.Allocate(slots));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode DeviceTables::LaunchMeans(int rates, const double *integral, double *mean, const LaunchArgs &launch) {
  PetscFunctionBeginUser;
  const int rows = static_cast<int>(t_->inverse_volume.size()), width = t_->layers * rates;
  if (rows > 0)
    PetscCall(Launch(MeanKernel, Blocks(rows * rates, kBlock), kBlock, launch, rows, rates, launch.overlap,
                     averages_.start.get(), averages_.entry.get(), integral, averages_.inverse_volume.get(), mean));
  if (!t_->halo) PetscFunctionReturn(PETSC_SUCCESS);
  MPI_Datatype unit;
  PetscCallMPI(MPI_Type_contiguous(width, MPIU_REAL, &unit));
  PetscCallMPI(MPI_Type_commit(&unit));
  double *ghosts = mean + static_cast<std::size_t>(width) * t_->n_owned;
  PetscCall(
      PetscSFBcastWithMemTypeBegin(t_->halo, unit, PETSC_MEMTYPE_CUDA, mean, PETSC_MEMTYPE_CUDA, ghosts, MPI_REPLACE));
  PetscCall(PetscSFBcastEnd(t_->halo, unit, mean, ghosts, MPI_REPLACE));
  PetscCallMPI(MPI_Type_free(&unit));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode DeviceTables::LaunchDilatation(const double *u, const double *v, double beta, const LaunchArgs &launch) {
  PetscFunctionBeginUser;
  if (t_->layers == 0) PetscFunctionReturn(PETSC_SUCCESS);
  for (const Elements &e : elements_)
    if (e.host->averages)
      PetscCall(Launch(SwellingKernel, Blocks(e.host->n, kBlock), kBlock, launch, View(e, u, v, beta, launch.overlap)));
  PetscCall(LaunchMeans(beta != 0 ? 2 : 1, averages_.of_dilatation.get(), averages_.dilatation.get(), launch));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode DeviceTables::LaunchPressure(const LaunchArgs &launch) {
  PetscFunctionBeginUser;
  if (t_->layers == 0) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(LaunchMeans(1, averages_.of_pressure.get(), averages_.pressure.get(), launch));
  for (const Elements &e : elements_)
    if (e.host->averages)
      PetscCall(Launch(PressKernel, Blocks(e.host->n, kBlock), kBlock, launch,
                       View(e, nullptr, nullptr, 0, launch.overlap),
                       static_cast<const double *>(averages_.pressure.get())));
  PetscFunctionReturn(PETSC_SUCCESS);
}

}  // namespace cdem
