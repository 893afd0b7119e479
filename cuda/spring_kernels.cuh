// The loop over springs on the GPU: one thread a spring, which writes its force to its slot.
#pragma once
#include "cuda/kernel_common.cuh"
#include "forces/spring_body.hpp"

#include <cstdint>

namespace cdem {

struct SpringView {
  int n, n_pad;
  const int *a, *b, *joint;
  const double *normal, *area, *kn, *ks, *param, *u, *v;
  double beta;
  bool early;  ///< see WaitForPrevious
  std::uint8_t *state;
  double *history, *slot;
  const std::uint8_t *counted;
};

/// Gathers a spring; returns its state. [in] param: room for the law's numbers.
template <class Law, bool kBeta>
__device__ __forceinline__ std::uint8_t GatherSpring(const SpringView &t, int i, Spring<double> &s,
                                                     double (&param)[kMaxParams]) {
  const long long a = 3ll * t.a[i], b = 3ll * t.b[i];
  WaitForPrevious(t.early);
  std::uint8_t state = 0;
#pragma unroll
  for (int k = 0; k < 3; ++k) {
    s.d[k] = t.u[b + k] - t.u[a + k];
    s.beta_rate[k] = kBeta ? t.beta * (t.v[b + k] - t.v[a + k]) : 0.0;
    s.normal[k] = t.normal[static_cast<long long>(k) * t.n_pad + i];
  }
  s.kn = t.kn[i];
  s.ks = t.ks[i];
  if constexpr (Law::kHistory) {
    s.area = t.area[i];
    const double *row = t.param + kMaxParams * t.joint[i];
#pragma unroll
    for (int p = 0; p < Law::kParams; ++p) param[p] = row[p];
    s.param = param;
    state = t.state[i];
    s.tension_lost = state & kTensionLost ? 1.0 : 0.0;
    s.cohesion_lost = state & kCohesionLost ? 1.0 : 0.0;
#pragma unroll
    for (int k = 0; k < Law::kState; ++k)
      s.history[k] = state ? t.history[static_cast<long long>(k) * t.n_pad + i] : 0.0;
  }
  return state;
}

/// Writes a spring's force to its slot; commits its history with kCommit. Returns the state it would leave.
template <class Law, bool kCommit>
__device__ __forceinline__ std::uint8_t FinishSpring(const SpringView &t, int i, const Spring<double> &s,
                                                     std::uint8_t state, const Outcome<double> &outcome,
                                                     const double (&force)[3]) {
  std::uint8_t next = 0;
  if constexpr (Law::kHistory) {
    next = NextState(state, StateBits(outcome));
    if (kCommit) {
      if (next != state) t.state[i] = next;
      if (outcome.changed)
#pragma unroll
        for (int k = 0; k < Law::kState; ++k) t.history[static_cast<long long>(k) * t.n_pad + i] = s.history[k];
    }
  }
#pragma unroll
  for (int k = 0; k < 3; ++k) t.slot[3ll * i + k] = force[k];
  return next;
}

/// One spring: writes its force to its slot; commits its history with kCommit. Returns the state it would leave.
template <class Law, bool kBeta, bool kCommit>
__device__ __forceinline__ std::uint8_t SpringThread(const SpringView &t, int i, Spring<double> &s,
                                                     double (&force)[3]) {
  double param[kMaxParams];
  const std::uint8_t state = GatherSpring<Law, kBeta>(t, i, s, param);
  const Outcome<double> outcome = SpringForce<Law, kBeta>(s, force);
  return FinishSpring<Law, kCommit>(t, i, s, state, outcome, force);
}

template <class Law, bool kBeta>
__global__ void __launch_bounds__(kBlock) SpringKernel(SpringView t) {
  const int i = blockIdx.x * blockDim.x + threadIdx.x;
  if (i >= t.n) return;
  Spring<double> s;
  double force[3];
  SpringThread<Law, kBeta, true>(t, i, s, force);
}

/// [out] each: energy of every spring [J], or NULL.
template <class Law, bool kBeta>
__global__ void __launch_bounds__(kBlock) SpringObserveKernel(SpringView t, double *partial, double *each) {
  const int i = blockIdx.x * blockDim.x + threadIdx.x;
  double value[kSpringSums] = {0, 0, 0, 0, 0};
  if (i < t.n) {
    Spring<double> s;
    double force[3];
    const std::uint8_t next = SpringThread<Law, kBeta, false>(t, i, s, force);
    if (each) each[i] = Law::Energy(s, force);
    if (t.counted[i]) {
      value[0] = Law::Energy(s, force);
      for (int k = 0; k < 3; ++k) value[1] += fabs(force[k]);
      value[2] = 3;
      value[3] = next & kCohesionLost ? 1 : 0;
      value[4] = 1;
    }
  }
  BlockSums(value, partial);
}

}  // namespace cdem
