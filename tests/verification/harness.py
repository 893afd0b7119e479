"""Runs cdem on a scene given as a dict of options and reads what it wrote."""
import atexit
import contextlib
import csv
import functools
import itertools
import json
import os
import shutil
import signal
import subprocess
import tempfile
import time
from pathlib import Path

import h5py
import numpy as np

ROOT = Path(__file__).resolve().parents[2]
NUMBERS = itertools.count()
MPIRUN = ["mpirun", "--allow-run-as-root", "--oversubscribe", "--bind-to", "none"]


def program():
    """Path of the program under test: environment CDEM, or the CPU build of this source tree."""
    return os.environ.get("CDEM", str(ROOT / "build" / "cpu" / "cdem"))


def device(options, extra=()):
    """Options that choose the device: environment CDEM_DEVICE, unless the scene names one."""
    chosen = os.environ.get("CDEM_DEVICE")
    return ["-device", chosen] if chosen and "device" not in options and "-device" not in extra else []


def as_text(value):
    """The value of an option as PETSc reads it; numbers keep all their digits."""
    if isinstance(value, bool):
        return "1" if value else "0"
    if isinstance(value, (int, np.integer)):
        return str(int(value))
    if isinstance(value, (float, np.floating)):
        return repr(float(value))
    if isinstance(value, (list, tuple, np.ndarray)):
        return ",".join(as_text(v) for v in value)
    return str(value)


@functools.lru_cache(maxsize=None)
def scratch():
    """A folder of this process, which goes when it ends."""
    folder = tempfile.mkdtemp(prefix="cdem_mpi_")
    atexit.register(shutil.rmtree, folder, ignore_errors=True)
    return folder


def environment(ranks=1):
    """That of a run on so many ranks."""
    env = dict(os.environ)
    env.setdefault("OMPI_ALLOW_RUN_AS_ROOT", "1")
    env.setdefault("OMPI_ALLOW_RUN_AS_ROOT_CONFIRM", "1")
    env.setdefault("OMP_NUM_THREADS", "1")
    env.setdefault("OMPI_MCA_pml", "ob1")  # as in tests/CMakeLists.txt
    env.setdefault("OMPI_MCA_mpi_yield_when_idle", "1")
    if ranks == 1:  # Open MPI 4 starts no daemon then: 0.15 s instead of 0.5; but those alone share a name in their folder
        env["OMPI_MCA_ess_singleton_isolated"] = "1"
        env["OMPI_MCA_orte_tmpdir_base"] = f"{scratch()}/{next(NUMBERS)}"
    return env


def kill(run):
    """SIGKILL to the program: to the children of mpirun first, if it is one, else they would go on for a while."""
    children = []
    if run.poll() is None:
        with open(f"/proc/{run.pid}/task/{run.pid}/children") as file:
            children = [int(pid) for pid in file.read().split()]
    for pid in children:
        with contextlib.suppress(ProcessLookupError):  # one that has just ended
            os.kill(pid, signal.SIGKILL)
    run.kill()
    run.wait()
    while any(is_running(pid) for pid in children):
        time.sleep(0.01)


def is_running(pid):
    try:
        with open(f"/proc/{pid}/stat") as file:
            return file.read().rsplit(")", 1)[1].split()[0] not in "ZX"
    except FileNotFoundError:
        return False


class Failed(AssertionError):
    """The program ended with an exit code other than 0."""


def call(folder, options, ranks=1, timeout=600, extra=()):
    """Runs the program in folder with the options in a file scene.txt (so that the scene can be run again by hand)."""
    folder = Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    lines = [f"-{key}" if value is None else f"-{key} {as_text(value)}" for key, value in options.items()]
    (folder / "scene.txt").write_text("\n".join(lines) + "\n")
    command = (MPIRUN + ["-n", str(ranks)] if ranks > 1 else []) + [program(), "-options_file", "scene.txt",
                                                                         *device(options, extra), *extra]
    return subprocess.run(command, cwd=folder, env=environment(ranks), text=True, errors="replace", timeout=timeout,
                          stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE)


def run(folder, options, ranks=1, timeout=600):
    """Runs a scene that must succeed, with -output out in folder; returns its Results."""
    options = {"output": "out", **options}
    start = time.perf_counter()
    done = call(folder, options, ranks, timeout)
    wall = time.perf_counter() - start
    if done.returncode != 0:
        raise Failed(f"exit code {done.returncode} of {folder}/scene.txt\n{done.stdout[-3000:]}\n{done.stderr[-3000:]}")
    return Results(Path(folder), options["output"], wall, done.stdout)


class Frame:
    """One VTKHDF file: points, cells, and the data on both; mesh and data are read when they are first asked for."""

    def __init__(self, path):
        self.path = path

    @functools.cached_property
    def mesh(self):
        with h5py.File(self.path, "r") as file:
            return {name: file["VTKHDF"][name][:] for name in ("Points", "Connectivity", "Offsets")}

    @functools.cached_property
    def data(self):
        with h5py.File(self.path, "r") as file:
            group = file["VTKHDF"]
            return {part: {name: data[:] for name, data in group[part].items()} if part in group else {}
                    for part in ("PointData", "CellData")}

    points = property(lambda self: self.mesh["Points"])
    connectivity = property(lambda self: self.mesh["Connectivity"])
    offsets = property(lambda self: self.mesh["Offsets"])
    point_data = property(lambda self: self.data["PointData"])
    cell_data = property(lambda self: self.data["CellData"])

    def nodes(self, cell):
        """Numbers of the points of a cell."""
        return self.connectivity[self.offsets[cell]:self.offsets[cell + 1]]

    def centres(self):
        """Mean of the corners of every cell."""
        return np.array([self.points[self.nodes(c)].mean(axis=0) for c in range(len(self.offsets) - 1)])


class Results:
    """What a run left in its folder."""

    def __init__(self, folder, output, wall, stdout):
        self.folder, self.out, self.wall, self.stdout, self.series = folder, folder / output, wall, stdout, {}

    @property
    def summary(self):
        return json.loads((self.out / "summary.json").read_text())

    def histories(self):
        """Columns of histories.csv by name, step and time included."""
        with open(self.out / "histories.csv", newline="") as file:
            rows = list(csv.reader(file))
        data = np.array(rows[1:], dtype=float)
        return {name: data[:, i] for i, name in enumerate(rows[0])}

    def monitor(self, name):
        """Columns of a monitor's file by the names in its header line."""
        lines = (self.folder / name).read_text().splitlines()
        header = next(line for line in lines if line.startswith("#")).lstrip("# ").split()
        data = np.array([line.split() for line in lines if line and not line.startswith("#")], dtype=float)
        return {column: data[:, i] for i, column in enumerate(header)}

    def frames(self, name="fields"):
        """Times and Frames of a series, in order; the same ones when asked again."""
        if name not in self.series:
            series = json.loads((self.out / f"{name}.hdf.series").read_text())
            self.series[name] = [(entry["time"], Frame(self.out / entry["name"])) for entry in series["files"]]
        return self.series[name]

    def last_frame(self, name="fields"):
        series = json.loads((self.out / f"{name}.hdf.series").read_text())
        return Frame(self.out / series["files"][-1]["name"])
