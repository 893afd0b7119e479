"""Fields and histories are equal to the last bit: run = run, 1 = 2 = 3 ranks, batch 1 = batch 1000."""
import sys
from pathlib import Path

import numpy as np
import pytest

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "verification"))
import harness  # noqa: E402
import meshes  # noqa: E402

STEPS = 300
BASE = {
    "block_law": "elastic", "block_young": 2e9, "block_poisson": 0.25, "block_density": 2200.0,
    "gravity": (0, 0, -9.81), "velocity": (0.3, -0.1, 0.0), "damping_alpha": 2.0,
    "tables": "pulse", "table_pulse_type": "ricker", "table_pulse_frequency": 300.0, "table_pulse_delay": 0.003,
    "boundary_zmin_displacement": (2e-3, 0.0, 1e-3), "boundary_zmin_table": "pulse",
    "boundary_zmax_pressure": 2e4,
    "histories": ("top", "inner"), "history_interval": 1,
    "history_top_at": (2.0, 2.0, 3.0), "history_top_of": "displacement_z",
    "history_inner_at": (1.0, 1.0, 1.0), "history_inner_of": "velocity_x",
    "ts_max_steps": STEPS, "output_interval": 75, "deterministic": None,  # what several ranks do by themselves
}
BREAKING = {"interfaces": "joints", "interface_joints_on": "all", "interface_joints_law": "brittle",
            "interface_joints_tension": 1e5, "interface_joints_cohesion": 2e5, "interface_joints_friction": 30.0}


SOFTENING = {**BREAKING, "interface_joints_law": "softening", "interface_joints_gi": 5.0, "interface_joints_gii": 20.0}
DILATION = {"interface_joints_dilation": 10.0, "interface_joints_dilation_slip": 1e-3}


# dashpots below and on two sides, with edges in common, one of them with a held component; a wave from below
QUIET = {"boundaries": ("zmin", "zmax", "xmin", "ymax"), "boundary_zmin_quiet": True, "boundary_xmin_quiet": True,
         "boundary_zmin_velocity": (0.5, 0.2, 0.8), "boundary_ymax_fix": "y"}


def box(shape):
    return {"mesh": "box", "mesh_box_cells": (4, 4, 6), "mesh_box_size": (2, 2, 3), "mesh_box_shape": shape,
            "mesh_box_jitter": 0.15}


def scene(name, folder):
    """Options of a scene, and whether it must break."""
    base = {**BASE, "boundaries": ("zmin", "zmax")}
    if name == "torn by beta":
        return {**base, **box("hex"), **BREAKING, "damping_beta": 2e-5}, True
    if name.startswith("softening"):
        return {**base, **box("hex"), **SOFTENING, **(DILATION if "dilating" in name else {})}, True
    if name.startswith("brittle dilating"):
        return {**base, **box("hex"), **BREAKING, **DILATION}, True
    if name.startswith("quiet "):
        still = {key: value for key, value in base.items() if key != "boundary_zmin_displacement"}
        return {**still, **box(name.split()[1]), **BREAKING, **QUIET}, True
    if name.startswith("torn "):
        return {**base, **box(name.split()[1]), **BREAKING}, True
    if name.startswith("joined "):
        return {**base, **box(name.split()[1])}, False
    path = folder / "fault.msh"  # two joined bodies on one brittle fault
    folder.mkdir(parents=True, exist_ok=True)
    meshes.hexahedra(path, np.linspace(0, 2, 5), np.linspace(0, 2, 5), np.linspace(0, 3, 7),
                     lambda centre: "lower" if centre[2] < 1.5 else "upper",
                     move=lambda points: meshes.jitter(points, 0.05, 2))
    fault = {key.replace("joints", "fault"): value for key, value in BREAKING.items()}
    return {**base, "mesh": path, **fault, "interfaces": "fault", "interface_fault_on": "between:lower:upper"}, True


SCENES = ["torn hex", "torn tet", "torn wedge", "torn by beta", "softening", "softening dilating", "brittle dilating",
          "joined hex", "joined tet", "fault", "quiet hex", "quiet tet"]


def result(folder, options, **keywords):
    """Everything a run says about the motion, as bytes."""
    found = harness.run(folder, options, **keywords)
    content = {"histories.csv": (found.out / "histories.csv").read_bytes()}
    for series in ("fields", "interfaces"):
        if series == "interfaces" and "interfaces" not in options:
            continue
        for i, (time, frame) in enumerate(found.frames(series)):
            content[f"{series} {i} time"] = np.float64(time).tobytes()
            for name in ("points", "connectivity"):
                content[f"{series} {i} {name}"] = getattr(frame, name).tobytes()
            for name, data in {**frame.point_data, **frame.cell_data}.items():
                content[f"{series} {i} {name}"] = data.tobytes()
    content["steps, dt, broken"] = repr([found.summary[k] for k in ("steps", "dt", "broken_springs")]).encode()
    return content, found.summary


def assert_equal(one, other, what):
    assert one.keys() == other.keys()
    different = [key for key in one if one[key] != other[key]]
    assert not different, f"{what}: first differences in {different[:5]}"


@pytest.fixture(scope="module")
def reference(tmp_path_factory):
    """Each scene's options and its run on one rank, made once."""
    made = {}

    def get(name):
        if name not in made:
            folder = tmp_path_factory.mktemp("reference")
            options, breaks = scene(name, folder)
            content, summary = result(folder / "run", options)
            assert summary["steps"] == STEPS
            assert not breaks or 0 < summary["broken_springs"], "the scene is meant to break springs"
            made[name] = options, content
        return made[name]

    return get


@pytest.mark.parametrize("name", SCENES)
def test_run_equals_run(name, reference, tmp_path):
    options, content = reference(name)
    assert_equal(content, result(tmp_path / "again", options)[0], "a second run")


@pytest.mark.parametrize("ranks", [2, 3])
@pytest.mark.parametrize("name", SCENES)
def test_ranks(name, ranks, reference, tmp_path):
    options, content = reference(name)
    assert_equal(content, result(tmp_path / "ranks", options, ranks=ranks)[0], f"{ranks} ranks")


@pytest.mark.parametrize("batch", [1, 7, 1000])
@pytest.mark.parametrize("name", SCENES)
def test_batches(name, batch, reference, tmp_path):
    options, content = reference(name)
    assert_equal(content, result(tmp_path / "batch", {**options, "ts_central_batch": batch})[0], f"batches of {batch}")


@pytest.mark.parametrize("name,ranks", [(name, 1) for name in SCENES] + [("torn hex", 2), ("quiet tet", 2)])
def test_observers_leave_the_run_alone(name, ranks, reference, tmp_path):
    options, content = reference(name)
    watched = {**options, "monitor_energy": "ascii:energy.txt", "monitor_energy_interval": 3,
               "monitor_convergence": "ascii:convergence.txt", "monitor_convergence_interval": 5}
    assert_equal(content, result(tmp_path / "watched", watched, ranks=ranks)[0], "a watched run")
