// What the failure of springs dissipates in a step, for the energy audit: one spring, host and device.
#pragma once
#include "forces/audit.hpp"
#include "forces/spring_body.hpp"

#include <type_traits>

namespace cdem {

/// Springs that can dissipate: those with strength. The others only carry references.
template <class Law>
inline constexpr bool kDissipates = !Law::kLinear && std::is_base_of_v<StrengthLawDefaults, Law>;

/// A spring as it was before an evaluation.
template <class T>
struct SpringBefore {
  T history[kMaxSpringState];
  MaskOf<T> open, tension_lost, any;  ///< any: it had a history
};

/// Springs in which an evaluation can have dissipated anything: not those that stick, nor cracks that stay open. A damaged
/// spring has another stiffness in tension than in pressure, and may have passed from one to the other.
template <class Law, class T>
CDEM_HD MaskOf<T> MayDissipate(const SpringBefore<T> &before, const Outcome<T> &out) {
  const MaskOf<T> moves = out.slides | (out.open & !before.open) | (before.open & !out.open);
  if constexpr (!Law::kSoftens) return moves;
  return moves | ((out.changed | (before.any & !before.tension_lost)) & !(out.open & before.open));
}

/// Energies [J] of the step that ended with this evaluation. Normal and shear force by themselves: the elastic energy of
/// the trial (the history before at the displacement now) less that after the return, less what the trial's excess
/// force would have done on half the way: the scheme's force does F_n + F_n+1 over two. Where a crack opens or closes
/// within the step its force has a corner, over which the scheme does another work than the change of energy: kContact.
/// [in] s: with the history after; force: of the law on b, without its viscous part [N]; step: change of d [m].
template <class Law, class T>
CDEM_HD_CALL void SpringDissipation(Spring<T> s, SpringBefore<T> before, Outcome<T> out, const T force[3],
                                    const T step[3], T work[kSpringWorks]) {
  const T zero = T{};
  const T along = Dot(s.normal, s.d), step_n = Dot(s.normal, step);
  T gap_before = zero, gap = zero;
  if constexpr (Law::kCarriesOffset) {
    gap_before = before.history[Law::kGap];
    gap = s.history[Law::kGap];
  }
  const T trial = along - gap_before, earlier = trial - step_n, opening = along - gap;
  // a crack that carried no tension before carries none now; one that pulled at the step's beginning was whole then
  const MaskOf<T> lax = before.open | (before.tension_lost & (earlier <= zero));
  const T k_earlier = Law::NormalStiffness(s, before.history, earlier, lax);
  const T k_trial = Law::NormalStiffness(s, before.history, trial, lax);
  const T p_earlier = before.open ? zero : -(k_earlier * earlier), p_trial = -(k_trial * trial);
  const T u_earlier = -0.5 * p_earlier * earlier, u_trial = -0.5 * p_trial * trial;
  const T pressing = Dot(force, s.normal);
  const T normal_loss = u_trial + 0.5 * pressing * opening + 0.5 * (p_trial - pressing) * step_n;
  const T corner = -0.5 * (p_earlier + p_trial) * step_n - (u_trial - u_earlier);

  const T *slip = before.history + Law::kSlip;
  T before2 = zero, trial2 = zero, after2 = zero, excess = zero, moved2 = zero;
  CDEM_UNROLL for (int k = 0; k < 3; ++k) {
    const T step_s = step[k] - step_n * s.normal[k];
    const T tried = -(s.ks * (s.d[k] - along * s.normal[k] - slip[k])), after = force[k] - pressing * s.normal[k];
    const T was = tried + s.ks * step_s, drop = tried - after;
    before2 += was * was;
    trial2 += tried * tried;
    after2 += after * after;
    moved2 += drop * drop;
    excess += drop * step_s;
  }
  const T shear_loss = 0.5 * ((trial2 - after2) / s.ks + excess);
  // what the shear force is above friction is cohesion: its work over the slip breaks, the rest rubs
  const T rubs_before = Larger(p_earlier, zero) * s.param[Law::kTanPhi];
  const T rubs = Larger(pressing, zero) * s.param[Law::kTanPhi];
  const T cohesive = Larger(Sqrt(before2) - rubs_before, zero) + Larger(Sqrt(after2) - rubs, zero);
  T broken = 0.5 * cohesive * Sqrt(moved2) / s.ks;
  const T noise = 1e-12 * (Sqrt(before2) + rubs_before) * Sqrt(moved2) / s.ks;
  broken = broken > noise ? broken : zero;
  const MaskOf<T> may = MayDissipate<Law>(before, out), pulled = trial > zero;
  work[kFriction] = may ? shear_loss - broken + (pulled ? zero : normal_loss) : zero;
  work[kSpringFracture] = may ? broken + (pulled ? normal_loss : zero) : zero;
  work[kContact] = may ? corner : zero;
}

}  // namespace cdem
