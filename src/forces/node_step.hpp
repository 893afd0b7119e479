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
  double local = 0;    ///< share of the force that opposes the motion (local damping)
  bool start = false;  ///< v holds v(0), not a half-step velocity

  bool operator==(const StepArgs &o) const {
    return dt == o.dt && keep == o.keep && kick == o.kick && start == o.start && gravity[0] == o.gravity[0] &&
           gravity[1] == o.gravity[1] && gravity[2] == o.gravity[2] && local == o.local;
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
  const int *watch = nullptr;
  const int *quiet = nullptr;  ///< [n records] row of dashpot or -1; NULL where no node has dashpots
  const double *dashpot = nullptr;
  int n_tables = 1, n_watch = 0;
  const double *schedule = nullptr;  ///< [step][table][3]: at t_n, t_n + dt/2, t_n + dt
  double *history = nullptr;         ///< [step][slot][6]: u(n), v(n)
};

/// Acceleration of a node [m/s^2] from its internal force, loads at t_n and gravity.
template <bool kRecords, bool kDamped>
CDEM_HD void Acceleration(const NodeView &n, const StepArgs &s, int i, int row, const double *now,
                          const double f_int[3], double a[3]) {
  double f[3] = {-f_int[0], -f_int[1], -f_int[2]};
  if (kRecords && row >= 0)
    for (int l = n.load_start[row]; l < n.load_start[row + 1]; ++l)
      for (int k = 0; k < 3; ++k) f[k] += n.load[3 * l + k] * now[3 * n.load_table[l]];
  const double inverse_mass = n.inverse_mass[i];
  if (kDamped && n.weight) {
    CDEM_UNROLL for (int k = 0; k < 3; ++k) a[k] = f[k] * inverse_mass + s.gravity[k] * n.weight[i];
  } else {
    CDEM_UNROLL for (int k = 0; k < 3; ++k) a[k] = f[k] * inverse_mass + s.gravity[k];
  }
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

/// One central-difference step of node i; kQuiet: some of the records have dashpots; kDamped: there is local damping, or
/// masses are scaled. [in] step: row of schedule and history. Returns false when the velocity is not a finite number of
/// reasonable size.
template <bool kRecords, bool kQuiet = false, bool kDamped = false>
CDEM_HD bool NodeStep(const NodeView &n, const StepArgs &s, int i, int step, const double f_int[3]) {
  const int row = kRecords ? n.record[i] : -1;
  const double *now = kRecords ? n.schedule + 3 * static_cast<long long>(step) * n.n_tables : nullptr;
  double a[3], u[3], v_old[3], v[3];
  Acceleration<kRecords, kDamped>(n, s, i, row, now, f_int, a);
  if (kDamped) Resist(n, s, i, n.v + 3 * static_cast<long long>(i), true, a);
  CDEM_UNROLL for (int k = 0; k < 3; ++k) {
    u[k] = n.u[3 * static_cast<long long>(i) + k];
    v_old[k] = n.v[3 * static_cast<long long>(i) + k];
    v[k] = s.keep * v_old[k] + s.kick * a[k];
  }
  if (kRecords && row >= 0) {
    for (int k = 0; k < 3; ++k) {
      const int kind = (n.kind[row] >> (2 * k)) & 3;
      if (kind == kFree) continue;
      const int table = n.table[3 * row + k];
      v[k] = PrescribedVelocity(kind, n.value[3 * row + k], now + 3 * table, u[k], s.dt);
      // a component that starts with its boundary has the boundary's velocity at once
      if (s.start) v_old[k] = kind == kVelocity ? n.value[3 * row + k] * now[3 * table] : v[k];
    }
    if (kQuiet && n.quiet[row] >= 0)
      Absorb(n.dashpot + 6 * n.quiet[row], 0.5 * s.kick * n.inverse_mass[i], n.kind[row], v_old, v);
    if (n.watch[row] >= 0) {
      double *out = n.history + 6 * (static_cast<long long>(step) * n.n_watch + n.watch[row]);
      for (int k = 0; k < 3; ++k) {
        out[k] = u[k];
        out[3 + k] = s.start ? v_old[k] : 0.5 * (v_old[k] + v[k]);
      }
    }
  }
  CDEM_UNROLL for (int k = 0; k < 3; ++k) {
    n.v[3 * static_cast<long long>(i) + k] = v[k];
    n.u[3 * static_cast<long long>(i) + k] = u[k] + s.dt * v[k];
  }
  const double size = (v[0] < 0 ? -v[0] : v[0]) + (v[1] < 0 ? -v[1] : v[1]) + (v[2] < 0 ? -v[2] : v[2]);
  return size < 1e100;
}

}  // namespace cdem
