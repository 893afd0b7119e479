"""Shear strength with random joints (folder OUT), with one plane joint (OUT_plane) and without (OUT_rock)."""
import os
import sys

import numpy as np

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
import checks

PRESSURE, RATE, START = 3.0, 9.0, 0.08      # MPa, MPa/s, s
ROCK, JOINT = (4.0, np.radians(40)), (0.2, np.radians(25))      # cohesion (MPa), friction
WINDOW = 0.01       # s, over which velocities are taken
FLOWS = 5           # times the elastic velocity
P32 = {"flat": 0.4, "steep": 0.2}


def rock():
    """Pure shear under a pressure from all sides: Mohr's circle about the pressure touches the line (MPa)."""
    return ROCK[0] * np.cos(ROCK[1]) + PRESSURE * np.sin(ROCK[1])


def joint():
    """The joint lies in the plane of the shear (MPa)."""
    return JOINT[0] + PRESSURE * np.tan(JOINT[1])


def shear(t):
    return RATE * (t - START)


def strength(h):
    """Shear stress at which the top runs FLOWS times as fast as while all is elastic (MPa)."""
    t, u = h["time"], h["top"]
    early = (shear(t) > 0.3) & (shear(t) < 1.2)
    elastic = np.polyfit(t[early], u[early], 1)[0]
    at = np.arange(START + 0.2 / RATE, t[-1] - WINDOW, 0.001)
    velocity = (np.interp(at + WINDOW / 2, t, u) - np.interp(at - WINDOW / 2, t, u)) / WINDOW
    fast = velocity > FLOWS * elastic
    return shear(at[np.argmax(fast)]) if fast.any() else np.nan


def main():
    out = checks.folder()
    middle, half = (rock() + joint()) / 2, (rock() - joint()) / 2
    rows = [
        ("strength without joints (MPa)", rock(), strength(checks.histories(out + "_rock")), 2e-2),
        ("strength with a plane joint (MPa)", joint(), strength(checks.histories(out + "_plane")), 2e-2),
        ("strength with random joints (MPa); exact: middle of the two, error: over half their distance", middle,
         strength(checks.histories(out)), 1, half),
    ]
    for found in checks.summary(out)["joints"]:     # half a disc of the largest diameter, 12 m, may be missing
        name = found["name"]
        rows.append((f"P32 of {name} (1/m)", P32[name], found["p32"], np.pi * 6**2 / 2 / 12**3 / P32[name]))
    checks.report(rows)


if __name__ == "__main__":
    main()
