"""The top of the brick over the first steps, and the exact solution."""
import os
import sys

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
import check
import checks


def draw(axes, out):
    h = checks.histories(out)
    s = checks.summary(out)
    first = slice(0, 400)
    u, static = check.exact(h["step"][first], s["dt"])
    t = h["time"][first]
    axes.plot(t, 1e3 * h["top"][first], lw=3, color="0.75", label="cdem")
    axes.plot(t, 1e3 * u, "k", lw=0.8, label="exact solution of the discrete equations")
    axes.axhline(1e3 * static, color="tab:red", ls="--", label="at rest")
    axes.set(xlabel="time (s)", ylabel="displacement of the top (mm)", ylim=(-0.28, 0.12))


checks.plot(draw)
