"""The problems of the chart, each with an exact answer, and the configurations of cdem that it shows."""
import sys
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "verification"))
import columns  # noqa: E402
from problems import beam  # noqa: E402

STRONG = {"tension": 1e20, "cohesion": 1e20, "friction": 0.0}
SPRINGS = {"block_law": "spring", **{f"block_{key}": value for key, value in STRONG.items()}}


def faces(factor):
    """Every face an elastic interface."""
    return {"interfaces": "all", "interface_all_on": "all", "interface_all_law": "elastic", "interface_all_stiffness_factor": factor}


@dataclass
class Config:
    """A way to run a problem: a name, the options that make it, the default that it is an alternative to, the problems and
    the device that it is for (all), and its look. Those of one colour belong together."""
    name: str
    options: dict = field(default_factory=dict)
    choice: str = ""
    problems: tuple = ("P", "S", "static")
    device: str = ""
    colour: str = "C0"
    style: str = "-"


DEFAULT = "full integration, the default"
STEP, FORM, SHAPE, FACES, REST, WAY = "step", "element form of hexahedra", "shape of the elements", "interfaces", "relaxation", "way and precision"
# One more line is one more line of the chart.
CONFIGS = [
    Config(DEFAULT),
    Config("bbar", {"block_element": "bbar"}, FORM, colour="C1"),
    Config("onepoint", {"block_element": "onepoint"}, FORM, colour="C2"),
    Config("law spring", SPRINGS, FORM, colour="C3"),
    Config("tetrahedra", {"mesh_box_shape": "tet"}, SHAPE, colour="C4"),
    Config("tetrahedra, bbar", {"mesh_box_shape": "tet", "block_element": "bbar"}, SHAPE, colour="C4", style="--"),
    Config("step from the bound", {"ts_central_limit": "bound"}, STEP, style="-."),
    Config("0.6 of the critical step", {"ts_central_safety": 0.6}, STEP, ("P", "S"), style="--"),
    Config("0.3 of the critical step", {"ts_central_safety": 0.3}, STEP, ("P", "S"), style=":"),
    Config("every face a spring, factor 20", faces(20), FACES, colour="C5"),
    Config("every face a spring, factor 1,000", faces(1000), FACES, colour="C5", style="--"),
    Config("kinetic damping", {"relax_damping": "kinetic"}, REST, ("static",), colour="C6"),
    Config("balance to 1e-4 of forces", {"relax_ratio": 1e-4, "relax_kinetic": 1e-8}, REST, ("static",), colour="C6", style="--"),
    Config("reference way", {"central_way": "reference"}, WAY, colour="C7"),
    Config("single precision", {"precision": "single"}, WAY, ("P", "S"), colour="C7", style="--"),
    Config("single precision, balance to 1e-5", {"precision": "single", "relax_ratio": 1e-5}, WAY, ("static",), colour="C7", style="--"),
]


def words(values):
    return ",".join(repr(float(v)) if isinstance(v, float) else str(v) for v in values)


class Wave:
    """A Ricker pulse of displacement travels up a bar of 4 x 4 x 26 m whose sides keep it plane. Error: L2 of the
    displacement of all nodes when the peak is one wavelength up, relative to that of the exact pulse."""
    wavelength, height, side = 10.0, 26.0, 4.0
    material = {"young": columns.YOUNG, "poisson": columns.POISSON, "density": columns.DENSITY}
    sizes, quick = (10, 15, 20, 30, 40, 60, 80), (5, 10)   # cells a wavelength

    def __init__(self, kind):
        self.name, self.kind, self.speed = kind, kind, float(columns.SPEED[kind])
        self.title, self.short = f"travelling {kind} wave", f"{kind} wave"
        self.axis = "xyz".index(columns.AXIS[kind])
        self.frequency = self.speed / self.wavelength
        self.delay = 1.5 / self.frequency
        self.end = self.delay + 1 / self.frequency

    def options(self, n):
        h = self.wavelength / n
        sides = columns.sides(self.kind, ("zmin",))
        base = columns.ricker_base(self.kind, self.frequency)
        return {"mesh": "box", "mesh_box_cells": words((round(self.side / h), round(self.side / h), round(self.height / h))),
                "mesh_box_size": words((self.side, self.side, self.height)), **{f"block_{k}": v for k, v in self.material.items()},
                **{key: words(v) if isinstance(v, tuple) else v for key, v in {**sides, **base}.items()},
                "table_pulse_delay": self.delay, "ts_max_time": self.end, "output_fields": "displacement"}

    def pulse(self, time):
        a = (np.pi * self.frequency * (time - self.delay))**2
        return 1e-3 * (1 - 2 * a) * np.exp(-a)

    def error(self, points, displacement):
        exact = np.zeros_like(displacement)
        exact[:, self.axis] = self.pulse(self.end - points[:, 2] / self.speed)
        return float(np.linalg.norm(displacement - exact) / np.linalg.norm(exact))

    def peer(self, points, cells, summary):
        """The same for the programs of outside.py and chart_peers.py."""
        free, steps = np.ones(points.shape, bool), summary["steps"]
        for axis in range(2):
            at_side = (points[:, axis] == points[:, axis].min()) | (points[:, axis] == points[:, axis].max())
            held = (axis,) if self.kind == "P" else (1, 2)
            free[np.ix_(at_side, held)] = False
        base = np.flatnonzero(points[:, 2] == points[:, 2].min())
        free[base, self.axis] = False
        dt = self.end / steps
        return {**self.material, "points": points, "cells": cells, "free": free, "dt": dt, "force": np.zeros(points.shape),
                "driven": 3 * base + self.axis, "drive": self.pulse(dt * np.arange(steps + 1))}, steps


class Static:
    """A cantilever of 10 x 1 x 1 m, nu = 0, comes to rest under an even traction on its free end. Error: of the mean
    deflection of that end (the one that the load does its work on), against Timoshenko's beam."""
    name, title, short = "static", "static deflection of a cantilever", "static"
    material = {"young": beam.YOUNG, "poisson": 0.0, "density": beam.DENSITY}
    sizes, quick = (1, 2, 4, 8), (1, 2)   # cells a depth

    def options(self, n):
        return {"mesh": "box", "mesh_box_cells": words((round(beam.LENGTH) * n, n, n)),
                "mesh_box_size": words((beam.LENGTH, beam.DEPTH, beam.DEPTH)), **{f"block_{k}": v for k, v in self.material.items()},
                "boundaries": "xmin,xmax", "boundary_xmin_fix": "xyz", "boundary_xmax_traction": words((0.0, 0.0, -beam.LOAD / beam.AREA)),
                "solve": "relax", "relax_max_steps": 300000, "output_fields": "displacement"}

    def weights(self, points):
        """Shares of the free end's area that its nodes have."""
        at_end = points[:, 0] == points[:, 0].max()
        edge = sum((points[:, axis] == points[:, axis].min()).astype(int) + (points[:, axis] == points[:, axis].max()) for axis in (1, 2))
        return np.where(at_end, 0.5**edge, 0.0) / np.sum(0.5**edge[at_end])

    def error(self, points, displacement):
        return float(abs(-self.weights(points) @ displacement[:, 2] / beam.tip_of_beam() - 1))

    def peer(self, points, cells, summary):
        """With damping by mass, critical for the lowest frequency, which is known here; e^-17 of the start is left."""
        force = np.zeros(points.shape)
        force[:, 2] = -beam.LOAD * self.weights(points)
        lowest, dt = float(beam.first_frequency()), summary["dt"]
        return {**self.material, "points": points, "cells": cells, "free": np.repeat(points[:, :1] > 0, 3, axis=1), "dt": dt,
                "force": force, "alpha": 2 * lowest}, int(np.ceil(17 / lowest / dt))


PROBLEMS = [Wave("P"), Wave("S"), Static()]
