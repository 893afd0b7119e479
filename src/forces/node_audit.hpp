// The work that a kick does at a node, term by term, for the energy audit; host and device.
#pragma once
#include "forces/audit.hpp"
#include "forces/node_step.hpp"

namespace cdem {

/// Where the work of a node goes: [kNodeWorks][n_owned], [kRowWorks][rows].
struct NodeWorks {
  double *node = nullptr, *row = nullptr;
  int rows = 0;
};

/// Adds what the kick of NodeStep does with these arguments, to be called before it. A force does half of its work over
/// the step before the kick and half over the step after it. [in] mass: kg; f_int: as for NodeStep; last: only the first
/// half, as of the time of the kick.
template <bool kRecords, bool kQuiet, bool kDamped>
CDEM_HD void AuditNode(const NodeView &n, const StepArgs &s, int i, int step, double mass, const double f_int[3],
                       bool last, const NodeWorks &works) {
  const int row = kRecords ? n.record[i] : -1;
  if (row < 0 && s.alpha == 0 && !kDamped) return;
  const double *now = kRecords ? n.schedule + 3 * static_cast<long long>(step) * n.n_tables : nullptr;
  double a[3], resisted[3], v_old[3], v[3], path[3], mean[3];
  Acceleration<kRecords, kDamped>(n, s, i, row, now, n.inverse_mass[i], f_int, a);
  for (int k = 0; k < 3; ++k) {
    resisted[k] = a[k];
    v_old[k] = n.v[3 * static_cast<long long>(i) + k];
  }
  if (kDamped) Resist(n, s, i, n.v + 3 * static_cast<long long>(i), false, resisted);
  for (int k = 0; k < 3; ++k) v[k] = s.keep * v_old[k] + s.kick * resisted[k];
  bool prescribed[3] = {false, false, false};
  const bool absorbs = kQuiet && row >= 0 && n.quiet[row] >= 0;
  if (row >= 0) {
    for (int k = 0; k < 3; ++k) {
      const int kind = (n.kind[row] >> (2 * k)) & 3;
      if (kind == kFree) continue;
      prescribed[k] = true;
      const double value = n.value[3 * row + k], *table = now + 3 * n.table[3 * row + k];
      v[k] = PrescribedVelocity(kind, value, table, n.u[3 * static_cast<long long>(i) + k], s.dt);
      if (s.start) v_old[k] = kind == kVelocity ? value * table[0] : v[k];
    }
    if (absorbs) Absorb(n.dashpot + 6 * n.quiet[row], 0.5 * s.kick * n.inverse_mass[i], n.kind[row], v_old, v);
  }
  double alpha = 0, local = 0;
  for (int k = 0; k < 3; ++k) {
    path[k] = 0.5 * (s.dt_old * v_old[k] + (last ? 0 : s.dt) * v[k]);
    mean[k] = 0.5 * (v_old[k] + v[k]);
    if (prescribed[k]) continue;
    alpha += s.alpha * mass * mean[k] * path[k];
    if (kDamped) local += mass * (a[k] - resisted[k]) * path[k];
  }
  works.node[static_cast<long long>(kAlpha) * n.n_owned + i] += alpha;
  if (kDamped) works.node[static_cast<long long>(kLocal) * n.n_owned + i] += local;
  if (row < 0) return;

  double dash[3] = {0, 0, 0}, load[3] = {0, 0, 0}, quiet = 0, given = 0, wave = 0, motion = 0;
  if (absorbs) Apply(n.dashpot + 6 * n.quiet[row], mean, dash);
  for (int l = n.load_start[row]; l < n.load_start[row + 1]; ++l)
    for (int k = 0; k < 3; ++k) {
      const double force = n.load[3 * l + k] * now[3 * n.load_table[l]];
      load[k] += force;
      (n.load_wave[l] ? wave : given) += force * path[k];
    }
  const double weight = kDamped && n.weight ? mass * n.weight[i] : mass;
  for (int k = 0; k < 3; ++k) {
    quiet += dash[k] * path[k];
    if (!prescribed[k]) continue;
    // the reaction: it accelerates the node and holds against all other forces
    const double gain = 0.5 * mass * (v[k] - v_old[k]);
    motion += (f_int[k] + dash[k] - load[k] - weight * s.gravity[k]) * path[k] +
              gain * ((s.start ? 0 : v_old[k]) + (last ? 0 : v[k]));
  }
  works.row[static_cast<long long>(kQuietWork) * works.rows + row] += quiet;
  works.row[static_cast<long long>(kLoadWork) * works.rows + row] += given;
  works.row[static_cast<long long>(kWaveWork) * works.rows + row] += wave;
  works.row[static_cast<long long>(kMotionWork) * works.rows + row] += motion;
}

}  // namespace cdem
