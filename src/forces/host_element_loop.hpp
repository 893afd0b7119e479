// The loop over the elements of a table on the CPU. Compiled once for each shape (host_elements_<shape>.cxx): it is made
// anew for every law and form.
#pragma once
#include "forces/dilatation.hpp"
#include "forces/host_gather.hpp"
#include "forces/host_passes.hpp"

#include <algorithm>
#include <cmath>

namespace cdem {

/// What a pass over the elements is given.
struct ElementPass {
  const Tables &tables;
  const double *u, *v;
  double beta, time;  ///< s; at the end of the step
  double *f;
  int n_owned_cells;
  ElementResults *results;  ///< NULL but in observing passes
  Averages *averages;       ///< of forms that average
  const AuditPass *audit;   ///< NULL: the energy audit is off
  bool single = false;      ///< arithmetic of elements in single precision
};

/// Takes the dilatations of u and beta v from the nodes.
inline void SpreadDilatation(const ElementPass &pass, const ElementTable &t, int e, const Lanes x[4][3], Lanes u[4][3],
                             Lanes rate[4][3]) {
  const int kinds = pass.beta != 0 ? 2 : 1;
  Lanes of_node[2][4];
  for (int a = 0; a < 4; ++a)
    for (int l = 0; l < kLanes; ++l)
      for (int r = 0; r < kinds; ++r)
        of_node[r][a][l] = pass.averages->dilatation[kinds * t.Layered(pass.tables.layers, a, e + l) + r];
  TetBbar::Spread(x, of_node[0], u);
  if (kinds == 2) TetBbar::Spread(x, of_node[1], rate);
}

/// Keeps corner forces until their pressure has been averaged, and adds the pressure to the nodes.
inline void KeepForces(const ElementPass &pass, const ElementTable &t, int e, const Lanes x[4][3],
                       const Lanes f[4][3]) {
  std::vector<double> &force = pass.averages->force[&t - pass.tables.elements.data()];
  for (int a = 0; a < 4; ++a)
    for (int k = 0; k < 3; ++k) StoreAs(&force[static_cast<std::size_t>(3 * a + k) * t.n_pad + e], f[a][k]);
  const Lanes pressure = TetBbar::Pressure(x, f);
  for (int l = 0; l < std::min(kLanes, t.n - e); ++l)
    for (int a = 0; a < 4; ++a) pass.averages->pressure[t.Layered(pass.tables.layers, a, e + l)] += pressure[l];
}

/// Lanes of history of the elements from e on.
inline ElementHistory<Lanes> Recall(const ElementTable &t, ElementHistories *h, int e) {
  ElementHistory<Lanes> history;
  history.value = &h->value[e];
  history.stride = t.n_pad;
  history.changed = LaneMask{};
  for (int l = 0; l < kLanes; ++l) {
    history.touched[l] = h->state[e + l] & kTouched ? -1 : 0;
    history.tension[l] = h->state[e + l] & kBrokenTension ? -1 : 0;
    history.shear[l] = h->state[e + l] & kBrokenShear ? -1 : 0;
  }
  return history;
}

inline void Commit(const ElementHistory<Lanes> &history, double time, int e, ElementHistories *h) {
  for (int l = 0; l < kLanes; ++l) {
    const bool broken = history.tension[l] || history.shear[l];
    if (broken && !h->broken_time.empty() && std::isnan(h->broken_time[e + l])) h->broken_time[e + l] = time;
    h->state[e + l] =
        static_cast<std::uint8_t>((history.touched[l] || history.changed[l] ? kTouched : 0) |
                                  (history.tension[l] ? kBrokenTension : 0) | (history.shear[l] ? kBrokenShear : 0));
  }
}

/// Adds corner forces of the elements from e on to their nodes, one element after the other.
template <int corners>
CDEM_HD void ScatterForces(const ElementPass &pass, const ElementTable &t, int e, const Lanes (*force)[3]) {
  const std::size_t stride = t.n_pad;
  alignas(sizeof(Lanes)) double out[corners][3][kLanes];
  for (int a = 0; a < corners; ++a)
    for (int k = 0; k < 3; ++k) StoreAs(out[a][k], force[a][k]);
  const int live = std::min(kLanes, t.n - e);
  for (int l = 0; l < live; ++l) CDEM_UNROLL for (int a = 0; a < corners; ++a) {
      double *to = pass.f + 3 * static_cast<std::ptrdiff_t>(t.node[a * stride + e + l]);
      to[0] += out[a][0][l];
      to[1] += out[a][1][l];
      to[2] += out[a][2][l];
    }
}

template <class Form, class Law, bool kBeta, bool kObserve>
void ElementLoop(const ElementPass &pass, const ElementTable &t, ElementHistories *h) {
  constexpr int corners = Form::kCorners;
  const std::size_t stride = t.n_pad;
  const bool damped = pass.beta != 0;
  for (int e = 0; e < t.n; e += kLanes) {
    Lanes x[corners][3], w[corners][3], rate[corners][3], force[corners][3], param[kMaxParams];
    for (int a = 0; a < corners; ++a) {
      const int *node = &t.node[a * stride + e];
      Gather(pass.tables.x.data(), node, x[a]);
      Gather(pass.u, node, w[a]);
      if (kBeta && (Law::kLinear || damped)) {
        Gather(pass.v, node, rate[a]);
        for (int k = 0; k < 3; ++k) rate[a][k] = pass.beta * rate[a][k];
      }
    }
    if constexpr (Form::kAverages) SpreadDilatation(pass, t, e, x, w, rate);
    LoadParams(pass.tables.block_param, &t.material[e], Law::kParams, param);
    ElementSums<Lanes> sums;
    ElementHistory<Lanes> history;
    if constexpr (Law::kState > 0) history = Recall(t, h, e);
    ElementStep<Form, Law, kBeta, kObserve>(x, w, Law::kLinear || damped ? rate : nullptr, param, &history, force,
                                            &sums);
    if constexpr (Law::kState > 0 && !kObserve)
      if (Any(history.changed | history.tension | history.shear)) Commit(history, pass.time, e, h);

    if constexpr (Form::kAverages)
      KeepForces(pass, t, e, x, force);
    else
      ScatterForces<corners>(pass, t, e, force);
    for (int l = 0; kObserve && l < std::min(kLanes, t.n - e); ++l) {
      const int cell = t.cell[e + l];
      if (cell >= pass.n_owned_cells) continue;
      ElementResults &results = *pass.results;
      results.energy += sums.energy[l];
      if (results.each) results.each[cell] = sums.energy[l];
      results.force_count += 3 * corners;
      for (int a = 0; a < corners; ++a)
        for (int k = 0; k < 3; ++k) results.force_sum += std::fabs(force[a][k][l]);
      if (results.stress)
        for (int i = 0; i < 6; ++i)
          results.stress[6 * static_cast<std::ptrdiff_t>(cell) + i] = sums.stress[i][l] / sums.volume[l];
      if constexpr (kBreaks<Law>) results.broken += Failed<Law>(history)[l] != 0;
    }
  }
}

void TetElements(const ElementPass &pass, const ElementTable &t, ElementHistories *h);
void WedgeElements(const ElementPass &pass, const ElementTable &t, ElementHistories *h);
void HexElements(const ElementPass &pass, const ElementTable &t, ElementHistories *h);

}  // namespace cdem
