// Compiled without contraction (CMakeLists.txt), like the other kernels that move nodes.
#include "cuda/assembled_way.cuh"

#include "cuda/launch.cuh"
#include "forces/node_step.hpp"

#include <petscdevice_cuda.h>

namespace cdem {
namespace {

/// to = u + beta v.
__global__ void __launch_bounds__(kBlock)
    DampedKernel(int n, double beta, const double *u, const double *v, double *to) {
  const int i = blockIdx.x * blockDim.x + threadIdx.x;
  if (i < n) to[i] = u[i] + beta * v[i];
}

/// Moves the nodes by a step. [in] f: [n_owned][3] internal forces.
template <class Has>
__global__ void __launch_bounds__(kNodeBlock)
    MoveKernel(NodeView n, StepArgs args, const double *f, BatchState *batch, int step) {
  const int i = blockIdx.x * blockDim.x + threadIdx.x;
  if (i >= n.n_owned) return;
  const double of_node[3] = {f[3ll * i], f[3ll * i + 1], f[3ll * i + 2]};
  if (!NodeStep<Has::kRecords, Has::kQuiet, Has::kDamped>(n, args, i, step, of_node))
    atomicMin(&batch->failure, static_cast<unsigned long long>(step) << 32 | static_cast<unsigned>(i));
}

}  // namespace

CudaAssembledWay::~CudaAssembledWay() {
  (void)MatDestroy(&stiffness_);
  for (Vec *vec : {&vec_u_, &vec_damped_, &vec_f_}) (void)VecDestroy(vec);
}

PetscErrorCode CudaAssembledWay::Create(const Tables &t, bool audited, double *u) {
  PetscFunctionBeginUser;
  const PetscInt n = 3 * static_cast<PetscInt>(t.n_owned);
  PetscCall(CheckAssembled(t, audited));
  PetscCall(CreateStiffness(t, MATAIJCUSPARSE, &stiffness_, &way_));
  kernel_ = VisitNodes(t, [](auto has) { return MoveKernel<decltype(has)>; });
  beta_ = t.beta;
  PetscCall(f_.Allocate(n));
  PetscCall(VecCreateSeqCUDAWithArrays(PETSC_COMM_SELF, 3, n, nullptr, f_.get(), &vec_f_));
  PetscCall(VecCreateSeqCUDAWithArrays(PETSC_COMM_SELF, 3, n, nullptr, u, &vec_u_));
  if (beta_ != 0) {
    PetscCall(damped_.Allocate(n));
    PetscCall(VecCreateSeqCUDAWithArrays(PETSC_COMM_SELF, 3, n, nullptr, damped_.get(), &vec_damped_));
  }
  PetscCall(MatMult(stiffness_, vec_u_, vec_f_));  // brings the matrix to the device
  CdemCuda(cudaDeviceSynchronize());
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CudaAssembledWay::Run(const NodeView &nodes, const Batch &batch, BatchState *state) {
  PetscFunctionBeginUser;
  const cudaStream_t stream = PetscDefaultCudaStream;  // that of the product
  const Vec vec = beta_ != 0 ? vec_damped_ : vec_u_;
  const int n = 3 * nodes.n_owned;
  for (int step = 0; step < batch.n; ++step) {
    double *values;
    const double *f;
    PetscCall(VecCUDAGetArrayWrite(vec, &values));  // PETSc must know that the values change
    if (beta_ != 0) DampedKernel<<<Blocks(n, kBlock), kBlock, 0, stream>>>(n, beta_, nodes.u, nodes.v, values);
    PetscCall(VecCUDARestoreArrayWrite(vec, &values));
    PetscCall(MatMult(stiffness_, vec, vec_f_));
    PetscCall(VecCUDAGetArrayRead(vec_f_, &f));
    kernel_<<<Blocks(nodes.n_owned, kNodeBlock), kNodeBlock, 0, stream>>>(nodes, step == 0 ? batch.first : batch.rest,
                                                                          f, state, step);
    PetscCall(VecCUDARestoreArrayRead(vec_f_, &f));
  }
  CdemCuda(cudaGetLastError());
  PetscFunctionReturn(PETSC_SUCCESS);
}

}  // namespace cdem
