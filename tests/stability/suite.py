"""What a case of the stability suite is: a function that runs scenes in a Lab and returns rows with bounds."""
import math
import sys
from dataclasses import dataclass
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "verification"))
import harness  # noqa: E402
import meshes  # noqa: E402,F401
from problem import Lab  # noqa: E402

CASES = []


@dataclass
class Row:
    run: str         # scene and number of steps
    judged: str      # what the figure is
    figure: float
    bound: float     # the figure must not be above it
    note: str = ""

    @property
    def good(self):
        return math.isfinite(self.figure) and self.figure <= self.bound


@dataclass
class Case:
    title: str
    function: object

    @property
    def name(self):
        return self.function.__name__

    def rows(self, folder, quick):
        """Rows, and the wall time of the program in them [s]."""
        lab = Lab(folder)
        lab.quick = quick
        return self.function(lab), lab.wall


def case(title):
    """Registers a function(lab) -> [Row]; lab.quick asks for fewer steps of the same."""
    def register(function):
        CASES.append(Case(title, function))
        return function
    return register


def call(lab, options, timeout=600):
    """A run that may fail: exit code, terminal text, Results."""
    lab.count += 1
    folder = lab.folder / f"run{lab.count}"
    done = harness.call(folder, {"output": "out", **options}, timeout=timeout)
    return done.returncode, done.stdout + done.stderr, harness.Results(folder, "out", 0.0, done.stdout)
