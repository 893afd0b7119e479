"""Vertical velocities at four places, and the pulse as it was sent."""
import os
import sys

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
import check
import checks


def draw(axes, out):
    h = checks.histories(out)
    for name, colour in (("floor", "tab:blue"), ("crown", "tab:orange"), ("surface", "tab:green")):
        axes.plot(1e3 * h["time"], h[name], color=colour, lw=1, label=name)
    axes.plot(1e3 * h["time"], h["rock"], lw=3, color="0.75", label="rock, away from the tunnel")
    c = (check.YOUNG * (1 - check.POISSON) / ((1 + check.POISSON) * (1 - 2 * check.POISSON)) / check.DENSITY) ** 0.5
    t = h["time"][h["time"] <= check.UNTIL]
    axes.plot(1e3 * t, check.VELOCITY * checks.ricker(t - check.RISE / c, check.FREQUENCY, check.DELAY), "k--", lw=0.8,
              label="plane wave")
    axes.set(xlabel="time (ms)", ylabel="vertical velocity (m/s)")


checks.plot(draw)
