// The contents of the loop over elements: host and device loops gather, call this, and store.
#pragma once
#include "core/lanes.hpp"
#include "core/small.hpp"
#include "physics/elements.hpp"
#include "physics/laws.hpp"

namespace cdem {

/// What an observation wants of an element besides its forces.
template <class T>
struct ElementSums {
  T energy, volume, stress[6];  ///< J, m^3, Pa m^3
};

/// Adapter from an element form's Gauss points to a law.
template <class Law, bool kObserve, class T>
struct PointOf {
  const T *param;
  ElementSums<T> *sums;
  CDEM_HD void operator()(const T strain[6], T volume, T stress[6]) const {
    Law::Stress(param, strain, stress);
    if (kObserve) {
      sums->energy += 0.5 * volume * Contract(stress, strain);
      sums->volume += volume;
      CDEM_UNROLL for (int i = 0; i < 6; ++i) sums->stress[i] += volume * stress[i];
    }
  }
};

/// Internal forces f [N] of one element (or one lane each of several); sums only with kObserve.
template <class Form, class Law, bool kObserve, class T>
CDEM_HD void ElementForce(const T x[][3], const T u[][3], const T *param, T f[][3], ElementSums<T> *sums) {
  if (kObserve) *sums = ElementSums<T>{};
  Form::Forces(x, u, PointOf<Law, kObserve, T>{param, sums}, f);
}

}  // namespace cdem
