"""Amplification by the soil, at four frequencies and as a history."""
import os
import sys

import numpy as np

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
import checks

WAVE, FREQUENCY, DELAY = 0.1, 5.0, 0.4              # m/s, Hz, s: what comes in at the base
ROCK, SOIL = (2200.0, 800.0, 20.0), (1800.0, 200.0, 20.0)   # density, c_s, thickness
RATIO = SOIL[0] * SOIL[1] / (ROCK[0] * ROCK[1])     # of the impedances
UP = ROCK[2] / ROCK[1] + SOIL[2] / SOIL[1]          # s, from the base to the top


def incoming(t):
    return WAVE * checks.ricker(t, FREQUENCY, DELAY)


def amplification(f):
    """Velocity of the top over that of the wave that comes in."""
    k_h = 2 * np.pi * f * SOIL[2] / SOIL[1]
    return 2 / np.abs(np.cos(k_h) + 1j * RATIO * np.sin(k_h))


def top(t):
    """Velocity of the top: the first arrival and the echoes between the surface and the rock."""
    back = -(1 - RATIO) / (1 + RATIO)
    return sum(4 / (1 + RATIO) * back**n * incoming(t - UP - 2 * n * SOIL[2] / SOIL[1]) for n in range(80))


def measured(h, f):
    """The same from the histories, by Fourier sums."""
    t = h["time"]
    sums = [np.array([np.sum(v * np.exp(-2j * np.pi * x * t)) for x in np.atleast_1d(f)]) for v in (h["top"], incoming(t))]
    return np.abs(sums[0] / sums[1])


def main():
    h = checks.histories(checks.folder())
    t, rows = h["time"], []
    for f in (1.25, 2.5, 5.0, 7.5):
        rows.append((f"amplification at {f:g} Hz", amplification(f), measured(h, f)[0], 1e-2))
    first = t < DELAY + UP + SOIL[2] / SOIL[1]
    rows.append(("first arrival on top (m/s)", 4 / (1 + RATIO) * WAVE, np.max(h["top"][first]), 1e-2))
    size = np.sqrt(np.mean(top(t) ** 2))
    rows.append(("mean difference of the top's history (m/s); error: over its mean size", 0.0,
                 np.sqrt(np.mean((h["top"] - top(t)) ** 2)), 1e-2, size))
    rows.append(("velocity of the top at the end (m/s); error: over v_in", 0.0, abs(h["top"][-1]), 1e-3, WAVE))
    checks.report(rows)


if __name__ == "__main__":
    main()
