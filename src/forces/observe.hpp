// What one node gives to an observation; host and device.
#pragma once
#include "forces/bodies.hpp"

namespace cdem {

/// A node's share of the sums of an observation.
struct NodeSums {
  double kinetic, half, form, momentum[3], residual, free, v2, u2;  ///< half: v(n-1/2).m v(n+1/2)/2 [J]
  double load_u;                                                    ///< loads and weight times u [J]
  double force[3];                                                  ///< out of balance [N]; 0 where prescribed
};

/// Velocity of the coming half step of a node with dashpots, as NodeStep has it. [in] a: acceleration without them.
CDEM_HD void QuietVelocity(const NodeView &n, const StepArgs &s, int i, int row, const double a[3], double v[3]) {
  double v_old[3];
  for (int k = 0; k < 3; ++k) {
    v_old[k] = n.v[3 * static_cast<long long>(i) + k];
    v[k] = s.keep * v_old[k] + s.kick * a[k];
    const int kind = (n.kind[row] >> (2 * k)) & 3;
    if (kind == kFree) continue;
    const double value = n.value[3 * row + k], *table = n.schedule + 3 * n.table[3 * row + k];
    v[k] = PrescribedVelocity(kind, value, table, n.u[3 * static_cast<long long>(i) + k], s.dt);
    if (s.start) v_old[k] = kind == kVelocity ? value * table[0] : v[k];
  }
  Absorb(n.dashpot + 6 * n.quiet[row], 0.5 * s.kick * n.inverse_mass[i], n.kind[row], v_old, v);
}

/// [in] f_int: internal force at u(n), without damping; f_damped: the same with beta K v. [out] v_now: v(n).
template <bool kRecords, bool kQuiet = false, bool kDamped = false>
CDEM_HD NodeSums ObserveNode(const NodeView &n, const StepArgs &s, int i, double mass, const double f_int[3],
                             const double f_damped[3], double v_now[3]) {
  const int row = kRecords ? n.record[i] : -1;
  double a[3], a_static[3];
  Acceleration<kRecords, kDamped>(n, s, i, row, n.schedule, n.inverse_mass[i], f_damped, a);
  Acceleration<kRecords, kDamped>(n, s, i, row, n.schedule, n.inverse_mass[i], f_int, a_static);
  if (kDamped) Resist(n, s, i, n.v + 3 * static_cast<long long>(i), false, a);
  const bool absorbs = kQuiet && row >= 0 && n.quiet[row] >= 0;
  double absorbed[3] = {0, 0, 0};
  if (absorbs) QuietVelocity(n, s, i, row, a, absorbed);
  NodeSums sums = {};
  for (int k = 0; k < 3; ++k) {
    const double u = n.u[3 * static_cast<long long>(i) + k], before = n.v[3 * static_cast<long long>(i) + k];
    double after = absorbs ? absorbed[k] : s.keep * before + s.kick * a[k];
    double now = s.start ? before : 0.5 * (before + after);
    double earlier = s.start ? 2 * before - after : before;
    int kind = kFree;
    if (kRecords && row >= 0) {
      kind = (n.kind[row] >> (2 * k)) & 3;
      if (kind != kFree) {
        const double value = n.value[3 * row + k], *table = n.schedule + 3 * n.table[3 * row + k];
        after = PrescribedVelocity(kind, value, table, u, s.dt);
        if (s.start) earlier = kind == kVelocity ? value * table[0] : after;
        now = s.start ? earlier : 0.5 * (before + after);
      }
    }
    v_now[k] = now;
    sums.kinetic += 0.5 * mass * now * now;
    sums.half += 0.5 * mass * earlier * after;
    sums.form += 0.5 * mass * earlier * after + 0.5 * f_int[k] * u;
    sums.load_u += (mass * a_static[k] + f_int[k]) * u;
    sums.momentum[k] = mass * now;
    sums.v2 += now * now;
    sums.u2 += u * u;
    if (kind == kFree) {
      const double residual = sums.force[k] = mass * a_static[k];
      sums.residual += residual < 0 ? -residual : residual;
      sums.free += 1;
    }
  }
  return sums;
}

}  // namespace cdem
