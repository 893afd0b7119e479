// Elements that break, and with them the springs of their faces: src/forces/release.hpp on the GPU.
#include "cuda/device_tables.cuh"

namespace cdem {

namespace {

/// Marks the cells whose element is broken.
__global__ void __launch_bounds__(kBlock)
    MarkBrokenKernel(int n, bool early, const std::uint8_t *state, const int *cell, std::uint8_t *released) {
  const int e = blockIdx.x * blockDim.x + threadIdx.x;
  WaitForPrevious(early);
  if (e < n && (state[e] & (kBrokenTension | kBrokenShear))) released[cell[e]] = 1;
}

/// [in] cell: [n][2], -1 where breaking does not matter.
__global__ void __launch_bounds__(kBlock)
    ReleaseKernel(int n, bool early, const int *cell, const std::uint8_t *released, std::uint8_t *state) {
  const int i = blockIdx.x * blockDim.x + threadIdx.x;
  WaitForPrevious(early);
  if (i >= n) return;
  const int a = cell[2ll * i], b = cell[2ll * i + 1];
  if ((a >= 0 && released[a]) || (b >= 0 && released[b])) state[i] |= kTensionLost | kCohesionLost;
}

}  // namespace

PetscErrorCode DeviceTables::CreateRelease() {
  PetscFunctionBeginUser;
  PetscCall(released_.Allocate(t_->n_cells));
  for (Elements &e : elements_)
    if (e.host->judged) PetscCall(e.cell.Upload(e.host->cell));
  for (Springs &s : springs_)
    if (s.state.size() > 0) PetscCall(s.cell.Upload(s.host->cell));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode DeviceTables::LaunchRelease(const LaunchArgs &launch) {
  PetscFunctionBeginUser;
  for (const Elements &e : elements_)
    if (e.cell.size() > 0)
      PetscCall(Launch(MarkBrokenKernel, Blocks(e.host->n, kBlock), kBlock, launch, e.host->n, launch.overlap,
                       static_cast<const std::uint8_t *>(e.state.get()), static_cast<const int *>(e.cell.get()),
                       released_.get()));
  if (t_->cells && !launch.load) {  // a spring may hang on an element that only another rank computes
    PetscCall(PetscSFBcastWithMemTypeBegin(t_->cells, MPI_BYTE, PETSC_MEMTYPE_CUDA, released_.get(), PETSC_MEMTYPE_CUDA,
                                           released_.get(), MPI_REPLACE));
    PetscCall(PetscSFBcastEnd(t_->cells, MPI_BYTE, released_.get(), released_.get(), MPI_REPLACE));
  }
  for (const Springs &s : springs_)
    for (std::uint8_t *state : {s.state.get(), s.state_before.get()})
      if (s.cell.size() > 0 && state)
        PetscCall(Launch(ReleaseKernel, Blocks(s.host->n, kBlock), kBlock, launch, s.host->n, launch.overlap,
                         static_cast<const int *>(s.cell.get()), static_cast<const std::uint8_t *>(released_.get()),
                         state));
  PetscFunctionReturn(PETSC_SUCCESS);
}

}  // namespace cdem
