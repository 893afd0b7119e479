"""Programs of others, set beside cdem: explicit, lumped, linear elasticity on one core, on the mesh and the step of cdem.

A problem is a dict: points [n, 3], cells [m, 8] (order of VTK), young, poisson, density, free [n, 3] (components that
move), dt, and force [n, 3] or (CalculiX) gravity. Optional, of Akantu alone: alpha (damping by mass), driven [k]
(numbers of components, 3 node + axis) with drive [steps + 1] (what they are at the end of every step). Standard library
only on import."""
import json
import os
import shutil
import subprocess
import sys
from pathlib import Path

from measure import ROOT, Failed, spawn

HERE = Path(__file__).resolve().parent
PEERS = ROOT / "build" / "peers"  # a virtual environment
LONG = 3600                       # s, one run of a slow one
# The C library hands large blocks back to the system at once and fetches them again in the next step, unless told not to.
MALLOC = {"MALLOC_TRIM_THRESHOLD_": "4294967296", "MALLOC_MMAP_THRESHOLD_": "4294967296", "MALLOC_TOP_PAD_": "268435456"}


def python_with(*modules, more=()):
    """The first Python that has all of the modules, and for torch a GPU; or None."""
    test = "import " + ", ".join(modules) + ("; assert torch.cuda.is_available()" if "torch" in modules else "")
    for python in (*more, sys.executable, "/usr/bin/python3", "python3"):
        try:
            if subprocess.run([python, "-c", test], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL).returncode == 0:
                return os.path.abspath(shutil.which(python) or python)  # it may be asked from another folder
        except OSError:
            pass
    return None


def python(interpreter, *words):
    """What a script of this folder prints, on one core."""
    done = subprocess.run([interpreter, "-B", *words], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, cwd=HERE,
                          env=dict(os.environ, OMP_NUM_THREADS="1", OPENBLAS_NUM_THREADS="1"))
    if done.returncode:
        raise Failed(done.stderr.strip()[-600:])
    return done.stdout


def assembled(folder, scene, repeat):
    """The assembled stiffness (peer.py) on the mesh of a run of cdem, whose frames are in the folder."""
    interpreter = python_with("numpy", "scipy", "h5py")
    if not interpreter:
        raise Failed("no Python here has numpy, scipy and h5py")
    return json.loads(python(interpreter, HERE / "peer.py", folder, json.dumps(scene), str(repeat)))


def last_frame(folder):
    """Points, cells and displacement of the last frame of a run."""
    import h5py
    with h5py.File(max(Path(folder).glob("fields_[0-9]*.hdf")), "r") as file:
        group = file["VTKHDF"]
        offsets = group["Offsets"][:]
        return group["Points"][:], group["Connectivity"][:].reshape(-1, offsets[1] - offsets[0]), group["PointData/displacement"][:]


class Akantu:
    """Akantu from PyPI, in a Python of its own; tuned: the C library keeps its memory."""
    name, get = "Akantu", f"python3 -m venv {PEERS.relative_to(ROOT)} && {PEERS.relative_to(ROOT)}/bin/pip install akantu"

    def __init__(self, folder, python=None):
        self.folder, self.python = Path(folder), python_with("akantu", more=[python or PEERS / "bin" / "python"])
        if not self.python:
            raise Failed(f"Akantu is missing; to get it: {self.get} (or --akantu PYTHON)")
        self.version = subprocess.run([self.python, "-c", "import importlib.metadata as m; print(m.version('akantu'))"],
                                      stdout=subprocess.PIPE, text=True).stdout.strip()

    def run(self, problem, steps, tuned=True):
        """Displacement at the end; wall and CPU time of the process, and solve, solve_cpu of the loop alone."""
        import numpy as np
        np.savez(self.folder / "problem.npz", **problem)
        output, wall, cpu, _ = spawn([self.python, "-B", HERE / "peer_akantu.py", self.folder, str(steps)], self.folder, LONG,
                                     MALLOC if tuned else {})
        return np.load(self.folder / "displacement.npy"), {"wall": wall, "cpu": cpu, **json.loads(output.strip().splitlines()[-1])}


class CalculiX:
    """CalculiX from Debian: *DYNAMIC, EXPLICIT."""
    name, get = "CalculiX", "apt-get install calculix-ccx"

    def __init__(self, folder, program=None):
        self.folder, self.program = Path(folder), shutil.which(program or "ccx")
        if not self.program:
            raise Failed(f"CalculiX is missing; to get it: {self.get} (or --ccx PROGRAM)")
        self.program = os.path.abspath(self.program)
        text = subprocess.run([self.program, "-v"], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True).stdout
        self.version = text.split("ersion")[-1].strip() or "of an unknown version"

    def run(self, problem, steps):
        """Displacement at the end, to the 7 digits that it prints; wall and CPU time of the process."""
        import numpy as np
        held = [(axis, np.flatnonzero(~problem["free"][:, axis]) + 1) for axis in range(3)]
        dt, end = problem["dt"], problem["dt"] * steps
        deck = ["*NODE, NSET=NALL", *(f"{i}, {x!r}, {y!r}, {z!r}" for i, (x, y, z) in enumerate(problem["points"].tolist(), 1)),
                "*ELEMENT, TYPE=C3D8, ELSET=EALL", *(f"{i}, " + ", ".join(map(str, c)) for i, c in enumerate((problem["cells"] + 1).tolist(), 1)),
                "*MATERIAL, NAME=ROCK", "*ELASTIC", f"{problem['young']!r}, {problem['poisson']!r}", "*DENSITY", f"{problem['density']!r}",
                "*SOLID SECTION, ELSET=EALL, MATERIAL=ROCK",
                "*BOUNDARY", *(f"{node}, {axis + 1}" for axis, nodes in held for node in nodes),
                "*STEP, INC=100000000", "*DYNAMIC, EXPLICIT, ALPHA=0.", f"{dt!r}, {end!r}, {dt!r}, {dt!r}",
                "*DLOAD", f"EALL, GRAV, {problem['gravity']!r}, 0., 0., -1.",
                "*NODE PRINT, NSET=NALL, FREQUENCY=100000000", "U", "*END STEP", ""]
        (self.folder / "deck.inp").write_text("\n".join(deck))
        _, wall, cpu, _ = spawn([self.program, "deck"], self.folder, LONG, {"CCX_NPROC_EQUATION_SOLVER": "1", "CCX_NPROC_RESULTS": "1"})
        lines = (line.split() for line in (self.folder / "deck.dat").read_text().splitlines())
        rows = [line for line in lines if len(line) == 4 and line[0].isdigit()]
        if len(rows) != len(problem["points"]):
            raise Failed(f"CalculiX printed {len(rows)} displacements for {len(problem['points'])} nodes")
        return np.array([[float(v) for v in row[1:]] for row in rows]), {"wall": wall, "cpu": cpu}
