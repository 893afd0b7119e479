"""The acceleration of the sliding block: slope of its velocity over the last third of the run."""
import os
import sys

import numpy as np

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
import checks

GRAVITY, ANGLE, FRICTION = 9.81, np.radians(30), np.radians(20)


def acceleration():
    return GRAVITY * (np.sin(ANGLE) - np.cos(ANGLE) * np.tan(FRICTION))


def main():
    h = checks.histories(checks.folder())
    late = h["time"] > 2 / 3 * h["time"][-1]
    slope = np.polyfit(h["time"][late], h["velocity"][late], 1)[0]
    checks.report([("acceleration (m/s2)", acceleration(), slope, 1e-6)])


if __name__ == "__main__":
    main()
