"""What a table of results says of its origin."""
import os
import platform
import re
from pathlib import Path

import harness


def machine():
    """Processor and number of cores."""
    try:
        model = re.search(r"model name\s*:\s*(.*)", Path("/proc/cpuinfo").read_text()).group(1)
    except (OSError, AttributeError):
        model = platform.machine()
    return f"{model}, {os.cpu_count()} cores"


def version(folder):
    """Versions of the program and of PETSc, from the summary of a small run."""
    summary = harness.run(folder, {"mesh": "box", "mesh_box_cells": (1, 1, 1),
                                   "mesh_box_size": (1, 1, 1), "block_young": 1e9, "block_poisson": 0.0,
                                   "block_density": 1000.0, "ts_max_steps": 1}).summary
    return f"cdem {summary['version']}, PETSc {summary['petsc']}, device {summary['device']}"
