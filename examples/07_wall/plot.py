"""Slip of the wall on its foot."""
import os
import sys

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
import check
import checks


def draw(axes, out):
    h = checks.histories(out)
    axes.plot(h["time"], 1e3 * (h["stone"] - h["plinth"]), lw=3, color="0.75", label="cdem: slip at the foot")
    t, slip = check.newmark(h["time"][-1])
    axes.plot(t, 1e3 * slip, "k--", lw=0.8, label="Newmark's sliding block")
    axes.plot(h["time"], 1e3 * h["plinth"], color="tab:blue", lw=0.8, label="motion of the plinth")
    axes.set(xlabel="time (s)", ylabel="displacement (mm)")


checks.plot(draw)
