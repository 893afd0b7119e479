// The energy audit of elements and springs on the GPU: behind the kernels of the step, which know nothing of it, the
// bodies of the CPU's audit on the histories as they were before, one thread each, which adds to numbers of its own.
#pragma once
#include "cuda/element_kernels.cuh"
#include "cuda/spring_kernels.cuh"
#include "forces/element_audit.hpp"
#include "forces/spring_audit.hpp"

namespace cdem {

/// What the audit adds to an ElementView.
struct ElementAuditView {
  double *work = nullptr;          ///< [kElementWorks][n_pad]
  std::uint8_t *state = nullptr;   ///< before the step, as in ElementView; of laws with history
  double *value = nullptr;         ///< the same
  int values = 0;                  ///< rows of it
  const double *speed = nullptr;   ///< [n_local][3] velocity of the step before; with beta
  const double *before = nullptr;  ///< dilatation of the step before; of forms that average
  double dt = 0, next_dt = 0;      ///< s; of the step that ended, 0 at the start; of the coming one
  bool last = false;               ///< the sums are wanted as of now
};

/// Behind ElementKernel, of a law that can dissipate, or with damping by stiffness.
template <class Form, class Law>
__global__ void __launch_bounds__(256) ElementWorkKernel(ElementView t, ElementAuditView a) {
  constexpr int corners = Form::kCorners;
  const int e = blockIdx.x * blockDim.x + threadIdx.x;
  WaitForPrevious(t.early);
  if (e < t.n) {
    const bool damped = t.beta != 0;
    if constexpr (Law::kState > 0)
      if (!damped && t.state[e] == 0) return;  // nothing has ever happened to it
    double x[corners][3], w[corners][3], rate[corners][3], param[kMaxParams], force[corners][3];
    double step[corners][3], mean[corners][3], speed[corners][3];
    const double *row = t.param + kMaxParams * t.material[e];
#pragma unroll
    for (int p = 0; p < Law::kParams; ++p) param[p] = row[p];
#pragma unroll
    for (int c = 0; c < corners; ++c) {
      const long long node = 3ll * t.node[static_cast<long long>(c) * t.n_pad + e];
#pragma unroll
      for (int k = 0; k < 3; ++k) {
        x[c][k] = t.x[node + k];
        w[c][k] = t.u[node + k];
        speed[c][k] = t.v[node + k];
        rate[c][k] = t.beta * speed[c][k];
        step[c][k] = a.dt * speed[c][k];
        mean[c][k] = damped ? 0.5 * (a.speed[node + k] + speed[c][k]) : 0.0;
      }
    }
    if constexpr (Form::kAverages) {
      const int rates = damped ? 2 : 1;
      double now[4], was[4];
      NodeMeans(t.average, t.node, t.n_pad, e, t.average.mean, rates, 0, now);
      NodeMeans(t.average, t.node, t.n_pad, e, a.before, rates, 0, was);
      Form::Spread(x, now, w);
#pragma unroll
      for (int c = 0; c < 4; ++c) was[c] = a.dt > 0 ? now[c] - was[c] : 0.0;
      Form::Spread(x, was, step);
      if (damped) {
        NodeMeans(t.average, t.node, t.n_pad, e, t.average.mean, rates, 1, now);
        NodeMeans(t.average, t.node, t.n_pad, e, a.before, rates, 1, was);
        Form::Spread(x, now, rate);
#pragma unroll
        for (int c = 0; c < 4; ++c) was[c] = 0.5 * (was[c] + now[c]) / t.beta, now[c] /= t.beta;
        Form::Spread(x, was, mean);
        Form::Spread(x, now, speed);
      }
    }
    ElementHistory<double> history;
    if constexpr (Law::kState > 0) {
      const std::uint8_t before = a.state[e];
      history = {a.value + e,
                 t.n_pad,
                 (before & kTouched) != 0,
                 false,
                 (before & kBrokenTension) != 0,
                 (before & kBrokenShear) != 0};
    }
    ElementAudit<double> audit;
    audit.step = step;
    audit.mean = mean;
    audit.speed = speed;
    audit.beta = t.beta;
    audit.dt = a.dt;
    audit.next_dt = a.next_dt;
    audit.last = a.last;
    AuditedStep<Form, Law, double>(x, w, damped ? rate : nullptr, param, &history, force, &audit);
    if constexpr (Law::kState > 0) {  // the next step begins with what the step itself has made of it
      a.state[e] = t.state[e];
      for (int k = 0; k < a.values && t.state[e]; ++k) {
        const long long at = static_cast<long long>(k) * t.n_pad + e;
        a.value[at] = t.value[at];
      }
    }
#pragma unroll
    for (int i = 0; i < kElementWorks; ++i)
      if (audit.work[i] != 0) a.work[static_cast<long long>(i) * t.n_pad + e] += audit.work[i];
  }
}

/// What the audit adds to a SpringView.
struct SpringAuditView {
  double *work = nullptr;         ///< [kSpringWorks][n_pad]
  std::uint8_t *state = nullptr;  ///< before the step; of laws with history
  double *history = nullptr;      ///< the same
  double *viscous = nullptr;      ///< [3][n_pad] N, damping force of the step before; with beta
  double dt = 0;                  ///< s, of the step that ended
};

/// Behind SpringKernel, of a law that can dissipate, or with damping by stiffness.
template <class Law, bool kBeta>
__global__ void __launch_bounds__(kBlock) SpringWorkKernel(SpringView t, SpringAuditView a) {
  const int i = blockIdx.x * blockDim.x + threadIdx.x;
  WaitForPrevious(t.early);
  if (i >= t.n) return;
  SpringView earlier = t;
  if constexpr (Law::kHistory) {
    if (!kBeta && t.state[i] == 0) return;  // nothing has ever happened to it
    earlier.state = a.state;
    earlier.history = a.history;
  }
  Spring<double> s, again;
  double param[kMaxParams], force[3], lawful[3];
  const std::uint8_t state = GatherSpring<Law, kBeta>(earlier, i, s, param);
  again = s;
  SpringBefore<double> before;
  if constexpr (kDissipates<Law>) {
#pragma unroll
    for (int k = 0; k < Law::kState; ++k) before.history[k] = s.history[k];
    before.open = state & kOpen;
    before.tension_lost = state & kTensionLost;
    before.any = state != 0;
  }
  const Outcome<double> outcome = SpringForce<Law, kBeta>(s, force);
#pragma unroll
  for (int k = 0; k < 3; ++k) lawful[k] = force[k];
  if (kBeta) SpringForce<Law, false>(again, lawful);  // without its viscous part
  bool may = false;
  if constexpr (kDissipates<Law>) may = MayDissipate<Law>(before, outcome);
  if (kBeta || may) {
    double work[kSpringWorks] = {0, 0, 0, 0}, step[3];
    const long long na = 3ll * t.a[i], nb = 3ll * t.b[i];
#pragma unroll
    for (int k = 0; k < 3; ++k) step[k] = a.dt * (t.v[nb + k] - t.v[na + k]);
    if constexpr (kDissipates<Law>)
      if (may) SpringDissipation<Law>(s, before, outcome, lawful, step, work);
    if (kBeta)
#pragma unroll
      for (int k = 0; k < 3; ++k) {
        double &was = a.viscous[static_cast<long long>(k) * t.n_pad + i];
        const double now = force[k] - lawful[k];
        work[kSpringBeta] -= 0.5 * (was + now) * step[k];
        was = now;
      }
#pragma unroll
    for (int k = 0; k < kSpringWorks; ++k)
      if (work[k] != 0) a.work[static_cast<long long>(k) * t.n_pad + i] += work[k];
  }
  if constexpr (Law::kHistory) {  // the next step begins with what the step itself has made of it
    a.state[i] = t.state[i];
    for (int k = 0; k < Law::kState && t.state[i]; ++k) {
      const long long at = static_cast<long long>(k) * t.n_pad + i;
      a.history[at] = t.history[at];
    }
  }
}

}  // namespace cdem
