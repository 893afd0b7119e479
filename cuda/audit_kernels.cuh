// The loops over elements and springs on the GPU with the energy audit: the same bodies as on the CPU, one thread each,
// which adds to numbers of its own.
#pragma once
#include "cuda/element_kernels.cuh"
#include "cuda/spring_kernels.cuh"
#include "forces/element_audit.hpp"
#include "forces/spring_audit.hpp"

namespace cdem {

/// What the audit adds to an ElementView.
struct ElementAuditView {
  double *work = nullptr;          ///< [kElementWorks][n_pad]
  const double *speed = nullptr;   ///< [n_local][3] velocity of the step before; with beta
  const double *before = nullptr;  ///< dilatation of the step before; of forms that average
  double dt = 0, next_dt = 0;      ///< s; of the step that ended, 0 at the start; of the coming one
  bool last = false;               ///< the sums are wanted as of now
};

/// ElementKernel of a law that can dissipate, or with damping by stiffness.
template <class Form, class Law>
__global__ void __launch_bounds__(256)
    AuditedElementKernel(ElementView t, ElementAuditView a, BatchState *batch, bool counts) {
  constexpr int corners = Form::kCorners;
  const int e = blockIdx.x * blockDim.x + threadIdx.x;
  if (e < t.n) {
    const bool damped = t.beta != 0;
    double x[corners][3], w[corners][3], rate[corners][3], param[kMaxParams], force[corners][3];
    double step[corners][3], mean[corners][3], speed[corners][3];
    const double *row = t.param + kMaxParams * t.material[e];
#pragma unroll
    for (int p = 0; p < Law::kParams; ++p) param[p] = row[p];
    WaitForPrevious(t.early);
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
    ElementAudit<double> audit;
    audit.step = step;
    audit.mean = mean;
    audit.speed = speed;
    audit.beta = t.beta;
    audit.dt = a.dt;
    audit.next_dt = a.next_dt;
    audit.last = a.last;
    AuditedStep<Form, Law, double>(x, w, damped ? rate : nullptr, param, &history, force, &audit);
    if constexpr (Form::kAverages) t.average.pressure[e] = Form::Pressure(x, force);
    if constexpr (Law::kState > 0) {
      const bool broken = Failed<Law>(history);
      const std::uint8_t after = (history.touched || history.changed ? kTouched : 0) |
                                 (history.tension ? kBrokenTension : 0) | (history.shear ? kBrokenShear : 0);
      if (after != before) {
        t.state[e] = after;
        if (Law::kJudgesMean && broken && !(before & (kBrokenTension | kBrokenShear)))
          t.broken_time[e] = StepEnd(batch->base, batch->offset, batch->next, batch->dt);
      }
    }
#pragma unroll
    for (int i = 0; i < kElementWorks; ++i)
      if (audit.work[i] != 0) a.work[static_cast<long long>(i) * t.n_pad + e] += audit.work[i];
#pragma unroll
    for (int c = 0; c < corners; ++c)
#pragma unroll
      for (int k = 0; k < 3; ++k) t.slot[3 * (static_cast<long long>(c) * t.n_pad + e) + k] = force[c][k];
  }
  if (counts && e == 0) batch->step = batch->next;
}

/// What the audit adds to a SpringView.
struct SpringAuditView {
  double *work = nullptr;     ///< [kSpringWorks][n_pad]
  double *viscous = nullptr;  ///< [3][n_pad] N, damping force of the step before; with beta
  double dt = 0;              ///< s, of the step that ended
};

template <class Law, bool kBeta>
__global__ void __launch_bounds__(kBlock) AuditedSpringKernel(SpringView t, SpringAuditView a) {
  const int i = blockIdx.x * blockDim.x + threadIdx.x;
  if (i >= t.n) return;
  Spring<double> s, again;
  double param[kMaxParams], force[3], lawful[3];
  const std::uint8_t state = GatherSpring<Law, kBeta>(t, i, s, param);
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
  FinishSpring<Law, true>(t, i, s, state, outcome, force);
}

}  // namespace cdem
