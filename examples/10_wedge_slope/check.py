"""Acceleration of the wedge with 20 degrees of friction (folder OUT), and whether it stays with 35 (OUT_35)."""
import os
import sys

import numpy as np

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
import checks

GRAVITY, PLUNGE, HALF = 9.81, np.radians(35), np.radians(55)
FRICTION = 20    # degrees


def safety(friction):
    """Resistance over driving force of the rigid wedge on both its joints; friction in degrees."""
    return np.tan(np.radians(friction)) / (np.sin(HALF) * np.tan(PLUNGE))


def acceleration(friction):
    return GRAVITY * np.sin(PLUNGE) * max(0, 1 - safety(friction))


def velocity(h):
    """Along the line in which the joints meet."""
    return h["x"] * np.cos(PLUNGE) - h["z"] * np.sin(PLUNGE)


def main():
    out = checks.folder()
    h, stays = checks.histories(out), checks.histories(out + "_35")
    late = h["time"] > 0.1
    slope = np.polyfit(h["time"][late], velocity(h)[late], 1)[0]
    rest = stays["time"] > 0.1
    checks.report([
        ("acceleration (m/s2), 20 degrees, factor of safety 0.635", acceleration(FRICTION), slope, 5e-3),
        ("factor of safety from it", safety(FRICTION), 1 - slope / GRAVITY / np.sin(PLUNGE), 5e-3),
        ("mean velocity (m/s) after 0.1 s, 35 degrees, factor of safety 1.22", 0, velocity(stays)[rest].mean(), 1e-2,
         velocity(h)[-1]),
    ])


if __name__ == "__main__":
    main()
