// The loop over the elements of a table, chosen by its form and law, and by whether the energy audit is on. Compiled once
// for each shape (host_elements_<shape>.cxx).
#pragma once
#include "forces/element_audit.hpp"
#include "forces/host_element_single.hpp"

namespace cdem {

/// Corners of the audit: displacement of the step, mean velocity, velocity.
template <class Form>
void GatherMotion(const ElementPass &pass, const ElementTable &t, int e, const Lanes (*x)[3], Lanes (*step)[3],
                  Lanes (*mean)[3], Lanes (*speed)[3]) {
  const AuditPass &audit = *pass.audit;
  const bool damped = pass.beta != 0;
  for (int a = 0; a < Form::kCorners; ++a) {
    const int *node = &t.node[static_cast<std::size_t>(a) * t.n_pad + e];
    Gather(pass.v, node, speed[a]);
    for (int k = 0; k < 3; ++k) step[a][k] = audit.dt * speed[a][k];
    if (!damped) continue;
    Gather(audit.arrays->speed.data(), node, mean[a]);
    for (int k = 0; k < 3; ++k) mean[a][k] = 0.5 * (mean[a][k] + speed[a][k]);
  }
  if constexpr (Form::kAverages) {
    const int kinds = damped ? 2 : 1;
    const double per_beta = damped ? 1 / pass.beta : 0;
    Lanes of_step[4], of_mean[4], of_speed[4];
    for (int a = 0; a < 4; ++a)
      for (int l = 0; l < kLanes; ++l) {
        const std::size_t at = kinds * t.Layered(pass.tables.layers, a, e + l);
        const double *now = &pass.averages->dilatation[at], *before = &(*pass.averages->before)[at];
        of_step[a][l] = audit.dt > 0 ? now[0] - before[0] : 0;
        of_mean[a][l] = damped ? 0.5 * (before[1] + now[1]) * per_beta : 0;
        of_speed[a][l] = damped ? now[1] * per_beta : 0;
      }
    TetBbar::Spread(x, of_step, step);
    if (damped) TetBbar::Spread(x, of_mean, mean);
    if (damped) TetBbar::Spread(x, of_speed, speed);
  }
}

/// ElementLoop of a committing pass with the energy audit.
template <class Form, class Law>
void AuditLoop(const ElementPass &pass, const ElementTable &t, ElementHistories *h) {
  constexpr int corners = Form::kCorners;
  const std::size_t stride = t.n_pad;
  const bool damped = pass.beta != 0;
  double *work = pass.audit->arrays->element[&t - pass.tables.elements.data()].data();
  for (int e = 0; e < t.n; e += kLanes) {
    Lanes x[corners][3], w[corners][3], rate[corners][3], force[corners][3], param[kMaxParams];
    Lanes step[corners][3], mean[corners][3], speed[corners][3];
    for (int a = 0; a < corners; ++a) {
      const int *node = &t.node[a * stride + e];
      Gather(pass.tables.x.data(), node, x[a]);
      Gather(pass.u, node, w[a]);
      if (damped) Gather(pass.v, node, rate[a]);
      for (int k = 0; damped && k < 3; ++k) rate[a][k] = pass.beta * rate[a][k];
    }
    if constexpr (Form::kAverages) SpreadDilatation(pass, t, e, x, w, rate);
    GatherMotion<Form>(pass, t, e, x, step, mean, speed);
    LoadParams(pass.tables.block_param, &t.material[e], Law::kParams, param);
    ElementHistory<Lanes> history;
    if constexpr (Law::kState > 0) history = Recall(t, h, e);
    ElementAudit<Lanes> audit;
    audit.step = step;
    audit.mean = mean;
    audit.speed = speed;
    audit.beta = pass.beta;
    audit.dt = pass.audit->dt;
    audit.next_dt = pass.audit->next_dt;
    audit.last = pass.audit->last;
    AuditedStep<Form, Law>(x, w, damped ? rate : nullptr, param, &history, force, &audit);
    if constexpr (Law::kState > 0)
      if (Any(history.changed | history.tension | history.shear)) Commit(history, pass.time, e, h);
    for (int i = 0; i < kElementWorks; ++i) {
      double *to = work + i * stride + e;
      StoreAs(to, LoadAs<Lanes>(to) + audit.work[i]);
    }
    if constexpr (Form::kAverages)
      KeepForces(pass, t, e, x, force);
    else
      ScatterForces<corners>(pass, t, e, force);
  }
}

/// Runs the loop of a table's form, among those of its shape, and law.
template <class Forms>
void RunElements(const ElementPass &pass, const ElementTable &t, ElementHistories *h) {
  const bool audit = pass.audit && Audits(pass.tables, t);
  Forms::Visit(t.form, [&](auto form) {
    using Form = decltype(form);
    BlockLaws::Visit(t.law, [&](auto law) {
      using Law = decltype(law);
      if constexpr (!kFits<Form, Law>) {
        return;
      } else if (audit) {
        AuditLoop<Form, Law>(pass, t, h);
      } else if constexpr (Law::kLinear) {  // damping acts inside the law
        if constexpr (kHasSingle<Form, Law>)
          if (pass.single) return (pass.beta != 0 ? SingleLoop<Form, true> : SingleLoop<Form, false>)(pass, t);
        auto loop = pass.beta != 0
                        ? (pass.results ? ElementLoop<Form, Law, true, true> : ElementLoop<Form, Law, true, false>)
                        : (pass.results ? ElementLoop<Form, Law, false, true> : ElementLoop<Form, Law, false, false>);
        loop(pass, t, h);
      } else {  // or outside of it, where one loop serves scenes with and without
        (pass.results ? ElementLoop<Form, Law, true, true> : ElementLoop<Form, Law, true, false>)(pass, t, h);
      }
    });
  });
}

}  // namespace cdem
