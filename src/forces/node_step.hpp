// The contents of the loop over nodes: one central-difference step of a node.
#pragma once
#include "core/host_device.hpp"
#include "core/lanes.hpp"
#include "forces/quiet_node.hpp"
#include "forces/tables.hpp"

#include <cstdint>

namespace cdem {

/// The numbers of a step that are the same for all nodes. The kick is over h = (dt_old + dt) / 2:
/// v(n+1/2) = ((1 - alpha h/2) v(n-1/2) + h a) / (1 + alpha h/2).
struct StepArgs {
  double dt = 0, keep = 1, kick = 0;  ///< dt; (1 - alpha h/2)/(1 + alpha h/2); h/(1 + alpha h/2)
  double gravity[3] = {0, 0, 0};
  double local = 0;              ///< share of the force that opposes the motion (local damping)
  double alpha = 0, dt_old = 0;  ///< for the energy audit: damping by mass [1/s]; the step before [s], 0 at the start
  bool start = false;            ///< v holds v(0), not a half-step velocity

  bool operator==(const StepArgs &o) const {
    return dt == o.dt && keep == o.keep && kick == o.kick && start == o.start && gravity[0] == o.gravity[0] &&
           gravity[1] == o.gravity[1] && gravity[2] == o.gravity[2] && local == o.local && alpha == o.alpha &&
           dt_old == o.dt_old;
  }
};

/// Time at the end of step j of a batch [s]; the same number however the run is cut into batches.
CDEM_HD double StepEnd(double base, long long offset, int j, double dt) {
  return base + static_cast<double>(offset + j + 1) * dt;
}

/// Node data as pointers, host or device.
struct NodeView {
  int n_owned = 0;
  double *u = nullptr, *v = nullptr;     ///< [n_local][3]
  const double *inverse_mass = nullptr;  ///< [n_owned]
  const double *weight = nullptr;        ///< [n_owned] share of gravity, where masses are scaled; else NULL
  double *last = nullptr;       ///< [n_owned][3] acceleration of the step before, in combined damping; else NULL
  const int *record = nullptr;  ///< NULL without records
  const std::uint8_t *kind = nullptr;
  const double *value = nullptr;
  const int *table = nullptr;
  const int *load_start = nullptr, *load_table = nullptr;
  const double *load = nullptr;
  const std::uint8_t *load_wave = nullptr;  ///< of a wave that comes in
  const int *watch = nullptr;
  const int *quiet = nullptr;  ///< [n records] row of dashpot or -1; NULL where no node has dashpots
  const double *dashpot = nullptr;
  int n_tables = 1, n_watch = 0;
  const double *schedule = nullptr;  ///< [step][table][3]: at t_n, t_n + dt/2, t_n + dt
  double *history = nullptr;         ///< [step][slot][6]: u(n), v(n)
};

/// Component k of the acceleration of a node [m/s^2] from its internal force, loads at t_n and gravity.
template <bool kRecords, bool kDamped>
CDEM_HD double AccelerationOf(const NodeView &n, double gravity, int i, int row, int k, const double *now,
                              double inverse_mass, double f_int) {
  double f = -f_int;
  if (kRecords && row >= 0)
    for (int l = n.load_start[row]; l < n.load_start[row + 1]; ++l) f += n.load[3 * l + k] * now[3 * n.load_table[l]];
  if (kDamped && n.weight) return f * inverse_mass + gravity * n.weight[i];
  return f * inverse_mass + gravity;
}

/// All three of them.
template <bool kRecords, bool kDamped>
CDEM_HD void Acceleration(const NodeView &n, const StepArgs &s, int i, int row, const double *now, double inverse_mass,
                          const double f_int[3], double a[3]) {
  CDEM_UNROLL for (int k = 0; k < 3; ++k) a[k] =
      AccelerationOf<kRecords, kDamped>(n, s.gravity[k], i, row, k, now, inverse_mass, f_int[k]);
}

CDEM_HD double Sign(double x) { return x > 0 ? 1 : x < 0 ? -1 : 0; }

/// Local damping: a share of the force against the velocity (Cundall 1987). Combined: half of it against the velocity,
/// half against the change of the force, so that a steady motion is not held up (Itasca's manuals). [in,out] a: m/s^2.
CDEM_HD void Resist(const NodeView &n, const StepArgs &s, int i, const double v[3], bool commit, double a[3]) {
  for (int k = 0; k < 3; ++k) {
    const double size = a[k] < 0 ? -a[k] : a[k];
    double against = Sign(v[k]);
    if (n.last) {
      double *last = n.last + 3 * static_cast<long long>(i) + k;
      against = 0.5 * (against - Sign(a[k] - *last));
      if (commit) *last = a[k];
    }
    a[k] -= s.local * size * against;
  }
}

/// Velocity that a prescribed component has at half step, given what the table says.
CDEM_HD double PrescribedVelocity(int kind, double value, const double *table, double u, double dt) {
  return kind == kVelocity ? value * table[1] : (value * table[2] - u) / dt;
}

/// Component k of a node's next half-step velocity [m/s]. [in] row: its record or -1; now: its row of the schedule; a:
/// acceleration. [in,out] v_old: the last one; what it must have been, where the motion starts with its boundary.
template <bool kRecords>
CDEM_HD double VelocityOf(const NodeView &n, const StepArgs &s, int row, int k, const double *now, double a, double u,
                          double *v_old) {
  double v = s.keep * *v_old + s.kick * a;
  if (kRecords && row >= 0) {
    const int kind = (n.kind[row] >> (2 * k)) & 3;
    if (kind != kFree) {
      const double value = n.value[3 * row + k], *table = now + 3 * n.table[3 * row + k];
      v = PrescribedVelocity(kind, value, table, u, s.dt);
      // a component that starts with its boundary has the boundary's velocity at once
      if (s.start) *v_old = kind == kVelocity ? value * table[0] : v;
    }
  }
  return v;
}

/// Writes component k of a watched node at t_n. [in] step: row of the history.
CDEM_HD void WriteHistory(const NodeView &n, const StepArgs &s, int row, int k, int step, double u, double v_old,
                          double v) {
  if (n.watch[row] < 0) return;
  double *out = n.history + 6 * (static_cast<long long>(step) * n.n_watch + n.watch[row]);
  out[k] = u;
  out[3 + k] = s.start ? v_old : 0.5 * (v_old + v);
}

/// One central-difference step of node i; kQuiet: some of the records have dashpots; kDamped: there is local damping, or
/// masses are scaled. [in] step: row of schedule and history. Returns false when the velocity is not a finite number of
/// reasonable size.
template <bool kRecords, bool kQuiet = false, bool kDamped = false>
CDEM_HD bool NodeStep(const NodeView &n, const StepArgs &s, int i, int step, const double f_int[3]) {
  const int row = kRecords ? n.record[i] : -1;
  const double *now = kRecords ? n.schedule + 3 * static_cast<long long>(step) * n.n_tables : nullptr;
  const double inverse_mass = n.inverse_mass[i];
  double a[3], u[3], v_old[3], v[3];
  Acceleration<kRecords, kDamped>(n, s, i, row, now, inverse_mass, f_int, a);
  if (kDamped) Resist(n, s, i, n.v + 3 * static_cast<long long>(i), true, a);
  CDEM_UNROLL for (int k = 0; k < 3; ++k) {
    u[k] = n.u[3 * static_cast<long long>(i) + k];
    v_old[k] = n.v[3 * static_cast<long long>(i) + k];
    v[k] = VelocityOf<kRecords>(n, s, row, k, now, a[k], u[k], &v_old[k]);
  }
  if (kRecords && row >= 0) {
    if (kQuiet && n.quiet[row] >= 0)
      Absorb(n.dashpot + 6 * n.quiet[row], 0.5 * s.kick * inverse_mass, n.kind[row], v_old, v);
    for (int k = 0; k < 3; ++k) WriteHistory(n, s, row, k, step, u[k], v_old[k], v[k]);
  }
  CDEM_UNROLL for (int k = 0; k < 3; ++k) {
    n.v[3 * static_cast<long long>(i) + k] = v[k];
    n.u[3 * static_cast<long long>(i) + k] = u[k] + s.dt * v[k];
  }
  const double size = (v[0] < 0 ? -v[0] : v[0]) + (v[1] < 0 ? -v[1] : v[1]) + (v[2] < 0 ? -v[2] : v[2]);
  return size < 1e100;
}

}  // namespace cdem
