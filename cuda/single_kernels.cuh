// The loop over elastic elements on the GPU in single precision: as forces/host_element_single.hpp does it.
#pragma once
#include "core/single.hpp"
#include "cuda/element_kernels.cuh"
#include "forces/single_check.hpp"

namespace cdem {

/// [in] counts: this kernel is the first of its step, and says so.
template <class Form, bool kBeta>
__global__ void __launch_bounds__(256) SingleElementKernel(ElementView t, BatchState *batch, bool counts) {
  constexpr int corners = Form::kCorners;
  const int e = blockIdx.x * blockDim.x + threadIdx.x;
  if (e < t.n) {
    Single x[corners][3], w[corners][3], force[corners][3], param[Elastic::kParams];
    long long node[corners];
#pragma unroll
    for (int a = 0; a < corners; ++a) {
      node[a] = 3ll * t.node[static_cast<long long>(a) * t.n_pad + e];
#pragma unroll
      for (int k = 0; k < 3; ++k) x[a][k] = {static_cast<float>(t.x[node[a] + k] - t.x[node[0] + k])};
    }
    const double *row = t.param + kMaxParams * t.material[e];
#pragma unroll
    for (int p = 0; p < Elastic::kParams; ++p) param[p] = {static_cast<float>(row[p])};
    WaitForPrevious(t.early);
    double first[3];
#pragma unroll
    for (int a = 0; a < corners; ++a)
#pragma unroll
      for (int k = 0; k < 3; ++k) {
        double u = t.u[node[a] + k];
        if (kBeta) u += t.beta * t.v[node[a] + k];
        if (a == 0) first[k] = u;
        w[a][k] = {static_cast<float>(u - first[k])};
      }
    ElementForce<Form, Elastic, false, Single>(x, w, param, force, nullptr);
#pragma unroll
    for (int a = 0; a < corners; ++a)
#pragma unroll
      for (int k = 0; k < 3; ++k) t.slot[3 * (static_cast<long long>(a) * t.n_pad + e) + k] = force[a][k].v;
  }
  if (counts && e == 0) batch->step = batch->next;
}

}  // namespace cdem
