"""Closure of the tunnel while it is dug and shaken, and the wave."""
import os
import sys

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
import check
import checks


def draw(axes, out):
    h, last = checks.histories(out), check.ends(out)[2]
    t = 1e3 * h["time"][last:]
    for values, vertical, colour, name in zip(check.walls(h), (False, True), ("tab:blue", "tab:orange"), ("sides", "height")):
        axes.plot(t, 1e3 * values[last:], color=colour, lw=1, label=f"closure of the {name}")
        axes.axhline(1e3 * check.closure(vertical), color=colour, ls="--", lw=0.8)
    axes.plot([], [], "--", color="0.4", lw=0.8, label="Kirsch, before the wave")
    axes.set(xlabel="time since the wave set out (ms)", ylabel="closure (mm)")
    right = axes.twinx()
    t, v = check.wave(out)
    right.plot(1e3 * t, v, color="0.7", lw=1)
    right.set(ylabel="velocity of the rock beside (m/s), grey", ylim=(-0.6, 1.2))


checks.plot(draw)
