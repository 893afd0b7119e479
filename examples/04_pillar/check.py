"""Stiffness of the jointed pillar and the load at which it fails, from the roof's way down."""
import os
import sys

import numpy as np

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
import checks

YOUNG, KN, KS, KN_SEAM = 1.0e10, 1.0e11, 4.0e10, 1.0e11
COHESION, FRICTION = 3.0e6, np.radians(30)
ROWS, HEIGHT, SLABS = 12, 12 * 0.5 * np.sqrt(3) / 2, 2.0
RATE = 20.0e6     # Pa/s


def main():
    h = checks.histories(checks.folder())
    p, u = RATE * h["time"], -h["roof"]
    compliance = ((HEIGHT + SLABS) / YOUNG + ROWS * (1 / (8 * KN) + 3 / (8 * KS)) + (ROWS - 1) / KN + 2 / KN_SEAM)
    elastic = (p > 3e6) & (p < 8e6)
    slope, offset = np.polyfit(p[elastic], u[elastic], 1)
    strength = 2 * COHESION * np.cos(FRICTION) / (1 - np.sin(FRICTION))
    # failure: the roof leaves the elastic line by 1 % of what it sank
    away = u - (offset + slope * p) > 0.01 * u
    failed = p[np.argmax(away & (p > 8e6))] if (away & (p > 8e6)).any() else np.nan
    checks.report([
        ("roof displacement per pressure (m/MPa)", 1e6 * compliance, 1e6 * slope, 2e-3),
        ("pressure at failure (MPa)", strength / 1e6, failed / 1e6, 1e-2),
    ])


if __name__ == "__main__":
    main()
