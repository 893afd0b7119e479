"""Velocity of the wedge, sliding and staying."""
import os
import sys

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
import check
import checks


def draw(axes, out):
    h, stays = checks.histories(out), checks.histories(out + "_35")
    axes.plot(h["time"], check.velocity(h), lw=3, color="0.75", label="cdem, 20 degrees")
    axes.plot(h["time"], check.acceleration(20) * h["time"], "k--", lw=0.8, label="rigid wedge, 20 degrees")
    axes.plot(stays["time"], check.velocity(stays), color="tab:blue", lw=0.8, label="cdem, 35 degrees")
    axes.set(xlabel="time (s)", ylabel="velocity along the line (m/s)")


checks.plot(draw)
