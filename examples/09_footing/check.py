"""Bearing pressure of the footing from its load cell, against Prandtl."""
import os
import sys

import numpy as np

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
import checks

COHESION, CELL_YOUNG, CELL = 1.0e5, 1.56e11, 0.75     # Pa, Pa, m
ELEMENT = 1 / 16      # m, beside the edge of the footing; its half width is 1 m


def prandtl():
    return (2 + np.pi) * COHESION


def pressure(h):
    """Mean pressure under the footing: the upper half of the cell shortens by the mean over its middle plane (Pa)."""
    middle = (h["cell_0"] / 2 + h["cell_1"] + h["cell_2"] + h["cell_3"] + h["cell_4"] / 2) / 4
    return CELL_YOUNG * (middle - h["top"]) / CELL


def main():
    q = pressure(checks.histories(checks.folder()))[-1]
    checks.report([
        ("pressure on 1 m (kPa)", prandtl() / 1e3, q / 1e3, 4e-2),
        ("pressure on 1 m + h/2 (kPa)", prandtl() / 1e3, q / (1 + ELEMENT / 2) / 1e3, 5e-3),
    ])


if __name__ == "__main__":
    main()
