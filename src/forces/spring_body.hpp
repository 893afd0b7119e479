// The contents of the loop over springs: host and device loops gather, call this, and store.
#pragma once
#include "core/lanes.hpp"
#include "core/small.hpp"
#include "physics/laws.hpp"

namespace cdem {

/// Force on node b [N]. For laws with history, s.history and the outcome are what becomes of the spring when the
/// evaluation is a committing one.
template <class Law, bool kBeta, class T>
CDEM_HD Outcome<T> SpringForce(Spring<T> &s, T force[3]) {
  if constexpr (Law::kLinear) {
    T w[3];
    CDEM_UNROLL for (int k = 0; k < 3; ++k) w[k] = kBeta ? s.d[k] + s.beta_rate[k] : s.d[k];
    Law::Force(s.normal, s.kn, s.ks, w, force);
    const MaskOf<T> none = T{} < T{};
    return {none, none, none, none, none};
  } else {
    return Law::template Force<kBeta>(s, force);
  }
}

}  // namespace cdem
