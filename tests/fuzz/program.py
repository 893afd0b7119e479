"""Runs the program on a case, with limits, and judges what any case must hold."""
import json
import os
import re
import subprocess
from pathlib import Path

import h5py
import numpy as np

ROOT = Path(__file__).resolve().parents[2]
MEMORY = 2 << 30  # bytes of address space of a process
MPIRUN = ["mpirun", "--allow-run-as-root", "--oversubscribe", "--bind-to", "none"]
LITTER = ("PETSC ERROR", "terminate called", "Sanitizer", "runtime error:", "Assertion", "Backtrace", "Segmentation fault",
          "free():", "malloc", "*** ")
# A single process needs neither Open MPI's daemon nor its networks: a start takes 0.06 s instead of 0.3 s.
ALONE = {"OMPI_MCA_ess_singleton_isolated": "1", "OMPI_MCA_btl": "self", "OMPI_MCA_pml": "ob1", "OMPI_MCA_io": "romio321"}


class Finding(Exception):
    """The program did what it must not do."""


def default_program():
    return os.environ.get("CDEM", str(ROOT / "build" / "cpu" / "cdem"))


def is_sanitized(program):
    return b"__asan_init" in Path(program).read_bytes()


def files(folder):
    return {path.relative_to(folder).as_posix(): path.read_bytes() for path in folder.rglob("*") if path.is_file()}


ACCEPTED = object()


class NoResults(Exception):
    """The scene has lost its option -output."""


class Frame:
    """The last frame of fields."""

    def __init__(self, path):
        with h5py.File(path, "r") as file:
            group = file["VTKHDF"]
            self.points, self.connectivity, self.offsets = (group[k][:] for k in ("Points", "Connectivity", "Offsets"))
            self.velocity = group["PointData/velocity"][:]
            self.region = group["CellData/region"][:]
            self.values = {n: d[:] for part in ("PointData", "CellData") for n, d in group[part].items()}

    def cell(self, i):
        return self.connectivity[self.offsets[i]:self.offsets[i + 1]]


class Results:
    """What an accepted case wrote into its folder `out`."""

    def __init__(self, folder, text):
        found = sorted(folder.rglob("summary.json"))
        if len(found) != 1:
            raise NoResults
        self.out, self.text = found[0].parent, text
        self.summary = json.loads((self.out / "summary.json").read_text())

    def frame(self):
        series = json.loads((self.out / "fields.hdf.series").read_text())
        return Frame(self.out / series["files"][-1]["name"])

    def scene(self):
        return (self.out / "scene.opts").read_text(errors="surrogateescape")

    def columns(self, name):
        lines = (self.out / name).read_text().splitlines()
        return lines[0].split(","), [line.split(",") for line in lines[1:]]


def run(program, folder, scratch, arguments, ranks, sanitized):
    """(return code, text) of the program in folder; raises Finding when it hangs."""
    env = {**os.environ, "OMP_NUM_THREADS": "1", "OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1"}
    command = MPIRUN + ["-n", str(ranks), program] if ranks > 1 else [program]
    if ranks == 1:
        env.update(ALONE, OMPI_MCA_orte_tmpdir_base=str(scratch))  # processes that share one may trip over each other
    if sanitized:
        env["ASAN_OPTIONS"] = f"detect_leaks=0:allocator_may_return_null=1:hard_rss_limit_mb={MEMORY >> 20}"
    seconds = (60 if ranks == 1 else 120) * (4 if sanitized else 1)
    try:
        done = subprocess.run(command + arguments, cwd=folder, env=env, timeout=seconds, stdin=subprocess.DEVNULL,
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
    except subprocess.TimeoutExpired:
        raise Finding(f"still running after {seconds} s")
    return done.returncode, done.stdout.decode(errors="replace")


def judge(code, text, folder, before, good):
    """None if the case was refused as it must be, Results if it was accepted; raises Finding."""
    litter = [word for word in LITTER if word in text]
    if litter:
        raise Finding(f"litter: {litter}")
    errors = text.count("cdem: error:")
    if code == 0:
        if errors:
            raise Finding("an error and exit code 0")
        try:
            results = Results(folder, text)
        except NoResults:
            if files(folder) == before:
                return ACCEPTED
            raise
        check_numbers(results)
        return results
    if code < 0 or code > 127:
        raise Finding(f"exit code {code}")
    if errors != 1:
        raise Finding(f"{errors} error messages, exit code {code}")
    message = text[text.index("cdem: error:"):]
    if "became unstable" not in message and files(folder) != before:
        raise Finding(f"refused, but wrote {sorted(set(files(folder)) - set(before))}")
    if len(message.split(":", 2)[2].strip()) < 15:
        raise Finding("a message without content")
    if good:
        raise Finding("refused what is good")
    return None


def check_numbers(results):
    """Everything that a finished run gives is a finite number."""
    def walk(value, path):
        if isinstance(value, dict):
            for key, part in value.items():
                walk(part, f"{path}.{key}")
        elif value is None and not re.search(r"energy\.error|dt_critical|p32_wanted", path):
            raise Finding(f"summary.json: {path} is not a finite number")
    walk({k: v for k, v in results.summary.items() if k != "stages"}, "")
    for name, values in results.frame().values.items():
        if not np.all(np.isfinite(values)) and name != "broken_time":
            raise Finding(f"frame: {name} is not finite")
