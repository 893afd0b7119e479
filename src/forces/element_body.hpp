// The contents of the loop over elements: host and device loops gather, call this, and store.
#pragma once
#include "core/lanes.hpp"
#include "core/small.hpp"
#include "physics/elements.hpp"
#include "physics/laws.hpp"

#include <cstdint>

namespace cdem {

/// What an observation wants of an element besides its forces.
template <class T>
struct ElementSums {
  T energy, volume, stress[6];  ///< J, m^3, Pa m^3
};

/// Bits of an element's state byte, in laws with history.
enum ElementState { kTouched = 1, kBrokenTension = 2, kBrokenShear = 4 };

/// The history of an element (or one lane each of several): its numbers stay in memory, [point][number] with a stride,
/// and are read and written point by point, and only where there is any.
template <class T>
struct ElementHistory {
  double *value = nullptr;   ///< of the first point and number
  long long stride = 0;      ///< from one number to the next
  MaskOf<T> touched;         ///< [in] some number is not zero
  MaskOf<T> changed;         ///< [out] numbers were written, or an observation would have
  MaskOf<T> tension, shear;  ///< broken, by a law that judges the element's mean stress

  CDEM_HD T Get(int at) const { return LoadAs<T>(value + at * stride); }
  CDEM_HD void Set(int at, T x) const { StoreAs(value + at * stride, x); }
};

/// Elements that have failed: broken, in laws of corners anywhere (those of an offset say so by the bit of tension).
template <class Law, class T>
CDEM_HD MaskOf<T> Failed(const ElementHistory<T> &h) {
  return Law::kAtCorners && !Law::kCarriesOffset ? h.touched | h.changed : h.tension | h.shear;
}

/// Elastic energy of a stress per volume [J/m^3].
template <class T>
CDEM_HD T ElasticEnergy(T lambda, T mu, const T stress[6]) {
  T trace = stress[kXX] + stress[kYY] + stress[kZZ];
  return (Contract(stress, stress) - lambda / (3.0 * lambda + 2.0 * mu) * trace * trace) / (4.0 * mu);
}

/// Adapter from an element form's points to a law.
template <class Law, bool kObserve, class T>
struct PointOf {
  static constexpr bool kAlike = Law::kLinear && !kObserve;
  const T *param;
  ElementSums<T> *sums;
  ElementHistory<T> *history;

  /// [in] g: number of the point; strain with true shears. [out] stress [Pa].
  CDEM_HD void operator()(int g, const T strain[6], T volume, T stress[6]) const {
    if constexpr (Law::kState == 0) {
      (void)g;
      Law::Stress(param, strain, stress);
    } else if constexpr (!Law::kAtCorners) {
      T state[Law::kState];
      Recall(g, state);
      Keep(g, state, Law::Stress(param, strain, state, stress));
    }
    if (kObserve) Add(strain, volume, stress);
  }
  /// The same at a corner with vectors along the normals of its three faces, for forms whose points are corners.
  CDEM_HD void operator()(int g, const T strain[6], T volume, const T area[3][3], T stress[6]) const {
    if constexpr (Law::kAtCorners) {
      T state[Law::kState];
      Recall(g, state);
      Keep(g, state, Law::Stress(param, strain, area, state, stress));
      if (kObserve) Add(strain, volume, stress);
    } else {
      (void)area;
      (*this)(g, strain, volume, stress);
    }
  }
  /// For forms with a stiffness of their own: the shear modulus [Pa], and the energy [J] that it holds.
  CDEM_HD T ShearModulus() const { return param[Elastic::kMu]; }
  CDEM_HD void Stored(T energy) const {
    if (kObserve) sums->energy += energy;
  }

 private:
  CDEM_HD void Recall(int g, T *state) const {
    CDEM_UNROLL for (int i = 0; i < Law::kState; ++i) state[i] = T{};
    if (Any(history->touched)) {
      CDEM_UNROLL for (int i = 0; i < Law::kState; ++i) state[i] = history->Get(g * Law::kState + i);
    }
  }
  /// An observation leaves the values alone.
  CDEM_HD void Keep(int g, const T *state, MaskOf<T> changed) const {
    if (Law::kJudgesMean) changed = changed & (history->tension | history->shear);  // its neighbours in the lanes
    if (!Any(changed)) return;
    history->changed = history->changed | changed;
    if (Law::kAtCorners && Law::kCarriesOffset) history->tension = history->tension | changed;
    if constexpr (!kObserve) {
      CDEM_UNROLL for (int i = 0; i < Law::kState; ++i) {
        const int at = g * Law::kState + i;
        history->Set(at, Law::kJudgesMean ? (changed ? state[i] : history->Get(at)) : state[i]);
      }
    } else {
      (void)g, (void)state;
    }
  }
  CDEM_HD void Add(const T strain[6], T volume, const T stress[6]) const {
    if constexpr (Law::kLinear)
      sums->energy += 0.5 * volume * Contract(stress, strain);
    else
      sums->energy += volume * ElasticEnergy(param[0], param[1], stress);
    sums->volume += volume;
    CDEM_UNROLL for (int i = 0; i < 6; ++i) sums->stress[i] += volume * stress[i];
  }
};

/// Internal forces f [N] of one element (or one lane each of several) by a law without history; sums only with kObserve.
template <class Form, class Law, bool kObserve, class T>
CDEM_HD void ElementForce(const T x[][3], const T u[][3], const T *param, T f[][3], ElementSums<T> *sums) {
  if (kObserve) *sums = ElementSums<T>{};
  Form::Forces(x, u, PointOf<Law, kObserve, T>{param, sums, nullptr}, f);
}

/// Internal forces f [N] of one element by any law. [in] x: corners [m]; u: displacements [m]; beta_rate: beta v [m], used
/// with kBeta only, where laws that are not linear take NULL for none. Laws that are linear act on u + beta v; outside the
/// others stands the viscous stress D : (beta strain rate), except in broken elements. [in,out] history: of laws that have
/// one; committed unless kObserve.
template <class Form, class Law, bool kBeta, bool kObserve, class T>
CDEM_HD void ElementStep(const T x[][3], T u[][3], const T beta_rate[][3], const T *param, ElementHistory<T> *history,
                         T f[][3], ElementSums<T> *sums) {
  constexpr int corners = Form::kCorners;
  if constexpr (Law::kLinear) {
    if (kBeta)
      CDEM_UNROLL for (int a = 0; a < corners; ++a) CDEM_UNROLL for (int k = 0; k < 3; ++k) u[a][k] += beta_rate[a][k];
    ElementForce<Form, Law, kObserve>(x, u, param, f, sums);
  } else if constexpr (Law::kJudgesMean) {
    // intact elements are elastic; their mean stress decides, and what is broken is computed again by its law
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
    const MaskOf<T> before = history->tension | history->shear;
    history->tension = history->tension | (tension & !before);
    history->shear = history->shear | (shear & !before & !tension);
    const MaskOf<T> broken = history->tension | history->shear;
    if (kObserve) *sums = elastic;
    if (Any(broken)) {
      T g[corners][3];
      ElementSums<T> other;
      if (kObserve) other = ElementSums<T>{};
      Form::Forces(x, u, PointOf<Law, kObserve, T>{param, &other, history}, g);
      CDEM_UNROLL for (int a = 0; a < corners; ++a) CDEM_UNROLL for (int k = 0; k < 3; ++k) f[a][k] =
          broken ? g[a][k] : f[a][k];
      if (kObserve) {
        sums->energy = broken ? other.energy : sums->energy;
        CDEM_UNROLL for (int i = 0; i < 6; ++i) sums->stress[i] = broken ? other.stress[i] : sums->stress[i];
      }
    }
  } else {
    if (kObserve) *sums = ElementSums<T>{};
    Form::Forces(x, u, PointOf<Law, kObserve, T>{param, sums, history}, f);
  }
  if constexpr (kBeta && !Law::kLinear) {
    if (!beta_rate) return;
    T g[corners][3];
    ElementForce<Form, Elastic, false, T>(x, beta_rate, param, g, nullptr);
    const MaskOf<T> failed = Failed<Law>(*history);
    CDEM_UNROLL for (int a = 0; a < corners; ++a) CDEM_UNROLL for (int k = 0; k < 3; ++k) f[a][k] +=
        failed ? T{} : g[a][k];
  }
}

}  // namespace cdem
