"""Vertical stress along the middle of the stopes, stage by stage."""
import os
import sys

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
import check
import checks


def draw(axes, out):
    import numpy as np
    for number, stage in enumerate(checks.summary(out)["stages"]):
        x, z, _, _, _, stress = check.state(out, number + 1)
        middle = np.flatnonzero(abs(z - 0.5) < 1e-3)
        middle = middle[np.argsort(x[middle])]
        values = np.where(stress[middle] == 0, np.nan, stress[middle])      # what is mined out has none
        axes.plot(x[middle], values / 1e6, ".-", ms=3, lw=0.9, label=stage["name"])
    axes.axhline(check.VIRGIN * (check.STOPE + check.PILLAR) / check.PILLAR / 1e6, color="k", ls="--", lw=0.8,
                 label="tributary area")
    axes.set(xlabel="along the ore (m)", ylabel="vertical stress (MPa)", xlim=(-45, 45))


checks.plot(draw)
