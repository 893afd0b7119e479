"""Hoop stress and closure round the wall."""
import os
import sys

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
import check
import checks


def draw(axes, out):
    import numpy as np
    t = np.linspace(0, np.pi / 2, 100)
    axes.plot(np.degrees(t), check.hoop(t) / 1e6, "k-", lw=0.8, label="Kirsch")
    angle, stress = check.wall_hoop(out)
    axes.plot(np.degrees(angle), stress / 1e6, "o", color="tab:blue", ms=4, label="hoop stress (left)")
    axes.plot([], [], "s", color="tab:orange", ms=4, label="closure (right)")
    axes.set(xlabel="angle from x (degrees)", ylabel="hoop stress, compression (MPa)", ylim=(13, 27))
    right = axes.twinx()
    right.plot(np.degrees(t), 1e3 * check.closure(t), "k-", lw=0.8)
    angle, inward = check.wall_closure(out)
    right.plot(np.degrees(angle), 1e3 * inward, "s", color="tab:orange", ms=4)
    right.set(ylabel="closure (mm)", ylim=(0.9, 2.2))


checks.plot(draw)
