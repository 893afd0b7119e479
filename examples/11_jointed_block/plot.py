"""Shear stress over the way of the top."""
import os
import sys

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
import check
import checks


def draw(axes, out):
    for end, label in (("_rock", "no joint"), ("", "random joints"), ("_plane", "one plane joint")):
        h = checks.histories(out + end)
        shear = h["time"] > check.START
        axes.plot(1e3 * h["top"][shear], check.shear(h["time"][shear]), label=label)
    for value in (check.rock(), check.joint()):
        axes.axhline(value, color="black", ls="--", lw=0.8)
    axes.set(xlabel="displacement of the top (mm)", ylabel="shear stress (MPa)", xlim=(0, 12))


checks.plot(draw)
