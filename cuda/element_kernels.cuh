// The loop over elements on the GPU: one thread an element, which writes its forces to slots of three doubles.
#pragma once
#include "cuda/dilatation.cuh"
#include "forces/element_body.hpp"
#include "forces/node_step.hpp"

#include <cstdint>

namespace cdem {

struct ElementView {
  int n, n_pad;
  const int *node, *material;
  const double *param, *x, *u, *v;
  double beta;
  bool early;                   ///< see WaitForPrevious
  double *slot;                 ///< first slot of this table
  const std::uint8_t *counted;  ///< for observations
  std::uint8_t *state;          ///< of laws with history: bits of ElementState
  double *value, *broken_time;  ///< [point][number][n_pad]; s, NaN while intact
  AverageView average;          ///< of forms that average
};

template <class Form, class Law, bool kBeta, bool kObserve>
__device__ __forceinline__ void ElementThread(const ElementView &t, int e, const BatchState *batch,
                                              ElementSums<double> *sums, double (*force)[3], bool *broken) {
  constexpr int corners = Form::kCorners;
  double x[corners][3], w[corners][3], rate[corners][3], param[kMaxParams];
#pragma unroll
  for (int a = 0; a < corners; ++a) {
    const long long node = 3ll * t.node[static_cast<long long>(a) * t.n_pad + e];
#pragma unroll
    for (int k = 0; k < 3; ++k) x[a][k] = t.x[node + k];
  }
  const double *row = t.param + kMaxParams * t.material[e];
#pragma unroll
  for (int p = 0; p < Law::kParams; ++p) param[p] = row[p];
  WaitForPrevious(t.early);
#pragma unroll
  for (int a = 0; a < corners; ++a) {
    const long long node = 3ll * t.node[static_cast<long long>(a) * t.n_pad + e];
#pragma unroll
    for (int k = 0; k < 3; ++k) {
      w[a][k] = t.u[node + k];
      if (kBeta) rate[a][k] = t.beta * t.v[node + k];
    }
  }
  if constexpr (Form::kAverages) {
    double of_node[4];
    NodeMeans(t.average, t.node, t.n_pad, e, t.average.mean, 1 + kBeta, 0, of_node);
    Form::Spread(x, of_node, w);
    if (kBeta) {
      NodeMeans(t.average, t.node, t.n_pad, e, t.average.mean, 1 + kBeta, 1, of_node);
      Form::Spread(x, of_node, rate);
    }
  }
  ElementHistory<double> history;
  std::uint8_t before = 0;
  if constexpr (Law::kState > 0) {
    before = t.state[e];
    history = {t.value + e,
               t.n_pad,
               (before & kTouched) != 0,
               false,
               (before & kBrokenTension) != 0,
               (before & kBrokenShear) != 0};
  }
  ElementStep<Form, Law, kBeta, kObserve, double>(x, w, rate, param, &history, force, sums);
  if constexpr (Form::kAverages) t.average.pressure[e] = Form::Pressure(x, force);
  if constexpr (Law::kState > 0) {
    *broken = Failed<Law>(history);
    const std::uint8_t after = (history.touched || history.changed ? kTouched : 0) |
                               (history.tension ? kBrokenTension : 0) | (history.shear ? kBrokenShear : 0);
    if (!kObserve && after != before) {
      t.state[e] = after;
      if (Law::kJudgesMean && *broken && !(before & (kBrokenTension | kBrokenShear)))
        t.broken_time[e] = StepEnd(batch->base, batch->offset, batch->next, batch->dt);
    }
  }
#pragma unroll
  for (int a = 0; a < corners; ++a)
#pragma unroll
    for (int k = 0; k < 3; ++k) t.slot[3 * (static_cast<long long>(a) * t.n_pad + e) + k] = force[a][k];
}

/// [in] counts: this kernel is the first of its step, and says so.
template <class Form, class Law, bool kBeta>
__global__ void __launch_bounds__(256) ElementKernel(ElementView t, BatchState *batch, bool counts) {
  const int e = blockIdx.x * blockDim.x + threadIdx.x;
  if (e < t.n) {
    double force[Form::kCorners][3];
    bool broken;
    ElementThread<Form, Law, kBeta, false>(t, e, batch, nullptr, force, &broken);
  }
  if (counts && e == 0) batch->step = batch->next;
}

/// [out] each: energy of every element [J], or NULL.
template <class Form, class Law, bool kBeta>
__global__ void __launch_bounds__(kBlock) ElementObserveKernel(ElementView t, double *partial, double *each) {
  const int e = blockIdx.x * blockDim.x + threadIdx.x;
  double value[kElementSums] = {0, 0, 0, 0};
  if (e < t.n) {
    ElementSums<double> sums;
    double force[Form::kCorners][3];
    bool broken = false;
    ElementThread<Form, Law, kBeta, true>(t, e, nullptr, &sums, force, &broken);
    if (each) each[e] = sums.energy;
    if (t.counted[e]) {
      value[0] = sums.energy;
      for (int a = 0; a < Form::kCorners; ++a)
        for (int k = 0; k < 3; ++k) value[1] += fabs(force[a][k]);
      value[2] = 3 * Form::kCorners;
      value[3] = broken ? 1 : 0;
    }
  }
  BlockSums(value, partial);
}

}  // namespace cdem
