// A step of central differences with an assembled stiffness, whose rows already hold dt^2 over the mass: a plain loop over
// 3x3 blocks, which the compiler sees whole; libraries go through a general block product. keep: what damping by mass
// leaves of a step's motion. which, drive: components that are set, and what they are after each step.
void steps(long n, long steps, double keep, const int *first, const int *column, const double *a, const double *load,
           long driven, const int *which, const double *drive, double *u, double *w) {
  for (long s = 0; s < steps; ++s) {
    for (long i = 0; i < n; ++i) {
      double x = 0, y = 0, z = 0;
      for (int k = first[i]; k < first[i + 1]; ++k) {
        const double *b = a + 9L * k, *q = u + 3L * column[k];
        x += b[0] * q[0] + b[1] * q[1] + b[2] * q[2];
        y += b[3] * q[0] + b[4] * q[1] + b[5] * q[2];
        z += b[6] * q[0] + b[7] * q[1] + b[8] * q[2];
      }
      double *v = w + 3 * i;
      const double *f = load + 3 * i;
      v[0] = keep * v[0] + (f[0] - x), v[1] = keep * v[1] + (f[1] - y), v[2] = keep * v[2] + (f[2] - z);
    }
    for (long i = 0; i < 3 * n; ++i) u[i] += w[i];
    for (long k = 0; k < driven; ++k) u[which[k]] = drive[s];
  }
}
