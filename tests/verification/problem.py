"""What a verification problem is: a function that runs scenes in a Lab and returns rows against exact values."""
import math
from dataclasses import dataclass
from pathlib import Path

import numpy as np

import harness

PROBLEMS = []


@dataclass
class Row:
    quantity: str
    formula: str     # of the exact value
    exact: float
    computed: float
    error: float     # relative to the exact value, or to a scale that the formula names
    bar: float
    mesh: str
    seconds: float = 0.0

    @property
    def good(self):
        return math.isfinite(self.error) and self.error <= self.bar


@dataclass
class Problem:
    name: str
    title: str
    function: object
    long: bool

    def rows(self, folder):
        lab = Lab(folder)
        rows = self.function(lab)
        for row in rows:
            row.seconds = lab.wall
        return rows


class Lab:
    """Runs the scenes of one problem, each in a folder of its own, and adds up their wall time."""

    def __init__(self, folder):
        self.folder, self.wall, self.count = Path(folder), 0.0, 0

    def path(self, name):
        """A file of the problem's own, such as a mesh."""
        self.folder.mkdir(parents=True, exist_ok=True)
        return self.folder / name

    def run(self, options, **keywords):
        self.count += 1
        results = harness.run(self.folder / f"run{self.count}", options, **keywords)
        self.wall += results.wall
        return results


def problem(title, long=False):
    """Registers a function(lab) -> [Row]. Long ones run by `table --all` and `pytest --all` only."""
    def register(function):
        PROBLEMS.append(Problem(function.__name__, title, function, long))
        return function
    return register


def relative(quantity, formula, exact, computed, bar, mesh):
    """Row of one number."""
    return Row(quantity, formula, float(exact), float(computed), abs(computed - exact) / abs(exact), bar, mesh)


def worst(quantity, formula, exact, computed, bar, mesh, scale=None):
    """Row of many numbers: shows the one that is most wrong, relative to scale (default: the largest exact one)."""
    exact, computed = np.broadcast_arrays(np.asarray(exact, float), np.asarray(computed, float))
    scale = np.max(np.abs(exact)) if scale is None else scale
    at = np.unravel_index(np.argmax(np.abs(computed - exact)), exact.shape)
    return Row(quantity, formula, float(exact[at]), float(computed[at]), float(abs(computed[at] - exact[at]) / scale),
               bar, mesh)


def order(quantity, sizes, errors, exact, bar, mesh):
    """Row of the order of convergence between the last two of sizes; the error is the plain difference."""
    errors = np.abs(np.asarray(errors, float))
    found = np.log(errors[-2] / errors[-1]) / np.log(sizes[-2] / sizes[-1])
    return Row(quantity, "log ratio of errors", float(exact), float(found), abs(float(found) - exact), bar, mesh)
