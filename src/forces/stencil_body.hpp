// What a step does to a node, or to the nodes of lanes, in the way of stencils.
#pragma once
#include "forces/node_step.hpp"

namespace cdem {

/// Adds what a neighbour's displacement, with that of damping, does to the internal force.
template <class T>
CDEM_HD void AddCoupling(const double *block, T x, T y, T z, T f[3]) {
  CDEM_UNROLL for (int k = 0; k < 3; ++k) f[k] += block[3 * k] * x;
  CDEM_UNROLL for (int k = 0; k < 3; ++k) f[k] += block[3 * k + 1] * y;
  CDEM_UNROLL for (int k = 0; k < 3; ++k) f[k] += block[3 * k + 2] * z;
}

/// Moves nodes without records. [in,out] u, v: m, half-step m/s.
template <class T>
CDEM_HD void MoveFree(const StepArgs &s, double inverse_mass, const T f[3], T u[3], T v[3]) {
  CDEM_UNROLL for (int k = 0; k < 3; ++k) {
    v[k] = s.keep * v[k] + s.kick * (s.gravity[k] - f[k] * inverse_mass);
    u[k] = u[k] + s.dt * v[k];
  }
}

/// Moves a node with records. [in] step: row of schedule and history.
CDEM_HD void MoveRecorded(const NodeView &n, const StepArgs &s, int row, int step, double inverse_mass,
                          const double f[3], double u[3], double v[3]) {
  const double *now = n.schedule + 3 * static_cast<long long>(step) * n.n_tables;
  CDEM_UNROLL for (int k = 0; k < 3; ++k) {
    const double a = AccelerationOf<true, false>(n, s.gravity[k], -1, row, k, now, inverse_mass, f[k]);
    double v_old = v[k];
    v[k] = VelocityOf<true>(n, s, row, k, now, a, u[k], &v_old);
    WriteHistory(n, s, row, k, step, u[k], v_old, v[k]);
    u[k] += s.dt * v[k];
  }
}

}  // namespace cdem
