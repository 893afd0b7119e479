"""Slip of the wall on its foot against Newmark's sliding block."""
import os
import sys

import numpy as np

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
import checks

GRAVITY, FRICTION = 9.81, np.radians(12)
VELOCITY, FREQUENCY, DELAY = 0.4, 2.0, 0.2


def newmark(end, dt=1e-5):
    """Times and slips (wall minus plinth) of a rigid block on the shaken plinth."""
    limit = GRAVITY * np.tan(FRICTION)
    w = 2 * np.pi * FREQUENCY
    t = np.arange(0, end + dt, dt)
    base = np.where(t > DELAY, VELOCITY * np.sin(w * (t - DELAY)), 0.0)
    slip = np.zeros_like(t)
    v = 0.0
    for n in range(1, len(t)):
        v += np.clip(base[n] - v, -limit * dt, limit * dt)  # stick where the friction is enough
        slip[n] = slip[n - 1] + (v - base[n]) * dt
    return t, slip


def main():
    h = checks.histories(checks.folder())
    t, slip = newmark(h["time"][-1])
    exact = np.interp(h["time"], t, slip)
    computed = h["stone"] - h["plinth"]
    worst = np.argmax(abs(computed - exact))
    scale = abs(exact).max()
    checks.report([
        ("largest slip back (mm)", 1e3 * exact.min(), 1e3 * computed.min(), 3e-2),
        ("worst moment of the slip (mm)", 1e3 * exact[worst], 1e3 * computed[worst], 3e-2, 1e3 * scale),
        ("last slip (mm)", 1e3 * exact[-1], 1e3 * computed[-1], 3e-2, 1e3 * scale),
    ])


if __name__ == "__main__":
    main()
