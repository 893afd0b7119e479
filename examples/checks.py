"""Shared by the check.py of every example: reads an output folder, prints a table, sets the exit code."""
import json
import os
import sys

import numpy as np


def folder():
    """The output folder named on the command line."""
    if len(sys.argv) != 2:
        sys.exit(f"usage: {sys.argv[0]} OUTPUT_FOLDER")
    return sys.argv[1]


def histories(out):
    """histories.csv as a record array: h["step"], h["time"], h[NAME]."""
    return np.genfromtxt(os.path.join(out, "histories.csv"), delimiter=",", names=True)


def summary(out):
    """summary.json as a dictionary."""
    with open(os.path.join(out, "summary.json")) as f:
        return json.load(f)


def frame(out, number=-1):
    """Points, corners of the cells [cells, corners] (of one shape), point data, cell data of a frame. Needs h5py."""
    import h5py
    with open(os.path.join(out, "fields.hdf.series")) as f:
        name = json.load(f)["files"][number]["name"]
    with h5py.File(os.path.join(out, name), "r") as f:
        group = f["VTKHDF"]
        cells = group["Connectivity"][:].reshape(len(group["Offsets"]) - 1, -1)
        point_data, cell_data = ({k: d[:] for k, d in group[kind].items()} for kind in ("PointData", "CellData"))
        return group["Points"][:], cells, point_data, cell_data


def ricker(t, frequency, delay):
    a = (np.pi * frequency * (t - delay)) ** 2
    return (1 - 2 * a) * np.exp(-a)


def report(rows, facts=()):
    """Prints rows (quantity, exact, computed, tolerance[, scale]) as a table and exits with 1 when one is outside.

    The error is |computed - exact| / scale; scale is |exact| unless it is given. facts: pairs (sentence, whether true),
    which must hold too."""
    good = True
    print("| quantity | exact | computed | relative error | tolerance |")
    print("|---|---|---|---|---|")
    for name, exact, computed, tolerance, *scale in rows:
        error = abs(computed - exact) / (scale[0] if scale else abs(exact))
        inside = bool(error <= tolerance)  # false for nan
        good = good and inside
        mark = "" if inside else " **outside**"
        print(f"| {name} | {exact:.7g} | {computed:.7g} | {error:.1e}{mark} | {tolerance:.0e} |")
    for sentence, true in facts:
        good = good and bool(true)
        print(sentence + ("" if true else ": **not so**"))
    print("passed" if good else "FAILED")
    sys.exit(0 if good else 1)


def plot(draw):
    """Draws with draw(axes, output folder) and saves the figure: plot.py OUTPUT_FOLDER PICTURE.png. Needs matplotlib."""
    if len(sys.argv) != 3:
        sys.exit(f"usage: {sys.argv[0]} OUTPUT_FOLDER PICTURE.png")
    import matplotlib
    matplotlib.use("Agg")
    import matplotlib.pyplot as plt
    figure, axes = plt.subplots(figsize=(7.5, 4), layout="constrained")
    draw(axes, sys.argv[1])
    axes.grid(alpha=0.3)
    axes.legend(framealpha=0.9)
    figure.savefig(sys.argv[2], dpi=110)
