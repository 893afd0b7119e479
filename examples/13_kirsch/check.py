"""Hoop stress and closure along the wall of the hole against Kirsch's solution. Needs h5py."""
import os
import sys

import numpy as np

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
import checks

SHEAR, POISSON, RADIUS = 300e6, 0.25, 0.1
SX, SY, PRESSURE = 11.25e6, 9e6, 2e6    # compression positive
CELLS = 16                              # round a quarter of the wall


def hoop(t):
    """Hoop stress at the wall, at the angle t from x (Pa, compression positive)."""
    return SX + SY - 2 * (SX - SY) * np.cos(2 * t) - PRESSURE


def closure(t):
    """Movement of the wall towards the centre (m)."""
    return RADIUS / (2 * SHEAR) * ((SX + SY) / 2 - PRESSURE + (SX - SY) / 2 * (3 - 4 * POISSON) * np.cos(2 * t))


def wall_hoop(out):
    """Angles of the cells round the wall and the hoop stress there: a parabola through the three innermost cells."""
    points, cells, _, data = checks.frame(out)
    rock = data["region"] == 0
    centre, (xx, yy, _, xy, _, _) = points[cells[rock]].mean(axis=1), data["stress"][rock].T
    r, t = np.hypot(centre[:, 0], centre[:, 1]), np.arctan2(centre[:, 1], centre[:, 0])
    stress = -(xx * np.sin(t) ** 2 + yy * np.cos(t) ** 2 - xy * np.sin(2 * t))
    sector, found = np.floor(t / (np.pi / 2 / CELLS)), []
    for k in range(CELLS):
        three = np.flatnonzero(sector == k)[np.argsort(r[sector == k])[:3]]
        found.append(np.polyval(np.polyfit(r[three] - RADIUS, stress[three], 2), 0))
    return (np.arange(CELLS) + 0.5) * np.pi / 2 / CELLS, np.array(found)


def wall_closure(out):
    """Angles of the wall's nodes and their closure."""
    points, _, data, _ = checks.frame(out)
    wall = abs(np.hypot(points[:, 0], points[:, 1]) / RADIUS - 1) < 1e-6
    (x, y), (u, v) = points[wall, :2].T, data["displacement"][wall, :2].T
    order = np.argsort(np.arctan2(y, x))
    return np.arctan2(y, x)[order], (-(u * x + v * y) / RADIUS)[order]


def worst(exact, computed, tolerance):
    """Where the error is largest, as the end of a row; relative to the largest exact value."""
    at = np.argmax(abs(computed - exact))
    return exact[at], computed[at], tolerance, max(exact)


def main():
    out = checks.folder()
    (t, stress), (s, inward) = wall_hoop(out), wall_closure(out)
    stages = checks.summary(out)["stages"]
    h = checks.histories(out)
    dug = int(np.flatnonzero(h["step"] == stages[0]["steps"])[-1])
    checks.report([
        ("hoop stress, worst place of the wall (Pa)", *worst(hoop(t), stress, 1e-2)),
        ("closure, worst node of the wall (m)", *worst(closure(s), inward, 5e-3)),
        ("closure at the side (m)", closure(0), -h["side"][-1], 5e-3),
        ("closure at the crown (m)", closure(np.pi / 2), -h["crown"][-1], 5e-3),
        ("movement of the side before the hole is dug (m); error: over its closure", 0, h["side"][dug], 1e-12, closure(0)),
    ], [("both stages end in balance", all(stage["balanced"] for stage in stages))])


if __name__ == "__main__":
    main()
