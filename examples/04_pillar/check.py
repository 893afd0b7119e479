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


def compliance():
    """Sinking of the roof per pressure while the pillar is whole (m/Pa)."""
    joints = ROWS * (1 / (8 * KN) + 3 / (8 * KS)) + (ROWS - 1) / KN + 2 / KN_SEAM
    return (HEIGHT + SLABS) / YOUNG + joints


def strength():
    """Mohr-Coulomb: joints at 60 = 45 + phi/2 degrees to the horizontal (Pa)."""
    return 2 * COHESION * np.cos(FRICTION) / (1 - np.sin(FRICTION))


def main():
    h = checks.histories(checks.folder())
    p, u = RATE * h["time"], -h["roof"]
    elastic = (p > 3e6) & (p < 8e6)
    slope, offset = np.polyfit(p[elastic], u[elastic], 1)
    # failure: the roof leaves the elastic line by 1 % of what it sank
    away = (u - (offset + slope * p) > 0.01 * u) & (p > 8e6)
    failed = p[np.argmax(away)] if away.any() else np.nan
    checks.report([
        ("roof displacement per pressure (mm/MPa)", 1e9 * compliance(), 1e9 * slope, 2e-3),
        ("pressure at failure (MPa)", strength() / 1e6, failed / 1e6, 1e-2),
    ])


if __name__ == "__main__":
    main()
