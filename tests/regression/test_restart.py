"""A run that stops at a checkpoint and goes on equals one that never stopped, to the last bit: state, histories, frames,
for scenes drawn from all laws and forms, on the same and on another number of ranks; whatever kills it on the way; and a
checkpoint that is damaged or of another scene is refused before anything is touched.

By hand: CDEM_RESTART_SCENES=200 draws more scenes, CDEM_RESTART_KILLS=200 kills more often."""
import json
import os
import random
import shutil
import subprocess
import sys
from pathlib import Path

import h5py
import numpy as np
import pytest

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "verification"))
import harness  # noqa: E402

SCENES = int(os.environ.get("CDEM_RESTART_SCENES", 20))
WATCHED = 12  # the scenes before this one run in test_energy.py, with the energy balance
KILLS = int(os.environ.get("CDEM_RESTART_KILLS", 6))
RANKS = [(1, 1), (2, 2), (2, 3), (1, 3)]  # before and after the checkpoint
STEPS, FRAME = 120, 40
AT_THE_END = {"checkpoint_interval": 1000000}  # a checkpoint at the end alone

STRENGTH = {"cohesion": 4e4, "friction": 30.0}  # near that of the interfaces, so that both fail
# law and form of the blocks: shapes that have it, options
BLOCKS = {
    "elastic": ("hex tet wedge", {}),
    "onepoint": ("hex", {"element": "onepoint"}),
    "drucker_prager": ("hex tet wedge", {**STRENGTH, "tension": 2e4, "dilation": 10.0}),
    "softening cone": ("hex wedge", {**STRENGTH, "law": "drucker_prager", "tension": 2e4, "gf": 20.0}),
    "mohr_coulomb": ("hex wedge", {**STRENGTH, "tension": 2e4, "element": "bbar"}),
    "bbar tetrahedra": ("tet", {**STRENGTH, "law": "mohr_coulomb", "element": "bbar", "tension": 2e4}),
    "breakage": ("hex tet wedge", {**STRENGTH, "tension": 2e4, "residual_cohesion": 1e4}),
    "scattered breakage": ("hex", {**STRENGTH, "law": "breakage", "tension": 2e4, "tension_scatter": "weibull:3",
                                   "cohesion_scatter": "normal:0.2"}),
    "releasing breakage": ("hex", {**STRENGTH, "law": "breakage", "tension": 2e4, "release_interfaces": "true"}),
    "spring": ("hex", {**STRENGTH, "tension": 2e4}),
}
BRITTLE = {"law": "brittle", "tension": 2e4, "cohesion": 4e4, "friction": 30.0}
SOFT = {**BRITTLE, "law": "softening", "gi": 1.0, "gii": 4.0}
INTERFACES = {
    "none": None,
    "springs": {"law": "elastic"},
    "brittle": BRITTLE,
    "broken": {**BRITTLE, "initial": "broken"},
    "keeping tension": {**BRITTLE, "keep_tension": "true"},
    "brittle dilating": {**BRITTLE, "dilation": 10.0, "dilation_slip": 1e-3},
    "scattered": {**BRITTLE, "cohesion_scatter": "weibull:4", "kn_scatter": "uniform:0.3"},
    "softening": SOFT,
    "softening dilating": {**SOFT, "dilation": 10.0},
    "joint set": {**BRITTLE, "on": "joints:steep"},
}
LOADS = ["pulse", "velocity", "ramp"]
DAMPING = [{}, {"damping_alpha": 2.0}, {"damping_beta": 2e-5}, {"damping_alpha": 5.0, "damping_beta": 1e-5}]


def drawn(seed):
    """Names of what a scene is made of; the first scenes go through all laws, later ones mix them anew."""
    rng = random.Random(seed)
    blocks, interfaces = list(BLOCKS), list(INTERFACES)
    block = blocks[seed % len(blocks)]
    interface = interfaces[(3 * seed + seed // len(blocks)) % len(interfaces)]
    if "releasing" in block and interface in ("none", "springs"):
        interface = "brittle"
    return block, rng.choice(BLOCKS[block][0].split()), interface, rng.choice(LOADS), rng.randrange(len(DAMPING)), rng


def scene(seed):
    """Options of a scene, and whether something in it has a history that must not stay empty."""
    block, shape, interface, load, damping, rng = drawn(seed)
    options = {
        "mesh": "box", "mesh_box_cells": (3, 3, 4), "mesh_box_size": (1.5, 1.5, 2), "mesh_box_shape": shape,
        "mesh_box_jitter": 0.15, "block_young": 2e9, "block_poisson": 0.25, "block_density": 2200.0,
        "gravity": (0, 0, -9.81), "velocity": (0.3, -0.1, 0.0), "seed": seed + 1, "tables": "time",
        "boundaries": ("zmin", "zmax"), "boundary_zmax_pressure": 2e4, "histories": ("top", "inner"),
        "history_top_at": (1.5, 1.5, 2.0), "history_top_of": "displacement_z", "history_inner_at": (0.5, 0.5, 0.5),
        "history_inner_of": "velocity_x", "history_interval": rng.choice([1, 1, 7]), "output_interval": FRAME,
        **DAMPING[damping],
    }
    law = {"law": block, **BLOCKS[block][1]} if block not in ("elastic", "onepoint") else BLOCKS[block][1]
    options.update({f"block_{key}": value for key, value in law.items()})
    if load == "pulse":
        options.update({"table_time_type": "ricker", "table_time_frequency": 300.0, "table_time_delay": 0.003,
                        "boundary_zmin_displacement": (2e-3, 0.0, 1e-3), "boundary_zmin_table": "time"})
    elif load == "velocity":
        options.update({"table_time_type": "sine", "table_time_frequency": 100.0, "boundary_zmin_table": "time",
                        "boundary_zmin_velocity": (1.0, 0.0, 0.5), "boundary_zmin_components": "xz"})
    else:
        options.update({"table_time_type": "ramp", "table_time_delay": 0.002, "boundary_zmin_velocity": (0.0, 0.0, 1.0),
                        "boundary_zmin_table": "time", "boundary_zmax_fix": "z", "boundary_zmax_traction": (3e4, 0, 0),
                        "boundary_zmax_table": "time"})
        del options["boundary_zmax_pressure"]
    if INTERFACES[interface]:
        options["interfaces"] = "faces"
        options.update({f"interface_faces_{key}": value for key, value in {"on": "all", **INTERFACES[interface]}.items()})
    if interface == "joint set":
        options.update({"joints": "steep", "joint_steep_p32": 2.0, "joint_steep_dip": 70.0, "joint_steep_dip_direction": 30.0,
                        "joint_steep_fisher": 30.0, "joint_steep_diameter": "uniform:1,3"})
    options["ts_max_steps"] = STEPS
    if seed % 3 == 0:
        options["ts_max_time"] = 1.0  # the step is fitted to it
    has_history = block not in ("elastic", "onepoint") or interface not in ("none", "springs")
    return options, has_history


def frames(folder):
    """{series: {step: content}} of all that the series list."""
    content = {}
    for path in sorted(folder.glob("*.hdf.series")):
        steps = content.setdefault(path.name, {})
        for entry in json.loads(path.read_text())["files"]:
            with h5py.File(folder / entry["name"], "r") as file:
                top, one = file["VTKHDF"], {"time": entry["time"]}
                top.visititems(lambda name, data: one.__setitem__(name, data[()].tobytes())
                               if isinstance(data, h5py.Dataset) else None)
                step = int(top["FieldData/Step"][0])
                assert step not in steps
                steps[step] = one
        assert list(steps) == sorted(steps)
    return content


def assert_same_results(out, straight, stops=()):
    """[in] stops: where a run ended and wrote the frame of its end, which stays."""
    name = f"checkpoint_{STEPS}.h5"
    assert (out / name).read_bytes() == (straight / name).read_bytes(), "the state at the end"
    assert (out / "histories.csv").read_bytes() == (straight / "histories.csv").read_bytes()
    found, wanted = frames(out), frames(straight)
    for steps in found.values():
        for stop in stops:
            assert stop in steps
            if stop % FRAME and stop != STEPS:
                del steps[stop]
    assert found == wanted


def straight_and_interrupted(seed, folder, more=(), between=lambda: None):
    """Runs scene number seed, with more options, straight and with a stop on the way, and compares the results; calls
    between() at the stop."""
    options, has_history = scene(seed)
    options = {**options, **AT_THE_END, **dict(more)}
    before, after = RANKS[seed % len(RANKS)]
    if max(before, after) > 1:  # the straight run has one rank, and so may go a faster way on a GPU
        options["deterministic"] = None
    stop = random.Random(1000 + seed).randint(1, STEPS - 1)
    straight = harness.run(folder / "straight", options).out
    harness.run(folder / "parts", {**options, "ts_max_steps": stop}, ranks=before)
    between()
    out = harness.run(folder / "parts", {**options, "restart": f"out/checkpoint_{stop}.h5"}, ranks=after).out
    assert_same_results(out, straight, [stop])
    assert {path.name for path in out.glob("checkpoint_*")} == {f"checkpoint_{stop}.h5", f"checkpoint_{STEPS}.h5"}
    summary = json.loads((out / "summary.json").read_text())
    assert summary["steps"] == STEPS and summary["restart"]["step"] == stop
    with h5py.File(out / f"checkpoint_{stop}.h5", "r") as file:
        states = [group["state"][:] for group in file["CDEM"].values() if "state" in group]
        assert bool(states) == has_history
    with h5py.File(out / f"checkpoint_{STEPS}.h5", "r") as file:
        for name, group in file["CDEM"].items():
            assert "state" not in group or group["state"][:].any(), f"nothing has happened to {name}"


@pytest.mark.parametrize("seed", range(WATCHED, SCENES))
def test_restart_equals_straight_run(seed, tmp_path):
    straight_and_interrupted(seed, tmp_path)


def test_scenes_have_everything():
    seen = [drawn(seed)[:5] for seed in range(20)]
    for i, all_of_them in enumerate((BLOCKS, ("hex", "tet", "wedge"), INTERFACES, LOADS, range(len(DAMPING)))):
        assert {one[i] for one in seen} == set(all_of_them)


# One scene for what does not depend on the laws.
PLAIN = {**scene(6)[0], **AT_THE_END, "history_interval": 1}
STOP = 47


@pytest.fixture(scope="module")
def stopped(tmp_path_factory):
    """A folder with a run that ended at STOP."""
    folder = tmp_path_factory.mktemp("stopped")
    harness.run(folder, {**PLAIN, "ts_max_steps": STOP})
    return folder


def content(folder):
    return {path.name: path.read_bytes() for path in folder.iterdir()}


def first_column(path):
    return [int(line.split(",")[0]) for line in path.read_text().splitlines()[1:]]


def test_other_folder(stopped, tmp_path):
    """Files in another folder begin at the step of the checkpoint, whose folder stays as it is."""
    before = content(stopped / "out")
    restart = {**PLAIN, "restart": stopped / "out" / f"checkpoint_{STOP}.h5"}
    out = harness.run(tmp_path, restart).out
    assert content(stopped / "out") == before
    assert first_column(out / "histories.csv") == list(range(STOP, STEPS + 1))
    assert list(frames(out)["fields.hdf.series"]) == [STOP, 80, 120]
    again = harness.run(tmp_path / "with other watchers",
                        {**restart, "history_inner_at": (0, 0, 0), "output_interval": 1000, "output_fields": "stress"}).out
    for name in ("numbers", "nodes"):
        with h5py.File(out / f"checkpoint_{STEPS}.h5") as one, h5py.File(again / f"checkpoint_{STEPS}.h5") as other:
            for key in one[f"CDEM/{name}"]:
                assert one[f"CDEM/{name}/{key}"][:].tobytes() == other[f"CDEM/{name}/{key}"][:].tobytes()
    without = harness.call(tmp_path, {key: value for key, value in restart.items()
                                      if not key.startswith(("output", "histor", "checkpoint"))})
    assert without.returncode == 0 and f"done        {STEPS} steps" in without.stdout, without.stderr


def test_restart_at_the_end_changes_nothing(stopped, tmp_path):
    shutil.copytree(stopped / "out", tmp_path / "out")
    results = harness.run(tmp_path, {**PLAIN, "ts_max_steps": STOP, "restart": f"out/checkpoint_{STOP}.h5"})
    before, after = content(stopped / "out"), content(tmp_path / "out")
    for changing in ("summary.json", "scene.opts"):
        del before[changing], after[changing]
    assert before == after and results.summary["steps"] == STOP


def test_later_results_go(stopped, tmp_path):
    """From an older checkpoint of a finished run: rows, frames and checkpoints after it are made anew."""
    options = {**PLAIN, "checkpoint_interval": 50}
    straight = harness.run(tmp_path / "straight", options).out
    out = harness.run(tmp_path / "again", options).out
    with open(out / "histories.csv", "a") as file:
        file.write("121,0.5")  # as a kill leaves it
    (out / "fields_000009.hdf.part").write_text("half")
    (out / "notes.txt").write_text("mine")
    harness.run(tmp_path / "again", {**options, "restart": "out/checkpoint_100.h5", "ts_max_steps": 110})
    assert first_column(out / "histories.csv") == list(range(111))
    assert list(frames(out)["fields.hdf.series"]) == [0, 40, 80, 110]
    assert {path.name for path in out.glob("*.h5")} == {"checkpoint_100.h5", "checkpoint_110.h5", "fields_mesh_000.h5",
                                                       "interfaces_mesh_000.h5"}
    assert not list(out.glob("*.part")) and (out / "notes.txt").read_text() == "mine"
    harness.run(tmp_path / "again", {**options, "restart": "out/checkpoint_100.h5"})
    assert_same_results(out, straight)


def test_end_in_seconds(tmp_path):
    """Without -ts_dt the step stays that of the checkpoint, though another end would have fitted another one; a run whose
    last step was cut goes on with the whole step."""
    options = {key: value for key, value in PLAIN.items() if key != "ts_max_steps"}
    first = harness.run(tmp_path, {**options, "ts_max_time": 0.003, "ts_dt": 2.5e-5 * 1.013})
    stop = first.summary["steps"]
    assert first.summary["time"] == 0.003
    restart = {**options, "restart": f"out/checkpoint_{stop}.h5", "ts_max_time": 0.0045}
    second = harness.run(tmp_path, restart)
    assert second.summary["dt"] == first.summary["dt"] and second.summary["time"] == 0.0045
    times = second.histories()["time"]
    gaps = np.diff(times)
    assert (gaps > 0).all()
    np.testing.assert_allclose(np.delete(gaps, [stop - 1, len(gaps) - 1]), first.summary["dt"], rtol=1e-9)
    late = harness.call(tmp_path, {**restart, "output": "out", "ts_max_time": 0.001})
    assert late.returncode == 1 and "-ts_max_time is 0.001 s" in late.stderr and "later end" in late.stderr


def test_another_step(tmp_path):
    """-ts_dt may change: the kick across it is over the mean of both steps, so second order stays. With a kick over one
    of them alone the error would be of the size of dt times the acceleration."""
    dt, steps = 1e-5, 400
    options = {"mesh": "box", "mesh_box_cells": (2, 2, 6), "mesh_box_size": (1, 1, 3), "block_young": 1e8,
               "block_poisson": 0.2, "block_density": 2000.0, "boundaries": "zmin", "boundary_zmin_fix": "xyz",
               "gravity": (0, 0, -10.0), "ts_dt": dt, "ts_max_time": steps * dt, "checkpoint_interval": steps // 2}
    whole = harness.run(tmp_path / "whole", options)
    out = harness.run(tmp_path / "half", {**options, "restart": f"../whole/out/checkpoint_{steps // 2}.h5", "ts_dt": dt / 8})
    assert out.summary["steps"] == steps // 2 + 4 * steps and out.summary["dt"] == dt / 8
    field = [run.last_frame().point_data["displacement"] for run in (whole, out)]
    assert np.abs(field[0] - field[1]).max() < 2e-5 * np.abs(field[0]).max()


REFUSED = [
    ({"block_young": 2.1e9}, "-block_young was 2000000000.0 and is 2100000000.0 now"),
    ({"interface_faces_cohesion": 3e5}, "-interface_faces_cohesion was"),
    ({"interface_faces_law": "elastic", "interface_faces_tension": None}, ""),
    ({"boundary_zmax_pressure": 1e4}, "-boundary_zmax_pressure was 20000.0 and is 10000.0 now"),
    ({"boundary_zmin_fix": "y"}, "-boundary_zmin_fix was not given and is y now"),
    ({"boundary_zmax_quiet": "true"}, "-boundary_zmax_quiet was not given and is true now"),
    ({"seed": 99}, "-seed was"),
    ({"damping_alpha": 77.0}, "-damping_alpha was"),
    ({"gravity": (0, 0, -9.8)}, "-gravity was 0,0,-9.81 and is 0,0,-9.8 now"),
    ({"mesh_box_cells": (3, 3, 5)}, "72 elements, and 90 now"),
    ({"mesh_box_size": (1.5, 1.5, 2.1)}, "other coordinates of the mesh"),
    ({"table_time_delay": 0.004}, "-table_time_delay was"),
    ({"velocity": (0, 0, 0)}, "-velocity was 0.3,-0.1,0.0 and is 0,0,0 now"),
    ({"ts_max_steps": 20}, "-ts_max_steps is 20, but out/checkpoint_47.h5 is at step 47"),
    ({"histories": "top"}, "in which it would go on: there the columns are 'step,time,top,inner', and now 'step,time,top'"),
    ({"output_overwrite": None}, "-output_overwrite would remove the checkpoint"),
    ({"restart": "out/checkpoint_3.h5"}, "cannot read out/checkpoint_3.h5: No such file"),
    ({"restart": "out/fields_000000.hdf"}, "is no checkpoint"),
    ({"restart": "out/scene.opts"}, "is no HDF5 file"),
    ({"restart": "out"}, "out is no file"),
]


@pytest.mark.parametrize("change, message", REFUSED, ids=[next(iter(change)) + f" {i}" for i, (change, _) in enumerate(REFUSED)])
def test_refused(change, message, stopped, tmp_path):
    before = content(stopped / "out")
    options = {"output": "out", **PLAIN, "restart": f"out/checkpoint_{STOP}.h5", **change}
    if "histories" in change:
        options = {key: value for key, value in options.items() if not key.startswith("history_inner")}
    done = harness.call(stopped, options)
    assert done.returncode == 1 and done.stderr.count("cdem: error: ") == 1, done.stdout + done.stderr
    assert message in done.stderr and "HDF5-DIAG" not in done.stderr, done.stderr
    assert content(stopped / "out") == before


def test_checkpoints_need_a_folder(tmp_path):
    options = {key: value for key, value in PLAIN.items() if not key.startswith(("output", "histor"))}
    done = harness.call(tmp_path, options)
    assert done.returncode == 1 and "-checkpoint_interval needs a folder" in done.stderr
    assert "give -output DIR too" in done.stderr


def test_same_scene_in_other_words(stopped, tmp_path):
    """Numbers are compared as numbers; a default may be said or not."""
    shutil.copytree(stopped / "out", tmp_path / "out")
    harness.run(tmp_path, {**PLAIN, "restart": f"out/checkpoint_{STOP}.h5", "block_young": "20e8",
                           "gravity": "0.0,0,-981e-2", "block_element": "full", "interface_faces_initial": "intact"})


def test_mesh_file_has_changed(tmp_path):
    """Another mesh under the same name is known by its content; the same mesh may have moved."""
    import meshes
    grid = [0.0, 0.5, 1.0]
    for name, move in (("a.msh", lambda p: p), ("b.msh", lambda p: p * [1, 1, 1.0000001])):
        meshes.hexahedra(tmp_path / name, grid, grid, grid, lambda centre: "rock", move=move)
    options = {"mesh": "../a.msh", "block_young": 1e9, "block_poisson": 0.2, "block_density": 2000.0, **AT_THE_END,
               "velocity": (1, 0, 0), "ts_max_steps": 10}
    harness.run(tmp_path / "run", options)
    restart = {**options, "output": "out", "restart": "out/checkpoint_10.h5", "ts_max_steps": 20}
    shutil.move(tmp_path / "a.msh", tmp_path / "moved.msh")
    shutil.move(tmp_path / "b.msh", tmp_path / "a.msh")
    done = harness.call(tmp_path / "run", restart)
    assert done.returncode == 1 and "other coordinates of the mesh" in done.stderr and "is another, or -mesh" in done.stderr
    harness.run(tmp_path / "run", {**restart, "mesh": "../moved.msh"})


def test_damaged(stopped, tmp_path):
    """Cut anywhere, or with any byte changed: one clear error, or, where the byte was none of the content, the same run."""
    rng = random.Random(5)
    good = (stopped / "out" / f"checkpoint_{STOP}.h5").read_bytes()
    end = {**PLAIN, "ts_max_steps": STOP + 1, "output": "out", "output_overwrite": None, "restart": "damaged.h5"}
    (tmp_path / "damaged.h5").write_bytes(good)
    harness.run(tmp_path, end)
    wanted = (tmp_path / "out" / f"checkpoint_{STOP + 1}.h5").read_bytes()
    refused = 0
    for i in range(16):
        at = rng.randrange(len(good))
        bad = good[:at] if i < 4 else good[:at] + bytes([good[at] ^ (1 << rng.randrange(8))]) + good[at + 1:]
        (tmp_path / "damaged.h5").write_bytes(bad)
        done = harness.call(tmp_path, end)
        if done.returncode == 0:
            assert i >= 4 and (tmp_path / "out" / f"checkpoint_{STOP + 1}.h5").read_bytes() == wanted
            continue
        refused += 1
        assert done.returncode == 1 and done.stderr.count("cdem: error: ") == 1, done.stderr
        assert "damaged.h5" in done.stderr and "HDF5-DIAG" not in done.stderr, done.stderr
    assert refused > 8


def last_checkpoint(out):
    steps = [int(path.stem.split("_")[1]) for path in out.glob("checkpoint_*.h5")]
    return max(steps, default=None)


@pytest.mark.parametrize("ranks", [1, 2])
def test_kills(ranks, tmp_path):
    """SIGKILL at any moment, again and again: the last checkpoint is whole, no frame that was complete by then is lost,
    and in the end the results are those of a run that nobody killed."""
    often = 3 if ranks == 1 else 20
    options = {**scene(18)[0], "checkpoint_interval": often, "output_interval": 5 * ranks}
    straight = harness.run(tmp_path / "straight", options)
    wanted = frames(straight.out)
    rng, kills, folder = random.Random(ranks), 0, tmp_path / "killed"
    out, typical = folder / "out", 0.3 + straight.wall
    folder.mkdir()
    while kills < max(2, KILLS // ranks**2):
        shutil.rmtree(out, ignore_errors=True)
        for attempt in range(1000):
            step = last_checkpoint(out) if out.exists() else None
            start = {"restart": f"out/checkpoint_{step}.h5"} if step else {"output_overwrite": None}
            there = frames(out) if step else {}
            lines = [f"-{key}" if value is None else f"-{key} {harness.as_text(value)}"
                     for key, value in {**options, "output": "out", **start}.items()]
            (folder / "scene.txt").write_text("\n".join(lines) + "\n")
            command = [*(harness.MPIRUN + ["-n", str(ranks)] if ranks > 1 else []), harness.program(), "-options_file",
                       "scene.txt", *harness.device(options)]
            with open(folder / "log", "w") as log:
                run = subprocess.Popen(command, cwd=folder, env=harness.environment(ranks), stdout=log, stderr=log)
                try:
                    run.wait(rng.uniform(0.03 if step else 0.1, typical * (1 + attempt / 4)))
                    assert run.returncode == 0, (folder / "log").read_text()
                except subprocess.TimeoutExpired:
                    kills += 1
                finally:
                    harness.kill(run)
            if run.returncode == 0:
                break
            now = frames(out) if step and list(out.glob("*.series")) else {}
            for series, steps in there.items():  # complete before this attempt, and not after the checkpoint
                for n, frame in steps.items():
                    assert n > step or now[series][n] == frame
        name = f"checkpoint_{STEPS}.h5"
        assert (out / name).read_bytes() == (straight.out / name).read_bytes()
        assert (out / "histories.csv").read_bytes() == (straight.out / "histories.csv").read_bytes()
        assert frames(out) == wanted and not list(out.glob("*.part"))
