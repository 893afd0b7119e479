// An element's forces and history as ElementStep has them, and with them what the step dissipates, for the energy audit.
// Only laws that can dissipate, and damping by stiffness, come here; host and device.
#pragma once
#include "forces/audit.hpp"
#include "forces/element_body.hpp"

namespace cdem {

/// What the audit is given of an element besides its displacements, and what it makes of the step.
template <class T>
struct ElementAudit {
  T (*step)[3] = nullptr;   ///< corners: displacement of the step that ended here [m]
  T (*mean)[3] = nullptr;   ///< with damping: mean of the velocities of that step and the one before [m/s]
  T (*speed)[3] = nullptr;  ///< velocity of that step [m/s]
  double beta = 0;          ///< s; 0: no damping
  double dt = 0;            ///< s; of that step, 0 at the start
  double next_dt = 0;       ///< s; of the coming one, counts at the start
  bool last = false;        ///< the sums are wanted at this very time: as of the evaluation that ends them
  T work[kElementWorks];    ///< [out] J
};

/// What the returns of an element's points left over.
template <int kPoints, class T>
struct Returns {
  T loss;              ///< elastic energy of the trial less that after the return [J]
  T drop[kPoints][6];  ///< stress of the trial less that after the return, times the volume [N m]
  MaskOf<T> any;
};

/// [in] offset: what the strain is measured from, before the return; stress: after it [Pa].
template <class T>
CDEM_HD_CALL T LossOfReturn(T lambda, T mu, const T strain[6], const T offset[6], const T stress[6], T volume,
                            MaskOf<T> changed, T drop[6]) {
  const T param[2] = {lambda, mu};
  T e[6], trial[6];
  for (int i = 0; i < 6; ++i) e[i] = strain[i] - offset[i];
  Elastic::Stress(param, e, trial);
  for (int i = 0; i < 6; ++i) drop[i] = changed ? volume * (trial[i] - stress[i]) : T{};
  return changed ? volume * (ElasticEnergy(lambda, mu, trial) - ElasticEnergy(lambda, mu, stress)) : T{};
}

/// As PointOf of a committing evaluation, of a law with a return; keeps what it leaves over.
template <class Law, int kPoints, class T>
struct ReturningPoint {
  const T *param;
  ElementHistory<T> *history;
  Returns<kPoints, T> *returns;

  CDEM_HD void operator()(int g, const T strain[6], T volume, T stress[6]) const {
    T state[Law::kState], before[6];
    CDEM_UNROLL for (int i = 0; i < Law::kState; ++i) state[i] = T{};
    if (Any(history->touched)) {
      CDEM_UNROLL for (int i = 0; i < Law::kState; ++i) state[i] = history->Get(g * Law::kState + i);
    }
    CDEM_UNROLL for (int i = 0; i < 6; ++i) before[i] = state[i];
    MaskOf<T> changed = Law::Stress(param, strain, state, stress);
    if (Law::kJudgesMean) changed = changed & (history->tension | history->shear);
    if (!Any(changed)) return;
    history->changed = history->changed | changed;
    CDEM_UNROLL for (int i = 0; i < Law::kState; ++i) {
      const int at = g * Law::kState + i;
      history->Set(at, Law::kJudgesMean ? (changed ? state[i] : history->Get(at)) : state[i]);
    }
    if (!Any(returns->any))
      for (int p = 0; p < kPoints; ++p)
        for (int i = 0; i < 6; ++i) returns->drop[p][i] = T{};
    returns->any = returns->any | changed;
    T strains[6], stresses[6], drop[6];  // copies, so that only they need an address
    CDEM_UNROLL for (int i = 0; i < 6; ++i) strains[i] = strain[i], stresses[i] = stress[i];
    returns->loss +=
        LossOfReturn(param[Elastic::kLambda], param[Elastic::kMu], strains, before, stresses, volume, changed, drop);
    CDEM_UNROLL for (int i = 0; i < 6; ++i) returns->drop[g][i] = drop[i];
  }
  CDEM_HD T ShearModulus() const { return param[Elastic::kMu]; }
  CDEM_HD void Stored(T) const {}
};

/// Instead of a law: the work of given stresses over a strain.
template <class T>
struct WorkPoint {
  const T (*stress)[6];  ///< times the volume [N m]
  T *work;

  CDEM_HD void operator()(int g, const T strain[6], T, T out[6]) const {
    *work += Contract(stress[g], strain);
    CDEM_UNROLL for (int i = 0; i < 6; ++i) out[i] = T{};
  }
  CDEM_HD T ShearModulus() const { return T{}; }
  CDEM_HD void Stored(T) const {}
};

template <class Form, class T>
CDEM_HD_CALL T WorkOverStep(const T x[][3], const T step[][3], const T stress[][6]) {
  T work = T{}, unused[Form::kCorners][3];
  Form::Forces(x, step, WorkPoint<T>{stress, &work}, unused);
  return work;
}

/// Elastic energy of a field [J]; of velocities [W s].
template <class Form, class T>
CDEM_HD_CALL T EnergyOf(const T x[][3], const T field[][3], const T *param) {
  ElementSums<T> sums;
  T unused[Form::kCorners][3];
  ElementForce<Form, Elastic, true>(x, field, param, unused, &sums);
  return sums.energy;
}

/// A law of corners, whose stress is a function of the strain and of what is broken.
template <class Law, class T>
struct CornerPoint {
  const T *param;
  const ElementHistory<T> *history;  ///< of the offset, where there is one
  T *code, *energy;                  ///< [point]; sum [J]

  CDEM_HD void operator()(int g, const T strain[6], T volume, const T area[3][3], T stress[6]) const {
    T state[Law::kState];
    CDEM_UNROLL for (int i = 0; i + 1 < Law::kState; ++i) state[i] = history->Get(g * Law::kState + i);
    state[Law::kState - 1] = code[g];
    Law::Stress(param, strain, area, state, stress);
    code[g] = state[Law::kState - 1];
    *energy += volume * ElasticEnergy(param[Elastic::kLambda], param[Elastic::kMu], stress);
  }
  CDEM_HD T ShearModulus() const { return param[Elastic::kMu]; }
  CDEM_HD void Stored(T) const {}
};

/// Damping by stiffness: with a and b the velocities of the step before and of this one and m their mean, the scheme does
/// beta dt (a + b).K b / 2 = beta dt (m.K m + (b.K b - a.K a) / 4) over a step; the second term telescopes.
template <class Form, class T>
CDEM_HD T BetaWork(const T x[][3], const T *param, const ElementAudit<T> &audit, MaskOf<T> was, MaskOf<T> is) {
  const T zero = T{};
  T work = 2.0 * audit.dt * EnergyOf<Form>(x, audit.mean, param);
  work = was ? work : zero;
  const bool start = audit.dt == 0;
  const MaskOf<T> stops = was & !is;
  if (start || audit.last || Any(stops)) {
    const T end = 0.5 * EnergyOf<Form>(x, audit.speed, param);
    work = stops ? work - audit.dt * end : work;
    if (start && !audit.last) work = is ? work - audit.next_dt * end : zero;
    if (!start && audit.last) work = is ? work + audit.dt * end : work;
  }
  return audit.beta * work;
}

/// ElementStep of a committing evaluation, with its energies.
template <class Form, class Law, class T>
CDEM_HD void AuditedStep(const T x[][3], T u[][3], const T beta_rate[][3], const T *param, ElementHistory<T> *history,
                         T f[][3], ElementAudit<T> *audit) {
  constexpr int corners = Form::kCorners;
  const T zero = T{};
  const MaskOf<T> none = zero < zero, all = !none;
  CDEM_UNROLL for (int i = 0; i < kElementWorks; ++i) audit->work[i] = zero;
  MaskOf<T> failed_before = none, failed = none;
  if constexpr (Law::kLinear) {
    if (beta_rate)
      CDEM_UNROLL for (int a = 0; a < corners; ++a) CDEM_UNROLL for (int k = 0; k < 3; ++k) u[a][k] += beta_rate[a][k];
    ElementForce<Form, Law, false>(x, u, param, f, static_cast<ElementSums<T> *>(nullptr));
  } else if constexpr (Law::kAtCorners) {
    failed_before = Failed<Law>(*history);
    T code[Form::kPoints];
    CDEM_UNROLL for (int g = 0; g < Form::kPoints; ++g) code[g] = zero;
    if (Any(history->touched))
      CDEM_UNROLL for (int g = 0; g < Form::kPoints; ++g) code[g] = history->Get(g * Law::kState + Law::kState - 1);
    Form::Forces(x, u, PointOf<Law, false, T>{param, nullptr, history}, f);
    failed = Failed<Law>(*history);
    if (Any(failed)) {
      T was[corners][3], now[corners][3], before[corners][3], after[Form::kPoints], u_before = zero, u_after = zero;
      T strong[Law::kParams];  // at the step's beginning nothing more breaks than had broken
      CDEM_UNROLL for (int p = 0; p < Law::kParams; ++p) strong[p] = param[p];
      strong[Law::kTension] = strong[Law::kCohesion] = zero + kUnreached;
      CDEM_UNROLL for (int g = 0; g < Form::kPoints; ++g) after[g] = code[g];
      CDEM_UNROLL for (int a = 0; a < corners; ++a) CDEM_UNROLL for (int k = 0; k < 3; ++k) before[a][k] =
          u[a][k] - audit->step[a][k];
      Form::Forces(x, before, CornerPoint<Law, T>{strong, history, code, &u_before}, was);
      Form::Forces(x, u, CornerPoint<Law, T>{param, history, after, &u_after}, now);
      T work = zero;
      CDEM_UNROLL for (int a = 0; a < corners; ++a) CDEM_UNROLL for (int k = 0; k < 3; ++k) work +=
          0.5 * (was[a][k] + now[a][k]) * audit->step[a][k];
      work = failed ? work - (u_after - u_before) : zero;
      const MaskOf<T> fresh = history->changed;
      audit->work[kElementFracture] = fresh ? work : zero;
      audit->work[kPlastic] = fresh ? zero : work;
    }
  } else if constexpr (Law::kState >= 6) {
    Returns<Form::kPoints, T> returns;
    returns.loss = zero;
    returns.any = none;
    MaskOf<T> fresh = none;
    if constexpr (Law::kJudgesMean) {
      ElementSums<T> elastic;
      if constexpr (Law::kCarriesOffset) {
        elastic = ElementSums<T>{};
        Form::Forces(x, u, PointOf<ElasticFrom<Law::kState>, true, T>{param, &elastic, history}, f);
      } else {
        ElementForce<Form, Elastic, true>(x, u, param, f, &elastic);
      }
      T mean[6];
      CDEM_UNROLL for (int i = 0; i < 6; ++i) mean[i] = elastic.stress[i] / elastic.volume;
      MaskOf<T> tension, shear;
      Law::Judge(param, mean, &tension, &shear);
      failed_before = history->tension | history->shear;
      history->tension = history->tension | (tension & !failed_before);
      history->shear = history->shear | (shear & !failed_before & !tension);
      failed = history->tension | history->shear;
      fresh = failed & !failed_before;
      if (Any(failed)) {
        T g[corners][3];
        Form::Forces(x, u, ReturningPoint<Law, Form::kPoints, T>{param, history, &returns}, g);
        CDEM_UNROLL for (int a = 0; a < corners; ++a) CDEM_UNROLL for (int k = 0; k < 3; ++k) f[a][k] =
            failed ? g[a][k] : f[a][k];
      }
    } else if constexpr (Law::kPlasticShear >= 0) {
      Form::Forces(x, u, ReturningPoint<Law, Form::kPoints, T>{param, history, &returns}, f);
    } else {  // only an offset: nothing returns
      Form::Forces(x, u, PointOf<Law, false, T>{param, nullptr, history}, f);
    }
    if (Any(returns.any)) {
      const T work = returns.loss - 0.5 * WorkOverStep<Form>(x, audit->step, returns.drop);
      audit->work[kElementFracture] = fresh ? work : zero;
      audit->work[kPlastic] = fresh ? zero : work;
    }
  }
  if (!beta_rate) return;
  if constexpr (!Law::kLinear) {
    T g[corners][3];
    ElementForce<Form, Elastic, false, T>(x, beta_rate, param, g, nullptr);
    const MaskOf<T> out = Failed<Law>(*history);
    CDEM_UNROLL for (int a = 0; a < corners; ++a) CDEM_UNROLL for (int k = 0; k < 3; ++k) f[a][k] +=
        out ? T{} : g[a][k];
  }
  audit->work[kElementBeta] = BetaWork<Form>(x, param, *audit, all & !failed_before, all & !failed);
}

}  // namespace cdem
