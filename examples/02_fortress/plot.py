"""How keep, gate and tower come to rest."""
import os
import sys

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
import check
import checks


def draw(axes, out):
    h = checks.histories(out)
    for name in check.POINTS:
        axes.plot(h["time"], 1e3 * h[name], label=name)
    axes.set(xlabel="time (s)", ylabel="vertical displacement (mm)")


checks.plot(draw)
