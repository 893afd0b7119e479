// The loop over elements on the GPU: one thread an element, which writes its forces to slots of three doubles.
#pragma once
#include "cuda/kernel_common.cuh"
#include "forces/element_body.hpp"

#include <cstdint>

namespace cdem {

struct ElementView {
  int n, n_pad;
  const int *node, *material;
  const double *param, *x, *u, *v;
  double beta;
  double *slot;                 ///< first slot of this table
  const std::uint8_t *counted;  ///< for observations
};

template <class Form, class Law, bool kBeta, bool kObserve>
__device__ __forceinline__ void ElementThread(const ElementView &t, int e, ElementSums<double> *sums,
                                              double (*force)[3]) {
  constexpr int corners = Form::kCorners;
  double x[corners][3], w[corners][3], param[kMaxParams];
#pragma unroll
  for (int a = 0; a < corners; ++a) {
    const long long node = 3ll * t.node[static_cast<long long>(a) * t.n_pad + e];
#pragma unroll
    for (int k = 0; k < 3; ++k) {
      x[a][k] = t.x[node + k];
      w[a][k] = t.u[node + k];
      if (kBeta) w[a][k] += t.beta * t.v[node + k];
    }
  }
  const double *row = t.param + kMaxParams * t.material[e];
#pragma unroll
  for (int p = 0; p < Law::kParams; ++p) param[p] = row[p];
  ElementForce<Form, Law, kObserve, double>(x, w, param, force, sums);
#pragma unroll
  for (int a = 0; a < corners; ++a)
#pragma unroll
    for (int k = 0; k < 3; ++k) t.slot[3 * (static_cast<long long>(a) * t.n_pad + e) + k] = force[a][k];
}

/// [in] batch: advances its step when not NULL (the first kernel of a step does).
template <class Form, class Law, bool kBeta>
__global__ void __launch_bounds__(256) ElementKernel(ElementView t, BatchState *batch) {
  const int e = blockIdx.x * blockDim.x + threadIdx.x;
  if (batch && e == 0) ++batch->step;
  if (e >= t.n) return;
  double force[Form::kCorners][3];
  ElementThread<Form, Law, kBeta, false>(t, e, nullptr, force);
}

template <class Form, class Law>
__global__ void __launch_bounds__(kBlock) ElementObserveKernel(ElementView t, double *partial) {
  const int e = blockIdx.x * blockDim.x + threadIdx.x;
  double value[kElementSums] = {0, 0, 0};
  if (e < t.n) {
    ElementSums<double> sums;
    double force[Form::kCorners][3];
    ElementThread<Form, Law, false, true>(t, e, &sums, force);
    if (t.counted[e]) {
      value[0] = sums.energy;
      for (int a = 0; a < Form::kCorners; ++a)
        for (int k = 0; k < 3; ++k) value[1] += fabs(force[a][k]);
      value[2] = 3 * Form::kCorners;
    }
  }
  BlockSums(value, partial);
}

}  // namespace cdem
