"""Closure of the tunnel and the wave: with joints that hold (OUT_whole) against closed forms, with joints that slip (OUT)."""
import os
import sys

import numpy as np

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
import checks

SHEAR, POISSON, DENSITY, RADIUS = 4e9, 0.25, 2600.0, 3.0
SX, SZ = 1.91295e6, 3.8259e6    # at the axis, compression
FREQUENCY, DELAY, VELOCITY, RISE = 25.0, 0.06, 0.5, 15.0    # wave; m from the base to the history rock


def closure(vertical):
    """Kirsch: by how much opposite walls approach (m)."""
    sign = -1 if vertical else 1
    return RADIUS / SHEAR * ((SX + SZ) / 2 + sign * (SX - SZ) / 2 * (3 - 4 * POISSON))


def ends(out):
    """Rows of histories.csv at which the stages end."""
    steps = np.cumsum([stage["steps"] for stage in checks.summary(out)["stages"]])
    return [int(np.flatnonzero(checks.histories(out)["step"] == step)[-1]) for step in steps]


def walls(h):
    """Approach of the side walls, and of crown and invert (m)."""
    return h["left"] - h["right"], h["invert"] - h["crown"]


def wave(out):
    """Time since the stage began (s) and velocity of the rock (m/s) while the wave passes."""
    h, first = checks.histories(out), ends(out)[2] + 1
    return h["time"][first:], h["rock"][first:]


def main():
    out = checks.folder()
    rows, dug = [], {}
    for end in ("_whole", ""):
        h, (insitu, equilibrium, dig, _) = checks.histories(out + end), ends(out + end)
        side, height = walls(h)
        dug[end] = (SX * side[dig] + SZ * height[dig]) / (SX + SZ)
        if end:
            rows += [("joints that hold: closure of the sides (m)", closure(False), side[dig], 1e-2),
                     ("joints that hold: closure of the height (m)", closure(True), height[dig], 1e-2)]
            t, v = wave(out + end)
            peak = np.argmax(v)
            rows += [("joints that hold: peak of the wave (m/s)", VELOCITY, v[peak], 3e-2),
                     ("joints that hold: travel time (s)", RISE / np.sqrt(SHEAR / DENSITY), t[peak] - DELAY, 3e-2)]
        else:
            rows.append(("joints that slip: movement before the tunnel is dug (m); error: over the closure", 0,
                         max(abs(height[insitu]), abs(height[equilibrium])), 1e-9, closure(True)))
    stages = checks.summary(out)["stages"]
    broken = [stage["broken_springs"] for stage in stages]
    ratio = max(stage["unbalanced_ratio"] for stage in stages[:3])
    rows.append(("joints that slip: unbalanced ratio, largest at the end of a relaxation; error: itself", 0, ratio, 1e-7, 1))
    checks.report(rows, [
        (f"closure, weighted: {1e3 * dug['']:.4g} mm with joints that slip, {1e3 * dug['_whole']:.4g} mm with joints that hold",
         1.01 * dug["_whole"] < dug[""] < 1.5 * dug["_whole"]),
        (f"broken springs at the ends of the stages: {broken}: none before the tunnel is dug, and growing from then on",
         broken[0] == broken[1] == 0 and 0 < broken[2] < broken[3])])


if __name__ == "__main__":
    main()
