"""Pressure over settlement."""
import os
import sys

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
import check
import checks


def draw(axes, out):
    h = checks.histories(out)
    axes.plot(-1e3 * h["top"], check.pressure(h) / 1e3, label="cdem, h = 1/16 m")
    axes.axhline(check.prandtl() / 1e3, color="black", ls="--", lw=0.8, label="(2 + pi) c")
    axes.axhline(check.prandtl() * (1 + check.ELEMENT / 2) / 1e3, color="tab:red", ls="--", lw=0.8,
                 label="(2 + pi) c (1 + h/2)")
    axes.set(xlabel="settlement (mm)", ylabel="pressure (kPa)")


checks.plot(draw)
