// The elastic stiffness of a scene, scaled by its masses, on the GPU: the matrix of src/forces/elastic_operator.hpp on the
// tables that the steps will use, for Lanczos steps whose vectors never leave the device.
#include "forces/elastic_operator.hpp"

#include "cuda/device_tables.cuh"

#include <petscdevice_cuda.h>

#include <algorithm>
#include <memory>

namespace cdem {

namespace {

/// M^(-1/2) of the owned nodes, 0 in components that are prescribed.
struct Scaling {
  int n;
  const double *inverse_mass;
  const std::uint8_t *free;  ///< bits 1, 2, 4

  __device__ __forceinline__ void Of(int i, double s[3]) const {
    const double root = sqrt(inverse_mass[i]);
    const int bits = free[i];
#pragma unroll
    for (int k = 0; k < 3; ++k) s[k] = bits >> k & 1 ? root : 0.0;
  }
};

/// u = M^(-1/2) x.
__global__ void __launch_bounds__(kBlock) DisplacementKernel(Scaling scaling, const double *x, double *u) {
  const int i = blockIdx.x * blockDim.x + threadIdx.x;
  if (i >= scaling.n) return;
  double s[3];
  scaling.Of(i, s);
#pragma unroll
  for (int k = 0; k < 3; ++k) u[3ll * i + k] = s[k] * x[3ll * i + k];
}

/// y = M^(-1/2) times the sums of the slots.
__global__ void __launch_bounds__(kBlock) ForceKernel(Scaling scaling, SlotLists lists, double *y) {
  const int i = blockIdx.x * blockDim.x + threadIdx.x;
  if (i >= scaling.n) return;
  double s[3], f[3];
  SumSlots(lists, SlotHead(lists, i), f);
  scaling.Of(i, s);
#pragma unroll
  for (int k = 0; k < 3; ++k) y[3ll * i + k] = s[k] * f[k];
}

/// What the matrix holds besides the tables of the scene.
struct Elasticity {
  const Tables *scene;
  std::shared_ptr<DeviceTables> device;
  DeviceArray<double> param;  ///< of blocks; empty where they are those of the scene
  DeviceArray<double> u;      ///< [n_local][3] m
  DeviceArray<std::uint8_t> free;
  MPI_Datatype unit = MPI_DATATYPE_NULL;
};

PetscErrorCode Multiply(Mat matrix, Vec x, Vec y) {
  PetscFunctionBeginUser;
  Elasticity *e;
  const PetscScalar *from;
  PetscScalar *to;
  PetscCall(MatShellGetContext(matrix, &e));
  const Tables &t = *e->scene;
  LaunchArgs launch;
  launch.stream = PetscDefaultCudaStream;  // that of the Vecs and of PetscSF: nobody has to wait
  const Scaling scaling = {t.n_owned, e->device->inverse_mass(), e->free.get()};
  const int blocks = Blocks(t.n_owned, kBlock);

  PetscCall(VecCUDAGetArrayRead(x, &from));
  if (blocks > 0) PetscCall(Launch(DisplacementKernel, blocks, kBlock, launch, scaling, from, e->u.get()));
  PetscCall(VecCUDARestoreArrayRead(x, &from));
  if (t.halo) {
    double *ghosts = e->u.get() + 3 * static_cast<std::size_t>(t.n_owned);
    PetscCall(PetscSFBcastWithMemTypeBegin(t.halo, e->unit, PETSC_MEMTYPE_CUDA, e->u.get(), PETSC_MEMTYPE_CUDA, ghosts,
                                           MPI_REPLACE));
    PetscCall(PetscSFBcastEnd(t.halo, e->unit, e->u.get(), ghosts, MPI_REPLACE));
  }
  PetscCall(e->device->LaunchElastic(e->u.get(), e->param.get(), launch));
  PetscCall(VecCUDAGetArrayWrite(y, &to));
  if (blocks > 0) PetscCall(Launch(ForceKernel, blocks, kBlock, launch, scaling, e->device->Lists(), to));
  PetscCall(VecCUDARestoreArrayWrite(y, &to));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode Destroy(Mat matrix) {
  PetscFunctionBeginUser;
  Elasticity *e;
  PetscCall(MatShellGetContext(matrix, &e));
  if (e->unit != MPI_DATATYPE_NULL) PetscCallMPI(MPI_Type_free(&e->unit));
  delete e;
  PetscFunctionReturn(PETSC_SUCCESS);
}

}  // namespace

PetscErrorCode CreateCudaElasticOperator(const Tables &tables, std::shared_ptr<DeviceTables> device, Mat *matrix) {
  PetscFunctionBeginUser;
  auto e = std::make_unique<Elasticity>();
  e->scene = &tables;
  e->device = std::move(device);
  if (std::any_of(tables.elements.begin(), tables.elements.end(), HasOwnLaws))
    PetscCall(e->param.Upload(ElasticParams(tables)));
  PetscCall(e->free.Upload(FreeComponents(tables)));
  PetscCall(e->u.Allocate(3 * static_cast<std::size_t>(tables.n_local)));
  if (tables.halo) {
    PetscCallMPI(MPI_Type_contiguous(3, MPIU_REAL, &e->unit));
    PetscCallMPI(MPI_Type_commit(&e->unit));
  }
  const PetscInt n = 3 * static_cast<PetscInt>(tables.n_owned);
  PetscCall(MatCreateShell(tables.comm, n, n, PETSC_DETERMINE, PETSC_DETERMINE, e.release(), matrix));
  PetscCall(MatShellSetVecType(*matrix, VECCUDA));
  PetscCall(MatShellSetOperation(*matrix, MATOP_MULT, reinterpret_cast<void (*)(void)>(Multiply)));
  PetscCall(MatShellSetOperation(*matrix, MATOP_DESTROY, reinterpret_cast<void (*)(void)>(Destroy)));
  PetscFunctionReturn(PETSC_SUCCESS);
}

}  // namespace cdem
