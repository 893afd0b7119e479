"""Restart within stages and relaxations: a run that stops at any step of any stage, or just between two, and goes on
equals one that never stopped, to the last bit, on the same and on another number of ranks; and after kills.

By hand: CDEM_RESTART_STAGES=100 draws more scenes, CDEM_RESTART_KILLS=200 kills more often."""
import os
import random
import shutil
import subprocess
import sys
from pathlib import Path

import h5py
import pytest

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "verification"))
import harness  # noqa: E402
import meshes  # noqa: E402
from test_restart import KILLS, RANKS, frames, last_checkpoint  # noqa: E402

SCENES = int(os.environ.get("CDEM_RESTART_STAGES", 16))
FRAME = 50

STRENGTH = {"cohesion": 4e4, "friction": 30.0, "tension": 2e4}
BLOCKS = {
    "elastic": {},
    "mohr_coulomb": {**STRENGTH, "law": "mohr_coulomb"},
    "breakage": {**STRENGTH, "law": "breakage", "residual_cohesion": 1e4},
    "releasing": {**STRENGTH, "law": "breakage", "release_interfaces": "true", "tension_scatter": "weibull:3"},
}
BRITTLE = {"on": "all", "law": "brittle", "tension": 2e4, "cohesion": 4e4, "friction": 30.0}
INTERFACES = {
    "none": None,
    "springs": {"on": "all", "law": "elastic"},
    "brittle": BRITTLE,
    "softening dilating": {**BRITTLE, "law": "softening", "gi": 1.0, "gii": 4.0, "dilation": 10.0},
}
DAMPING = ["rayleigh", "local", "combined", "kinetic"]
# What a stage does besides its name; the first one relaxes, the last one moves.
MIDDLE = {
    "dig": {"remove": "soil", "reset": "displacement"},
    "soften": {"block_rock_young": 1.5e9, "damping_beta": 1e-5},
    "weaken": {"strength_factor": 1.7, "reset": "displacement"},
    "push": {"boundary_top_pressure": 3e4, "boundary_top_table": "time", "intact": None},
    "quiet": {"boundary_base_quiet": "true"},
    "again": {"solve": "relax", "gravity": (1.0, 0, -9.81), "relax_ratio": 0.3, "relax_kinetic": 0.7},
}


def drawn(seed):
    rng = random.Random(seed)
    blocks, interfaces = list(BLOCKS), list(INTERFACES)
    block, interface = blocks[seed % 4], interfaces[(seed // 4 + seed) % 4]
    if block == "releasing" and interface in ("none", "springs"):
        interface = "brittle"
    middle = rng.sample(list(MIDDLE), 2)
    if seed < len(MIDDLE):
        middle[0] = list(MIDDLE)[seed]
        middle = list(dict.fromkeys(middle))
    if "quiet" in middle:  # on dashpots alone nothing comes to rest under another load
        middle = ["push" if name == "again" else name for name in middle]
        middle = list(dict.fromkeys(middle))
    return block, interface, DAMPING[(seed + seed // 4) % 4], middle, rng


def mesh(folder, seed):
    """Rock below, soil above; nodes out of place."""
    folder.mkdir(parents=True, exist_ok=True)
    grid, up = [0.0, 1.0, 2.0, 3.0], [0.0, 1.0, 2.0, 3.0, 4.0]
    meshes.hexahedra(folder / "parts.msh", grid, grid, up, lambda centre: "soil" if centre[2] > 3 else "rock",
                     side=lambda name, _: {"zmin": "base", "zmax": "top"}.get(name),
                     move=lambda points: 0.5 * meshes.jitter(points, 0.12, seed), tetrahedra=seed % 3 == 1)


def scene(seed):
    """Options, and the names of the stages."""
    block, interface, damping, middle, rng = drawn(seed)
    names = ["settle", *middle, "shake"]
    options = {
        "mesh": "../parts.msh", "block_young": 2e9, "block_poisson": 0.25, "block_density": 2200.0, "gravity": (0, 0, -9.81),
        "boundaries": ("base", "top"), "boundary_base_fix": "xyz", "boundary_top_pressure": 2e4, "tables": "time",
        "table_time_type": "ramp", "table_time_delay": 0.002, "seed": seed + 1,
        "histories": ("up", "inner"), "history_up_at": (1.5, 1.5, 2.0), "history_up_of": "displacement_z",
        "history_inner_at": (0.5, 0.5, 0.5), "history_inner_of": "velocity_x", "history_interval": rng.choice([1, 1, 7]),
        "output_interval": FRAME, "checkpoint_interval": 1000000, "stages": names,
        "solve": "relax", "relax_damping": damping, "relax_ratio": 1e-2, "relax_kinetic": 1e-2, "relax_max_steps": 20000,
        "relax_interval": rng.choice([10, 40]), "relax_density_scaling": rng.choice([True, False]),
        "stage_settle_intact": None,
        "stage_shake_boundary_base_velocity": (0.6, 0.0, 0.3), "stage_shake_solve": "dynamic", "stage_shake_ts_max_steps": 70,
    }
    if "quiet" not in middle:
        options.update({"stage_shake_boundary_base_fix": "y", "stage_shake_boundary_base_components": "xz"})
    if block == "elastic" and seed % 2 == 0:  # offsets from the start
        options.update({"block_stress": (-2e4, -3e4, -8e4, 0, 0, 0), "block_stress_gradient_z": (0, 0, 2e4, 0, 0, 0)})
    if rng.random() < 0.3:
        options["damping_alpha"] = 30.0
    options.update({f"block_{key}": value for key, value in BLOCKS[block].items()})
    if INTERFACES[interface]:
        options["interfaces"] = "faces"
        options.update({f"interface_faces_{key}": value for key, value in INTERFACES[interface].items()})
    for name in middle:
        options.update({f"stage_{name}_{key}": value for key, value in {"solve": "dynamic", **MIDDLE[name]}.items()})
        if options[f"stage_{name}_solve"] == "dynamic":
            options[f"stage_{name}_ts_max_steps"] = rng.choice([47, 60])
    if block == "elastic" and interface in ("none", "springs"):  # nothing that could be weakened
        options.pop("stage_settle_intact")
    if seed % 5 == 2:
        options["stage_shake_ts_max_time"] = 1.0  # the step is fitted to it
    return options, names


def ends(results):
    """Step at which each stage ended."""
    total, found = 0, []
    for stage in results.summary["stages"]:
        total += stage["steps"]
        found.append(total)
    return found


def stop_at(folder, options, names, last, step, first, ranks):
    """Runs up to a step of stage number last, which began at step first, and leaves a checkpoint there."""
    part = {**options, "stages": names[:last + 1], "output": "out"}
    for key in options:
        if any(key.startswith(f"stage_{name}_") for name in names[last + 1:]):
            del part[key]
    relaxes = part.get(f"stage_{names[last]}_solve", part["solve"]) == "relax"
    part[f"stage_{names[last]}_{'relax' if relaxes else 'ts'}_max_steps"] = step - first
    done = harness.call(folder, part, ranks=ranks)
    assert (folder / "out" / f"checkpoint_{step}.h5").exists(), done.stdout[-2000:] + done.stderr[-2000:]
    assert done.returncode == 0 or "not in balance" in done.stderr, done.stderr


def assert_same(out, straight, step, stops):
    name = f"checkpoint_{step}.h5"
    assert (out / name).read_bytes() == (straight / name).read_bytes(), "the state at the end"
    assert (out / "histories.csv").read_bytes() == (straight / "histories.csv").read_bytes()
    found, wanted = frames(out), frames(straight)
    for series, steps in found.items():
        for stop in stops:
            if stop not in wanted[series]:
                del steps[stop]
    assert found == wanted


@pytest.mark.parametrize("seed", range(SCENES))
def test_restart_equals_straight_run(seed, tmp_path):
    """Twice interrupted: somewhere within a stage, and just where another one ends."""
    mesh(tmp_path / "straight", seed)
    shutil.copytree(tmp_path / "straight", tmp_path / "parts")
    shutil.move(tmp_path / "parts" / "parts.msh", tmp_path / "parts.msh")
    options, names = scene(seed)
    straight = harness.run(tmp_path / "straight", options)
    end, rng = [0, *ends(straight)], random.Random(100 + seed)
    before, after = RANKS[seed % len(RANKS)]
    within = [s for s in range(len(names)) if end[s + 1] - end[s] > 1]
    stage = within[seed % len(within)]
    stop = rng.randint(end[stage] + 1, end[stage + 1] - 1)
    edge = rng.randrange(len(names) - 1)
    folder = tmp_path / "parts"
    for last, step in ((stage, stop), (edge, end[edge + 1])):
        shutil.rmtree(folder / "out", ignore_errors=True)
        stop_at(folder, options, names, last, step, end[last], before)
        going_on = {**options, "restart": f"out/checkpoint_{step}.h5"}
        results = harness.run(folder, going_on, ranks=after)
        assert_same(results.out, straight.out, end[-1], [step])
        assert results.summary["steps"] == end[-1] and results.summary["restart"]["step"] == step
        assert results.summary["time"] == straight.summary["time"]
        assert [one["name"] for one in results.summary["stages"]] == names[last:]
    with h5py.File(straight.out / f"checkpoint_{end[-1]}.h5", "r") as file:
        assert file["CDEM/numbers/stage"][0] == len(names) - 1
        for name, group in file["CDEM"].items():
            assert "state" not in group or group["state"][:].any(), f"nothing has happened to {name}"


def test_scenes_have_everything():
    seen = [drawn(seed)[:4] for seed in range(16)]
    assert {one[0] for one in seen} == set(BLOCKS) and {one[1] for one in seen} == set(INTERFACES)
    assert {one[2] for one in seen} == set(DAMPING) and {name for one in seen for name in one[3]} == set(MIDDLE)


@pytest.mark.parametrize("damping", DAMPING)
def test_relaxation_without_stages(damping, tmp_path):
    """Interrupted at a step between two checks, with the very limits of the straight run once it has ended."""
    options = {"mesh": "box", "mesh_box_cells": (2, 2, 8), "mesh_box_size": (2, 2, 8), "mesh_box_jitter": 0.2,
               "block_young": 1e9, "block_poisson": 0.2, "block_density": 2000.0, "gravity": (0, 0, -10.0),
               "boundaries": "zmin", "boundary_zmin_fix": "xyz", "solve": "relax", "relax_damping": damping, "relax_ratio": 1e-3,
               "checkpoint_interval": 1000000}
    straight = harness.run(tmp_path / "straight", options)
    end = straight.summary["steps"]
    part = harness.call(tmp_path, {**options, "relax_max_steps": end // 2 + 7, "output": "out"}, ranks=2)
    assert part.returncode == 1 and "not in balance" in part.stderr
    for step, ranks in ((end // 2 + 7, 3), (end, 2)):
        out = harness.run(tmp_path, {**options, "restart": f"out/checkpoint_{step}.h5"}, ranks=ranks).out
        assert (out / f"checkpoint_{end}.h5").read_bytes() == (straight.out / f"checkpoint_{end}.h5").read_bytes()
        assert harness.Results(tmp_path, "out", 0, "").summary["stages"][0]["balanced"]


# One scene for what does not depend on the laws.
PLAIN, NAMES = scene(0)


@pytest.fixture(scope="module")
def stopped(tmp_path_factory):
    """A folder with a run that ended in its second stage, and its checkpoint."""
    folder = tmp_path_factory.mktemp("stopped") / "run"
    mesh(folder.parent, 0)
    whole = ends(harness.run(folder.parent / "whole", PLAIN))
    stop_at(folder, PLAIN, NAMES, 1, whole[0] + 11, whole[0], 1)
    return folder, whole, whole[0] + 11


REFUSED = [
    ({"stage_settle_gravity": (0, 0, -9.0)}, "-stage_settle_gravity was not given and is 0,0,-9.0 now"),
    ({f"stage_{NAMES[1]}_block_rock_young": 1.1e9}, "block_rock_young was not given and is 1100000000.0 now"),
    ({"stages": ["settle", "shake"]}, "-stages was settle,"),
    ({"stages": ["settle"]}, "is of stage number 2, and there are 1"),
    ({"relax_damping": "local"}, "-relax_damping was"),
    ({"stage_settle_relax_ratio": 1e-3}, "other lengths or time tables of the stages before"),
    ({f"stage_{NAMES[1]}_ts_max_steps": 5}, f"is at step 11: steps count from the start of stage '{NAMES[1]}'"),
]


@pytest.mark.parametrize("change, message", REFUSED, ids=[next(iter(change)) + f" {i}" for i, (change, _) in enumerate(REFUSED)])
def test_refused(change, message, stopped):
    folder, _, stop = stopped
    before = {path.name: path.read_bytes() for path in (folder / "out").iterdir()}
    options = {**PLAIN, "output": "out", "restart": f"out/checkpoint_{stop}.h5", **change}
    left = [name for name in NAMES if name not in options["stages"]]
    options = {key: value for key, value in options.items() if not any(key.startswith(f"stage_{name}_") for name in left)}
    done = harness.call(folder, options)
    assert done.returncode == 1 and done.stderr.count("cdem: error: ") == 1, done.stdout + done.stderr
    assert message in done.stderr, done.stderr
    assert {path.name: path.read_bytes() for path in (folder / "out").iterdir()} == before


def test_what_comes_later_may_change(stopped, tmp_path):
    """Other later stages, other ends of this one."""
    folder, whole, stop = stopped
    mesh(tmp_path, 0)
    restart = {**PLAIN, "restart": folder / "out" / f"checkpoint_{stop}.h5", "stage_shake_gravity": (0, 0, -5.0),
               f"stage_{NAMES[1]}_ts_max_steps": 30}
    summary = harness.run(tmp_path / "other", restart).summary
    assert summary["stages"][0]["steps"] == 30 and [one["name"] for one in summary["stages"]] == NAMES[1:]


@pytest.mark.parametrize("ranks", [1, 2])
def test_kills(ranks, tmp_path):
    """SIGKILL at any moment of any stage, again and again: in the end the results are those of a run that nobody killed."""
    mesh(tmp_path, 5)
    options, names = scene(5)
    options = {**options, "checkpoint_interval": 7 * ranks}
    straight = harness.run(tmp_path / "straight", options)
    end = straight.summary["steps"]
    rng, kills, folder = random.Random(ranks), 0, tmp_path / "killed"
    out, typical, stages = folder / "out", 0.3 + straight.wall, set()
    folder.mkdir()
    while kills < max(2, KILLS // ranks**2) or not stages:
        shutil.rmtree(out, ignore_errors=True)
        for attempt in range(1000):
            step = last_checkpoint(out) if out.exists() else None
            start = {"restart": f"out/checkpoint_{step}.h5"} if step else {"output_overwrite": None}
            if step:
                with h5py.File(out / f"checkpoint_{step}.h5", "r") as file:
                    stages.add(int(file["CDEM/numbers/stage"][0]))
            lines = [f"-{key}" if value is None else f"-{key} {harness.as_text(value)}"
                     for key, value in {**options, "output": "out", **start}.items()]
            (folder / "scene.txt").write_text("\n".join(lines) + "\n")
            command = [*(harness.MPIRUN + ["-n", str(ranks)] if ranks > 1 else []), harness.program(), "-options_file",
                       "scene.txt"]
            with open(folder / "log", "w") as log:
                run = subprocess.Popen(command, cwd=folder, env=harness.environment(ranks), stdout=log, stderr=log)
                try:
                    run.wait(rng.uniform(0.1, typical * (1 + attempt / 4)))
                    assert run.returncode == 0, (folder / "log").read_text()
                except subprocess.TimeoutExpired:
                    kills += 1
                finally:
                    harness.kill(run)
            if run.returncode == 0:
                break
        assert_same(out, straight.out, end, [])
