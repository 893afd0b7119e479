"""The peers on the chart: the assembled stiffness by a plain C loop, its direct solution, and Akantu."""
import time

import numpy as np
import scipy.sparse as sparse
import scipy.sparse.linalg

import block_csr
import outside
import peer
from measure import Failed

ASSEMBLED, DIRECT, AKANTU = "assembled stiffness, 3x3 block CSR", "assembled stiffness, direct solution", "Akantu, malloc tuned"
LARGEST = 100_000   # hexahedra of a peer: beyond, assembling by numpy takes too much memory


class Assembled:
    """One mesh's stiffness; the time of assembling it counts in the total alone."""

    def __init__(self, problem, folder):
        start = time.perf_counter()
        self.problem, self.loop = problem, block_csr.loop(folder)
        self.stiffness, self.mass = peer.stiffness(problem["points"], problem["cells"], problem)
        self.assembly = time.perf_counter() - start

    def step(self, steps):
        """Displacement at the end; wall and CPU time of the loop."""
        p = self.problem
        half = 0.5 * p.get("alpha", 0.0) * p["dt"]
        scale = p["dt"]**2 / (1 + half) * p["free"].ravel() / np.repeat(self.mass, 3)
        blocks = (sparse.diags(scale) @ self.stiffness).tobsr((3, 3))
        load = scale * p["force"].ravel()
        which, drive = p.get("driven", ()), p.get("drive", np.zeros(1))[1:]
        u, w = np.zeros_like(load), -0.5 * (1 + half) * load  # at rest: the first step is half of one by the load
        start, cpu = time.perf_counter(), time.process_time()
        self.loop(blocks, steps, load, u, w, (1 - half) / (1 + half), which, drive)
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
