"""Pressure against the roof's way down."""
import os
import sys

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
import check
import checks


def draw(axes, out):
    h = checks.histories(out)
    axes.plot(-1e3 * h["roof"], check.RATE * h["time"] / 1e6, lw=3, color="0.75", label="cdem")
    p = check.strength()
    axes.plot([0, 1e3 * p * check.compliance()], [0, p / 1e6], "k--", lw=0.8, label="exact, whole")
    axes.axhline(p / 1e6, color="tab:red", lw=0.8, label="2 c cos(phi)/(1 - sin(phi))")
    axes.set(xlabel="roof displacement (mm)", ylabel="pressure (MPa)")


checks.plot(draw)
