"""The weight above goes through abutments and pillars, stage by stage; pillar stress and broken springs. Needs h5py."""
import os
import sys

import numpy as np

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
import checks

PRESSURE, WEIGHT, WIDTH, ROOF = 1.2289968e7, 2700 * 9.81, 110.0, 36.0     # Pa on top, Pa/m, m, m
STOPE, PILLAR, HEIGHT = 8.0, 6.0, 6.0                                     # widths; half the height of the stopes (m)
PILLARS, STOPES = 1, {"second": 3, "third": 4, "first": 2, "fourth": 5}   # numbers of regions
VIRGIN = PRESSURE + WEIGHT * ROOF                                         # at mid-height (Pa)


def state(out, number):
    """Of the cells of a frame: centres x and z, size along x and z (m), region, vertical compression (Pa)."""
    points, cells, _, data = checks.frame(out, number)
    corners = points[cells]
    centre, size = corners.mean(axis=1), np.ptp(corners, axis=1)
    return centre[:, 0], centre[:, 2], size[:, 0], size[:, 2], data["region"], -data["stress"][:, 2]


def layers(out, number, gone):
    """Of every layer of cells between floor and roof: load above its middle and force through it (N, 1 m thick)."""
    x, z, width, height, region, stress = state(out, number)
    left = ~np.isin(region, gone)
    found = []
    for level in np.unique(z[abs(z) < HEIGHT].round(6)):
        here = left & (abs(z - level) < 1e-3)
        load = PRESSURE * WIDTH + WEIGHT * ((ROOF - level) * WIDTH - (HEIGHT - level) * STOPE * len(gone))
        found.append((load, np.sum((stress * width)[here])))
    return np.array(found).T


def pillar_stress(out, number):
    """Mean vertical compression of the three pillars (Pa)."""
    region, stress = state(out, number)[4:]
    return stress[region == PILLARS].mean()


def main():
    out = checks.folder()
    stages = checks.summary(out)["stages"]
    rows, gone, pillars = [], [], []
    for number, stage in enumerate(stages):
        gone += [STOPES[stage["name"]]] if number else []
        load, force = layers(out, number + 1, gone)
        worst = np.argmax(abs(force / load - 1))
        rows.append((f"{stage['name']}: force through the worst of 12 layers (N)", load[worst], force[worst], 1e-6))
        pillars.append(pillar_stress(out, number + 1))
    rows.append(("mean stress of the pillars at the start (Pa)", VIRGIN, pillars[0], 1e-9))
    rows.append(("unbalanced ratio, largest at the end of a stage; error: itself", 0,
                 max(stage["unbalanced_ratio"] for stage in stages), 1e-7, 1))
    broken = [stage["broken_springs"] for stage in stages]
    tributary = VIRGIN * (STOPE + PILLAR) / PILLAR
    checks.report(rows, [
        (f"mean stress of the pillars, MPa: {[round(p / 1e6, 2) for p in pillars]}: growing, below {tributary / 1e6:.2f} of the "
         "tributary area", all(np.diff(pillars) > 0) and pillars[-1] < tributary),
        (f"broken springs: {broken}: none at first, and growing", broken[0] == 0 and all(np.diff(broken) > 0))])


if __name__ == "__main__":
    main()
