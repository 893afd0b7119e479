"""Columns of one cell by one cell along z that move in exactly one dimension, and what is exact for them."""
import numpy as np

YOUNG, POISSON, DENSITY = 50e9, 0.25, 2500.0
LAME = YOUNG * POISSON / ((1 + POISSON) * (1 - 2 * POISSON))
SHEAR = YOUNG / (2 * (1 + POISSON))
MODULUS = {"P": LAME + 2 * SHEAR, "S": SHEAR}
SPEED = {kind: np.sqrt(m / DENSITY) for kind, m in MODULUS.items()}
AXIS = {"P": "z", "S": "x"}
FIXED = {"P": ("x", "x", "y", "y"), "S": ("yz",) * 4}


def rock():
    return {"block_law": "elastic", "block_young": YOUNG, "block_poisson": POISSON, "block_density": DENSITY}


def sides(kind, more=()):
    """Boundaries that leave a P column only z, an S column only x, and any more that the scene describes itself."""
    names = ("xmin", "xmax", "ymin", "ymax")
    options = {"boundaries": names + tuple(more)}
    options.update({f"boundary_{name}_fix": fix for name, fix in zip(names, FIXED[kind])})
    return options


def box(cells, h, side=None):
    side = side or h
    return {"mesh": "box", "mesh_box_cells": (1, 1, cells), "mesh_box_size": (side, side, cells * h)}


def ricker_base(kind, frequency):
    """A Ricker displacement of 1 mm at the base, whose start and end are below 1e-15 of the peak."""
    vector = {"z": (0.0, 0.0, 1e-3), "x": (1e-3, 0.0, 0.0)}[AXIS[kind]]
    return {"boundary_zmin_displacement": vector, "boundary_zmin_components": AXIS[kind], "boundary_zmin_table": "pulse",
            "tables": "pulse", "table_pulse_type": "ricker", "table_pulse_frequency": frequency,
            "table_pulse_delay": 2 / frequency}


def histories(kind, places):
    """Histories h0, h1, ... of the column's displacement at heights z."""
    options = {"histories": [f"h{i}" for i in range(len(places))], "history_interval": 1}
    for i, z in enumerate(places):
        options[f"history_h{i}_at"] = (0.0, 0.0, z)
        options[f"history_h{i}_of"] = "displacement_" + AXIS[kind]
    return options


def spectrum(history, time, frequency):
    """Fourier sum of a history at one frequency [Hz]."""
    return np.sum(history * np.exp(-2j * np.pi * frequency * time))


def discrete_wavenumber(speed, h, dt, frequency):
    """k of sin(w dt/2) = (c dt/h) sin(k h/2)."""
    return 2 / h * np.arcsin(h / (speed * dt) * np.sin(np.pi * frequency * dt))


def stack_matrices(cells, h, area, modulus, density, kn):
    """Lumped masses and stiffness of blocks of one cell on springs kn [Pa/m], the lowest node fixed (it is left out).

    Nodes: bottom and top of the first block, of the second, ..."""
    n = 2 * cells
    mass = np.full(n, density * area * h / 2)
    stiffness = np.zeros((n, n))
    def spring(a, b, k):
        stiffness[np.ix_((a, b), (a, b))] += k * np.array([[1, -1], [-1, 1]])
    for c in range(cells):
        spring(2 * c, 2 * c + 1, modulus * area / h)
        if c:
            spring(2 * c - 1, 2 * c, kn * area)
    return mass[1:], stiffness[1:, 1:]


def frequencies(mass, stiffness):
    """Angular frequencies and mass-normalised modes (columns)."""
    root = np.sqrt(mass)
    values, vectors = np.linalg.eigh(stiffness / np.outer(root, root))
    return np.sqrt(values), vectors / root[:, None]


def to_rest(lowest, digits=15):
    """Alpha damping just under critical of the lowest mode, and the time after which 10^-digits of the start is left."""
    return {"damping_alpha": 1.96 * lowest, "ts_max_time": (2.303 * digits + 4) / (0.98 * lowest)}
