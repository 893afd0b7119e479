"""The pulse on its way up, far from tunnel and fault, against the plane wave that was sent; and the fault is part broken."""
import os
import sys

import numpy as np

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
import checks

YOUNG, POISSON, DENSITY = 2.0e10, 0.25, 2600.0
FREQUENCY, DELAY, VELOCITY = 60.0, 0.025, 0.5
RISE = 14.0       # m from the bottom to the history point
UNTIL = 0.0350    # s; the first echoes from tunnel and fault come later


def main():
    out = checks.folder()
    h = checks.histories(out)
    s = checks.summary(out)
    c = np.sqrt(YOUNG * (1 - POISSON) / ((1 + POISSON) * (1 - 2 * POISSON)) / DENSITY)
    early = h["time"] <= UNTIL
    t, v = h["time"][early], h["rock"][early]
    exact = VELOCITY * checks.ricker(t - RISE / c, FREQUENCY, DELAY)
    worst = np.argmax(abs(v - exact))
    p = np.argmax(v)  # peak by a parabola through three points
    d = (v[p - 1] - v[p + 1]) / (2 * (v[p - 1] - 2 * v[p] + v[p + 1]))
    checks.report([
        ("travel time of the peak (s)", RISE / c, t[p] + d * (t[1] - t[0]) - DELAY, 3e-2),
        ("peak velocity (m/s)", VELOCITY, v[p], 3e-2),
        ("worst moment of the pulse (m/s)", exact[worst], v[worst], 3e-2, VELOCITY),
    ], [("part of the fault is broken", 0 < s["broken_springs"] < s["springs"])])


if __name__ == "__main__":
    main()
