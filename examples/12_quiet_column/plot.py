"""Velocity of the top over time, and in the corner the amplification over frequency."""
import os
import sys

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
import check
import checks


def draw(axes, out):
    import numpy as np
    h = checks.histories(out)
    shown = h["time"] < 1.5
    t = h["time"][shown]
    axes.plot(t, check.incoming(t - 0.0125), color="tab:green", lw=1, label="wave that comes in, at z = 10 m")
    axes.plot(t, h["below"][shown], color="moccasin", lw=3, label="velocity at z = 10 m")
    axes.plot(t, h["top"][shown], color="lightblue", lw=3, label="velocity of the top")
    axes.plot(t, check.top(t), "k--", lw=0.8, label="4 v_in/(1 + a) and its echoes")
    axes.set(xlabel="time (s)", ylabel="velocity (m/s)", xlim=(0, 2.5))
    inset = axes.inset_axes([0.6, 0.1, 0.37, 0.36])
    f = np.linspace(0.5, 10, 200)
    inset.plot(f, check.measured(h, f), color="lightblue", lw=3)
    inset.plot(f, check.amplification(f), "k--", lw=0.8)
    inset.set(xlabel="frequency (Hz)", title="top / wave that comes in")
    inset.title.set_fontsize(8)
    inset.tick_params(labelsize=7)
    inset.xaxis.label.set_fontsize(7)


checks.plot(draw)
