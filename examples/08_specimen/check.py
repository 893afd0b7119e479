"""Stiffness and strength of the specimen at three confining pressures: folder OUT, OUT_2, OUT_5."""
import os
import sys

import numpy as np

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
import checks

YOUNG, COHESION, FRICTION = 1.0e10, 3.0e6, np.radians(40)
CELL = 0.05         # m, upper half of the load cell
GAUGE = 0.15        # m, from the base to the history head
RUNS = {"": 0.0, "_2": 2.0e6, "_5": 5.0e6}     # folder's end, confining pressure (Pa)
CONFINED = 0.003    # s, the axial load begins


def strength(pressure):
    """Mohr-Coulomb (Pa)."""
    s, c = np.sin(FRICTION), np.cos(FRICTION)
    return (2 * COHESION * c + (1 + s) * pressure) / (1 - s)


def axial(h):
    """Axial strain and stress, positive in compression (Pa)."""
    return -h["head"] / GAUGE, YOUNG * (h["middle"] - h["top"]) / CELL


def main():
    out, rows = checks.folder(), []
    for end, pressure in RUNS.items():
        h = checks.histories(out + end)
        strain, stress = axial(h)
        if not pressure:
            part = (stress > 0.2 * strength(0)) & (stress < 0.6 * strength(0)) & (h["time"] < 0.01)
            slope = np.polyfit(strain[part], stress[part], 1)[0]
            rows.append(("Young's modulus (GPa)", YOUNG / 1e9, slope / 1e9, 2e-2))
        rows.append((f"strength at {pressure / 1e6:g} MPa (MPa)", strength(pressure) / 1e6, stress[-1] / 1e6, 1e-3))
    checks.report(rows)


if __name__ == "__main__":
    main()
