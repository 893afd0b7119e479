"""The brick against the exact solution of its discrete equations, by modes of an independently assembled stiffness.

A linear scene stepped by central differences from rest under a constant load moves, in every mode, as
q_s (1 - cos(n theta)) with sin(theta/2) = w dt/2. A quarter of the brick is enough: two planes of symmetry."""
import itertools
import os
import sys

import numpy as np

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
import checks

YOUNG, POISSON, DENSITY, GRAVITY, H = 1.0e10, 0.25, 2500.0, 9.81, 1.0
CELLS = (5, 5, 10)  # the quarter x > 5, y > 5


def element_stiffness():
    """24 x 24 stiffness of a cube of edge H, 2 x 2 x 2 Gauss points, corners in binary order x + 2 y + 4 z."""
    la = YOUNG * POISSON / ((1 + POISSON) * (1 - 2 * POISSON))
    mu = YOUNG / (2 * (1 + POISSON))
    d = np.diag([2 * mu] * 3 + [mu] * 3)
    d[:3, :3] += la
    s = np.array([[2 * (c >> a & 1) - 1 for a in range(3)] for c in range(8)], float)
    k = np.zeros((24, 24))
    for p in itertools.product((-1 / np.sqrt(3), 1 / np.sqrt(3)), repeat=3):
        t = 1 + s * np.array(p)
        g = np.stack([s[:, a] * t[:, (a + 1) % 3] * t[:, (a + 2) % 3] for a in range(3)], 1) / 8 * 2 / H
        b = np.zeros((6, 24))
        for a in range(3):
            b[a, a::3] = g[:, a]
            q = (a + 1) % 3
            b[3 + a, a::3] += g[:, q]
            b[3 + a, q::3] += g[:, a]
        k += b.T @ d @ b * (H / 2) ** 3
    return k


def exact(steps, dt):
    """Vertical displacement of the middle of the top at the given step numbers."""
    n = np.array(CELLS) + 1
    number = np.arange(n.prod()).reshape(n[2], n[1], n[0])
    ke = element_stiffness()
    k = np.zeros((3 * n.prod(),) * 2)
    m = np.zeros(n.prod())
    for z, y, x in itertools.product(*(range(c) for c in CELLS[::-1])):
        c = number[z:z + 2, y:y + 2, x:x + 2].ravel()
        dof = (3 * c[:, None] + np.arange(3)).ravel()
        k[np.ix_(dof, dof)] += ke
        m[c] += DENSITY * H**3 / 8
    free = np.ones((n.prod(), 3), bool)
    free[number[0].ravel()] = False           # bottom
    free[number[:, :, 0].ravel(), 0] = False  # symmetry at x = 5 and y = 5
    free[number[:, 0, :].ravel(), 1] = False
    load = np.zeros((n.prod(), 3))
    load[:, 2] = -m * GRAVITY
    top = np.flatnonzero(np.flatnonzero(free.ravel()) == 3 * number[-1, 0, 0] + 2)[0]
    free = free.ravel()
    root = np.sqrt(np.repeat(m, 3)[free])
    w2, v = np.linalg.eigh(k[np.ix_(free, free)] / root[:, None] / root)
    static = v[top] / root[top] * (v.T @ (load.ravel()[free] / root)) / w2
    theta = 2 * np.arcsin(np.sqrt(w2) * dt / 2)
    keep = abs(static) > 1e-20 * abs(static).max()
    return np.array([static[keep] @ (1 - np.cos(s * theta[keep])) for s in steps]), static.sum()


def main():
    out = checks.folder()
    h = checks.histories(out)
    s = checks.summary(out)
    u, static = exact(h["step"], s["dt"])
    worst = np.argmax(abs(h["top"] - u))
    checks.report([
        ("deepest point of the top (m)", u.min(), h["top"].min(), 1e-8),
        ("worst moment of the history (m)", u[worst], h["top"][worst], 1e-8, abs(u).max()),
        ("mean over the history (m)", u.mean(), h["top"].mean(), 1e-8),
    ])


if __name__ == "__main__":
    main()
