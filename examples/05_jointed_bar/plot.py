"""Transmission and reflection over frequency."""
import os
import sys

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
import check
import checks


def draw(axes, out):
    h = checks.histories(out)
    import numpy as np
    f = np.linspace(10, 125, 200)
    x = 2 * np.pi * f * check.impedance() / (2 * check.KN)
    transmitted, reflected = check.ratios(h, 2 * np.pi * f)
    axes.plot(f, transmitted, lw=3, color="lightblue", label="transmission")
    axes.plot(f, reflected, lw=3, color="moccasin", label="reflection")
    axes.plot(f, 1 / np.hypot(1, x), "k--", lw=0.8, label="1/sqrt(1 + X^2)")
    axes.plot(f, x / np.hypot(1, x), "k:", lw=1, label="X/sqrt(1 + X^2)")
    axes.set(xlabel="frequency (Hz)", ylabel="amplitude ratio", ylim=(0, 1.05))


checks.plot(draw)
