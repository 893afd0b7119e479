"""Runs cdem and says what a run cost. Python's standard library only."""
import datetime
import json
import os
import platform
import re
import shutil
import statistics
import subprocess
import tempfile
import threading
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
TIMEOUT = 300       # s, one run
UNDISTURBED = 0.95  # CPU time over wall time, from which on a run counts as undisturbed


class Failed(Exception):
    """A run ended with an exit code, or with results that are not what was asked for."""


def environment():
    env = dict(os.environ, OMP_NUM_THREADS="1")
    env.setdefault("OMPI_ALLOW_RUN_AS_ROOT", "1")
    env.setdefault("OMPI_ALLOW_RUN_AS_ROOT_CONFIRM", "1")
    return env


def spawn(command, cwd=ROOT, timeout=TIMEOUT, env=None):
    """Runs a command; returns its output, seconds, CPU seconds and peak memory in bytes."""
    with tempfile.TemporaryFile() as output:
        start = time.perf_counter()
        process = subprocess.Popen(command, cwd=cwd, env={**environment(), **(env or {})}, stdin=subprocess.DEVNULL,
                                   stdout=output, stderr=subprocess.STDOUT)
        killer = threading.Timer(timeout, process.kill)
        killer.start()
        _, status, usage = os.wait4(process.pid, 0)
        wall = time.perf_counter() - start
        killer.cancel()
        process.returncode = os.waitstatus_to_exitcode(status)
        output.seek(0)
        text = output.read().decode(errors="replace")
    if process.returncode:
        raise Failed(f"exit code {process.returncode} after {wall:.0f} s: {text.strip()[-600:]}")
    return text, wall, usage.ru_utime + usage.ru_stime, usage.ru_maxrss * 1024


class Machine:
    """What runs: the program, the device, and the folder for its results."""

    def __init__(self, program, device, scratch):
        self.program, self.device = Path(program).resolve(), device
        self.scratch = Path(tempfile.mkdtemp(prefix="cdem_benchmarks_", dir=scratch))
        self.start_cpu = 0.0
        tiny = {"mesh": "box", "mesh_box_cells": "1,1,1", "mesh_box_size": "1,1,1", "block_young": 1e9,
                "block_poisson": 0, "block_density": 1000, "ts_max_steps": 1}
        try:
            runs = [self.run(tiny) for _ in range(3)]
        except BaseException:
            self.close()
            raise
        self.start_cpu = statistics.median(r["cpu"] for r in runs)  # of the start alone
        self.start_wall = statistics.median(r["wall"] for r in runs)
        summary = runs[-1]["summary"]
        self.about = {
            "date": datetime.date.today().isoformat(), "version": summary["version"], "git": summary["git"],
            "petsc": summary["petsc"], "device": summary["device"], "cpu": cpu_model(),
            "cores": len(os.sched_getaffinity(0)),
            "memory_gib": round(os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES") / 2**30, 1),
            "gpu": gpu() if device == "cuda" else None, "load_at_start": os.getloadavg()[0]}

    def run(self, options, keep=False, ranks=1, out=None):
        """One run; with keep its results stay in self.out until the next run."""
        self.out = out or self.scratch / "out"
        folder = self.out
        shutil.rmtree(folder, ignore_errors=True)
        options = {**options, "device": self.device, "output": folder, "output_overwrite": None}
        try:
            front = ["mpirun", "-n", str(ranks), "--bind-to", "none"] if ranks > 1 else []
            _, wall, cpu, peak = spawn([*front, self.program, *arguments(options)])
            summary = json.loads((folder / "summary.json").read_text())
        except (OSError, ValueError) as error:
            raise Failed(str(error)) from error
        finally:
            if not keep:
                shutil.rmtree(folder, ignore_errors=True)
        at_work = sum(summary["wall"][part] for part in ("setup", "solve", "output"))
        return {**summary["wall"], "wall": wall, "cpu": cpu, "peak_bytes": peak,
                "share": min(1.0, (cpu - ranks * self.start_cpu) / at_work / ranks), "summary": summary}

    def run_at_once(self, options, n):
        """n runs of their own at the same time."""
        with ThreadPoolExecutor(n) as pool:
            return list(pool.map(lambda i: self.run(options, out=self.scratch / f"out_{i}"), range(n)))

    def close(self):
        shutil.rmtree(self.scratch, ignore_errors=True)


def arguments(options):
    """Options as a command line; None stands for an option without a value."""
    words = []
    for key, value in options.items():
        words += [f"-{key}"] if value is None else [f"-{key}", str(value)]
    return words


def median_of(run, n, warm_up, watch_share):
    """n runs after a warm-up. On a CPU a run that did not have its core to itself is done again, n times at most; then
    the least disturbed ones are taken. Every run is kept; "used" says which ones count."""
    if warm_up:
        run()
    runs = []
    while len(runs) < 2 * n:
        good = [r for r in runs if r["share"] >= UNDISTURBED or not watch_share]
        if len(good) >= n:
            break
        runs.append(run())
    chosen = sorted(range(len(runs)), key=lambda i: -runs[i]["share"] if watch_share else 0)
    if watch_share and sum(r["share"] >= UNDISTURBED for r in runs) >= n:
        chosen = [i for i in range(len(runs)) if runs[i]["share"] >= UNDISTURBED]
    for i, r in enumerate(runs):
        r["used"] = i in chosen[:n]
    return runs


def used(runs, what):
    return [r[what] for r in runs if r["used"]]


def middle(values):
    """Median and spread, (largest - smallest) / median."""
    median = statistics.median(values)
    return median, (max(values) - min(values)) / median if median else 0.0


def cpu_model():
    try:
        return re.search(r"model name\s*:\s*(.*)", Path("/proc/cpuinfo").read_text()).group(1)
    except (OSError, AttributeError):
        return platform.processor() or platform.machine()


def gpu():
    """Name, driver and memory of the first GPU, or None."""
    try:
        done = subprocess.run(["nvidia-smi", "--query-gpu=name,driver_version,memory.total", "--format=csv,noheader"],
                              stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True, timeout=60)
    except (OSError, subprocess.TimeoutExpired):
        return None
    lines = done.stdout.strip().splitlines()
    if done.returncode or not lines:
        return None
    name, driver, memory = (word.strip() for word in lines[0].split(",")[:3])
    return {"name": name, "driver": driver, "memory": memory}
