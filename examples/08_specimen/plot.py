"""Axial stress over axial strain."""
import os
import sys

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
import check
import checks


def draw(axes, out):
    for (end, pressure), colour in zip(check.RUNS.items(), ("tab:blue", "tab:orange", "tab:red")):
        strain, stress = check.axial(checks.histories(out + end))
        axes.plot(1e3 * strain, stress / 1e6, color=colour, label=f"confined by {pressure / 1e6:g} MPa")
        axes.axhline(check.strength(pressure) / 1e6, color=colour, ls="--", lw=0.8)
    axes.set(xlabel="axial strain (0.001)", ylabel="axial stress (MPa)")


checks.plot(draw)
