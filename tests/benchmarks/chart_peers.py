"""The peers on the chart: the assembled stiffness by a plain C loop, its direct solution, and Akantu."""
import ctypes
import subprocess
import time
from pathlib import Path

import numpy as np
import scipy.sparse as sparse
import scipy.sparse.linalg

import outside
import peer
from measure import Failed

ASSEMBLED, DIRECT, AKANTU = "assembled stiffness, 3x3 block CSR", "assembled stiffness, direct solution", "Akantu, malloc tuned"
LARGEST = 100_000   # hexahedra of a peer: beyond, assembling by numpy takes too much memory

# As in peer.py, with damping by mass and prescribed components.
LOOP = r"""
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
"""


def compiled(folder):
    source, library = Path(folder) / "loop.c", Path(folder) / "loop.so"
    source.write_text(LOOP)
    try:
        subprocess.run(["cc", "-O3", "-march=native", "-ffast-math", "-shared", "-fPIC", "-o", library, source], check=True)
    except (OSError, subprocess.CalledProcessError) as error:
        raise Failed(f"no C compiler for the assembled stiffness: {error}") from error
    return ctypes.CDLL(str(library)).steps


class Assembled:
    """One mesh's stiffness; the time of assembling it counts in the total alone."""

    def __init__(self, problem, folder):
        start = time.perf_counter()
        self.problem, self.loop = problem, compiled(folder)
        self.stiffness, self.mass = peer.stiffness(problem["points"], problem["cells"], problem)
        self.assembly = time.perf_counter() - start

    def step(self, steps):
        """Displacement at the end; wall and CPU time of the loop."""
        p = self.problem
        half = 0.5 * p.get("alpha", 0.0) * p["dt"]
        scale = p["dt"]**2 / (1 + half) * p["free"].ravel() / np.repeat(self.mass, 3)
        blocks = (sparse.diags(scale) @ self.stiffness).tobsr((3, 3))
        load = scale * p["force"].ravel()
        which, drive = p.get("driven", np.zeros(0, int)).astype(np.int32), np.ascontiguousarray(p.get("drive", np.zeros(steps + 1))[1:])
        first, column = (a.astype(np.int32) for a in (blocks.indptr, blocks.indices))
        u, w = np.zeros_like(load), -0.5 * (1 + half) * load  # at rest: the first step is half of one by the load
        pointer = lambda a: a.ctypes.data_as(ctypes.c_void_p)
        start, cpu = time.perf_counter(), time.process_time()
        self.loop(ctypes.c_long(len(u) // 3), ctypes.c_long(steps), ctypes.c_double((1 - half) / (1 + half)), pointer(first), pointer(column),
                  pointer(blocks.data), pointer(load), ctypes.c_long(len(which)), pointer(which), pointer(drive), pointer(u), pointer(w))
        solve, cpu = time.perf_counter() - start, time.process_time() - cpu
        return u.reshape(-1, 3), {"solve": solve, "cpu": cpu, "share": min(1.0, cpu / solve), "total": solve + self.assembly}

    def direct(self):
        """The static answer by SuperLU; it steps through nothing, and nothing may break in it."""
        p = self.problem
        free = p["free"].ravel()
        start, cpu = time.perf_counter(), time.process_time()
        u = np.zeros(len(free))
        u[free] = scipy.sparse.linalg.spsolve(self.stiffness[free][:, free].tocsc(), p["force"].ravel()[free])
        solve, cpu = time.perf_counter() - start, time.process_time() - cpu
        return u.reshape(-1, 3), {"solve": solve, "cpu": cpu, "share": min(1.0, cpu / solve), "total": solve + self.assembly}


def akantu(program, problem, steps, most):
    """Akantu over all steps, or over `most` of them and scaled. Its displacement then is that of another time: None."""
    n = min(steps, most)
    u, cost = program.run(problem, n)
    scaled = steps / n
    cost = {"solve": scaled * cost["solve"], "cpu": scaled * cost["solve_cpu"], "share": min(1.0, cost["solve_cpu"] / cost["solve"]),
            "total": cost["wall"] + (scaled - 1) * cost["solve"], "scaled_from": n if n < steps else None}
    return (u if n == steps else None), cost


def find_akantu(folder, python):
    try:
        return outside.Akantu(folder, python)
    except Failed as error:
        print(error, flush=True)
        return None
