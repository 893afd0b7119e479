"""Velocity of the block."""
import os
import sys

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
import check
import checks


def draw(axes, out):
    h = checks.histories(out)
    axes.plot(h["time"], h["velocity"], lw=3, color="0.75", label="cdem")
    axes.plot(h["time"], check.acceleration() * h["time"], "k--", lw=0.8, label="g (sin 30 - cos 30 tan 20) t")
    axes.set(xlabel="time (s)", ylabel="velocity down the incline (m/s)")


checks.plot(draw)
