"""Relaxation and stages: balance against closed forms, stress from the start, removal, reset, changed stiffness."""
import math
import sys
from pathlib import Path

import numpy as np
import pytest

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "verification"))
import harness  # noqa: E402

COLUMN = {
    "mesh": "box", "mesh_box_cells": (2, 2, 40), "mesh_box_size": (2, 2, 40), "block_law": "elastic", "block_young": 1e10,
    "block_poisson": 0.0, "block_density": 2500.0, "gravity": (0, 0, -10), "boundaries": "zmin",
    "boundary_zmin_fix": "xyz", "histories": "top", "history_top_at": (1, 1, 40), "history_top_of": "displacement_z",
    "solve": "relax",
}
TOP = -2500 * 10 * 40**2 / 2 / 1e10  # rho g L^2 / 2 E
BRITTLE = {"interfaces": "j", "interface_j_on": "all", "interface_j_law": "brittle", "interface_j_tension": 1e8,
           "interface_j_cohesion": 1e8, "interface_j_friction": 30.0}
SOIL = {  # rock below z = 20, soil above: a column that only moves along z
    "mesh": str(harness.ROOT / "meshes" / "quiet_column.msh"), "block_law": "elastic", "block_poisson": 0.25,
    "block_rock_young": 3.52e9, "block_rock_density": 2200.0, "block_soil_young": 1.8e8, "block_soil_density": 1800.0,
    "gravity": (0, 0, -10), "boundaries": ("base", "sides"), "boundary_base_fix": "xyz", "boundary_sides_fix": "xy",
    "histories": "rock", "history_rock_at": (0, 0, 20), "history_rock_of": "displacement_z",
    "stages": ("settle", "dig"), "stage_settle_solve": "relax", "stage_dig_remove": "soil",
}
ROCK_MODULUS = 3.52e9 * 0.75 / (1.25 * 0.5)  # lambda + 2 mu


def rock_top(load):
    """Displacement of the rock's top under its own weight and a load [Pa] on it, strain along z only."""
    return -(2200 * 10 * 20**2 / 2 + load * 20) / ROCK_MODULUS


@pytest.mark.parametrize("damping, within", [("rayleigh", 1e-6), ("local", 1e-5), ("combined", 1e-5), ("kinetic", 1e-6)])
def test_column_comes_to_rest(damping, within, tmp_path):
    done = harness.run(tmp_path, {**COLUMN, "relax_damping": damping})
    stage = done.summary["stages"][0]
    assert stage["balanced"] and stage["unbalanced_ratio"] <= 1e-7
    assert abs(done.histories()["top"][-1] / TOP - 1) < within
    assert done.summary["time"] == 0, "a relaxation advances no time"


def test_scaled_masses_carry_the_true_weight(tmp_path):
    """Cells of different size: masses differ by much, displacements do not."""
    jitter = {**COLUMN, "mesh_box_jitter": 0.3, "block_poisson": 0.2, "mesh_box_cells": (2, 2, 20), "relax_ratio": 1e-8}
    tops = [harness.run(tmp_path / str(scaled), {**jitter, "relax_density_scaling": scaled}).histories()["top"][-1]
            for scaled in (True, False)]
    assert abs(tops[0] / tops[1] - 1) < 1e-6, tops


def test_no_balance_is_an_error_with_its_place(tmp_path):
    done = harness.call(tmp_path, {**COLUMN, "relax_max_steps": 50, "output": "out"})
    assert done.returncode == 1
    text = done.stdout + done.stderr
    for word in ("not in balance after 50 steps", "largest force out of balance", "N at (", "-relax_ratio"):
        assert word in text, text[-1500:]
    assert (tmp_path / "out" / "summary.json").exists(), "what was computed is kept"


LAWS = {
    "elastic": {}, "wedges": {"mesh_box_shape": "wedge"}, "tetrahedra": {"mesh_box_shape": "tet"},
    "drucker_prager": {"block_law": "drucker_prager", "block_cohesion": 1e7, "block_friction": 30.0},
    "mohr_coulomb": {"block_law": "mohr_coulomb", "block_cohesion": 1e7, "block_friction": 30.0},
    "breakage": {"block_law": "breakage", "block_cohesion": 1e7, "block_friction": 30.0, "block_tension": 1e6},
    "spring blocks": {"block_law": "spring", "block_cohesion": 1e7, "block_friction": 30.0, "block_tension": 1e6},
    "brittle springs": BRITTLE, "spring blocks, brittle springs": {
        **BRITTLE, "block_law": "spring", "block_cohesion": 1e7, "block_friction": 30.0, "block_tension": 1e6},
    "elastic springs": {**BRITTLE, "interface_j_law": "elastic", "interface_j_tension": None, "interface_j_cohesion": None,
                        "interface_j_friction": None},
    "softening springs": {**BRITTLE, "interface_j_law": "softening", "interface_j_tension": 1e6,
                          "interface_j_cohesion": 1e6, "interface_j_gi": 1e3, "interface_j_gii": 1e4},
}


@pytest.mark.parametrize("name", LAWS)
def test_stress_from_the_start_is_in_balance(name, tmp_path):
    """Distorted cells under a stress with a gradient that carries the weight: nothing moves from the first step on."""
    scene = {"mesh": "box", "mesh_box_cells": (3, 3, 6), "mesh_box_size": (3, 3, 6), "mesh_box_jitter": 0.2,
             "block_law": "elastic", "block_young": 1e10, "block_poisson": 0.25, "block_density": 2500.0,
             "block_stress": (-1e6, -2e6, -1.5e5, 0, 0, 0), "block_stress_gradient_z": (0, 0, 2.5e4, 0, 0, 0),
             "gravity": (0, 0, -10), "boundaries": ("zmin", "xmin", "xmax", "ymin", "ymax"), "boundary_zmin_fix": "z",
             "boundary_xmin_fix": "x", "boundary_xmax_fix": "x", "boundary_ymin_fix": "y", "boundary_ymax_fix": "y",
             "ts_max_steps": 200, "monitor_convergence": "ascii:balance.txt", "monitor_convergence_interval": 100, **LAWS[name]}
    if name == "elastic springs":
        scene = {key: value for key, value in scene.items() if value is not None}
    done = harness.run(tmp_path, scene)
    rows = np.atleast_2d(np.loadtxt(tmp_path / "balance.txt"))
    assert rows.shape[0] == 3
    assert rows[:, 3].max() < 1e-13, rows
    assert done.summary.get("broken_blocks", 0) == 0
    frame = done.last_frame()
    assert np.abs(frame.point_data["displacement"]).max() < 1e-15
    depth = frame.centres()[:, 2]
    assert np.allclose(frame.cell_data["stress"][:, 0], -1e6, rtol=1e-9)
    assert np.allclose(frame.cell_data["stress"][:, 2], -1.5e5 + 2.5e4 * depth, atol=2e3)  # mean of the element


def test_spring_blocks_break_under_the_stress_from_the_start(tmp_path):
    """Uniform tension above the strength breaks every element, below it none: in pairs of cells that nothing holds."""
    scene = {"mesh": "box", "mesh_box_cells": (2, 2, 2), "mesh_box_size": (2, 2, 2), "block_law": "spring", "block_young": 1e10,
             "block_poisson": 0.25, "block_density": 2500.0, "block_cohesion": 1e7, "block_friction": 30.0, "block_tension": 1e6,
             "boundaries": ("xmin", "xmax"), "boundary_xmin_fix": "xyz", "boundary_xmax_fix": "xyz", "ts_max_steps": 1}
    for stress, broken in ((1.1e6, 1), (0.9e6, 0)):
        done = harness.run(tmp_path / str(stress), {**scene, "block_stress": (stress, 0, 0, 0, 0, 0)})
        assert done.summary["broken_blocks"] == broken


def test_removed_region_takes_its_weight_along(tmp_path):
    done = harness.run(tmp_path, {**SOIL, "relax_ratio": 1e-9})
    settle, dig = done.summary["stages"]
    rows = done.histories()
    end = list(rows["step"]).index(settle["steps"])
    assert abs(rows["rock"][end] / rock_top(1800 * 10 * 20) - 1) < 1e-6
    assert abs(rows["rock"][-1] / rock_top(0) - 1) < 1e-6
    assert dig["elements"]["hex8"] == settle["elements"]["hex8"] // 3, (settle["elements"], dig["elements"])


def test_reset_changes_what_is_reported_and_nothing_else(tmp_path):
    plain = harness.run(tmp_path / "plain", SOIL)
    reset = harness.run(tmp_path / "reset", {**SOIL, "stage_dig_reset": "displacement"})
    frames = [plain.last_frame(), reset.last_frame()]
    assert np.array_equal(frames[0].cell_data["stress"], frames[1].cell_data["stress"]), "forces to the last bit"
    settle = plain.summary["stages"][0]["steps"]
    a, b = plain.histories()["rock"], reset.histories()["rock"]
    origin = a[list(plain.histories()["step"]).index(settle)]
    assert np.array_equal(np.asarray(a[-50:]) - origin, np.asarray(b[-50:]))


@pytest.mark.parametrize("more", [{}, BRITTLE, {"mesh_box_shape": "tet", "block_element": "bbar"}])
def test_stiffness_changes_without_a_kick(more, tmp_path):
    """In balance, half the stiffness keeps the stress: nothing moves, and the energy stored is twice as large."""
    scene = {**COLUMN, "mesh_box_cells": (2, 2, 10), "mesh_box_size": (2, 2, 10), "mesh_box_jitter": 0.2,
             "block_poisson": 0.25, "history_top_at": (1, 1, 10), "relax_ratio": 1e-10, "stages": ("settle", "soften"),
             "stage_soften_block_young": 5e9, "stage_soften_solve": "dynamic", "stage_soften_ts_max_steps": 200, **more}
    done = harness.run(tmp_path, scene)
    before, after = done.summary["stages"]
    rows = done.histories()
    settled = rows["top"][list(rows["step"]).index(before["steps"])]
    assert np.abs(np.asarray(rows["top"][-200:]) / settled - 1).max() < 1e-7
    assert abs(after["energy"]["strain"] / before["energy"]["strain"] - 2) < 1e-6


INCLINE = {  # a block on an incline of 25 degrees with 30 degrees of friction: factor of safety 1.2381
    "mesh": str(harness.ROOT / "meshes" / "incline.msh"), "block_law": "elastic", "block_young": 1e9,
    "block_poisson": 0.25, "block_density": 2500.0, "interfaces": "contact", "interface_contact_law": "brittle",
    "interface_contact_tension": 0.0, "interface_contact_cohesion": 0.0, "interface_contact_friction": 30.0,
    "boundaries": "base", "boundary_base_fix": "xyz", "solve": "relax", "relax_max_steps": 20000,
    "gravity": (9.81 * math.sin(math.radians(25)), 0, -9.81 * math.cos(math.radians(25))),
    "stages": ("settle", "reduce"), "stage_settle_intact": None,
}


@pytest.mark.parametrize("factor, holds", [(1.2, True), (1.28, False)])
def test_strength_factor_brackets_the_factor_of_safety(factor, holds, tmp_path):
    done = harness.call(tmp_path, {**INCLINE, "stage_reduce_strength_factor": factor, "output": "out"})
    assert (done.returncode == 0) == holds, done.stdout[-800:] + done.stderr[-800:]
    if not holds:
        assert "stage 'reduce' is not in balance" in done.stderr


def test_nothing_fails_in_an_intact_stage(tmp_path):
    """Sudden gravity breaks weak joints; in an intact stage it does not, and the strengths come back after it."""
    weak = {**COLUMN, **BRITTLE, "mesh_box_cells": (2, 2, 6), "mesh_box_size": (2, 2, 6), "interface_j_tension": 0.0,
            "interface_j_cohesion": 0.0, "history_top_at": (1, 1, 6), "stages": ("settle", "pull"),
            "stage_settle_intact": None, "stage_pull_gravity": (0, 0, 10), "stage_pull_solve": "dynamic",
            "stage_pull_ts_max_steps": 200}
    settle, pull = harness.run(tmp_path, weak).summary["stages"]
    assert settle["broken_springs"] == 0
    assert pull["broken_springs"] > 0


@pytest.mark.parametrize("ranks", [2, 3])
def test_stages_do_not_depend_on_ranks(ranks, tmp_path):
    scene = {**SOIL, "stage_dig_reset": "displacement", "stages": ("settle", "dig", "shake"), "stage_shake_solve": "dynamic",
             "deterministic": None, "stage_shake_ts_max_steps": 100, "stage_shake_block_rock_young": 3e9,
             "stage_shake_boundary_base_velocity": (0, 0, 0.01), "stage_shake_boundary_base_components": "z",
             "stage_shake_boundary_base_fix": "xy"}
    one = harness.run(tmp_path / "1", scene)
    many = harness.run(tmp_path / "n", scene, ranks=ranks)
    assert (one.out / "histories.csv").read_bytes() == (many.out / "histories.csv").read_bytes()


QUIET = {**SOIL, "stages": ("settle", "wait"), "stage_wait_solve": "dynamic", "stage_wait_ts_max_steps": 10000,
         "stage_wait_boundary_base_quiet": "true", "output_interval": 2000}
del QUIET["stage_dig_remove"]


def drift(done, name="rock"):
    """How far a history moves after the first stage, over what it had moved by then."""
    rows = done.histories()
    settled = list(rows["step"]).index(done.summary["stages"][0]["steps"])
    values = np.asarray(rows[name])
    return np.abs(values[settled:] - values[settled]).max() / abs(values[settled])


@pytest.mark.parametrize("more", [{}, {"boundaries": ("base",)}, {"damping_beta": 1e-5}],
                         ids=["column", "free sides", "damped"])
def test_quiet_base_carries_the_weight(more, tmp_path):
    """A base that becomes quiet keeps its reactions: the body stays where it has settled."""
    scene = {**QUIET, **more}
    if "boundaries" in more:
        del scene["boundary_sides_fix"]
    assert drift(harness.run(tmp_path, scene)) < 1e-6


def test_quiet_base_that_drops_its_reactions_sinks(tmp_path):
    done = harness.run(tmp_path, {**QUIET, "boundary_base_release": "drop", "stage_wait_ts_max_steps": 1000})
    assert drift(done) > 1
    assert "so the body sinks" in done.stdout


def test_held_forces_go_on_through_stages(tmp_path):
    """They stay while the boundary is quiet, leave when it is held again, and come anew when it is let go again."""
    scene = {**QUIET, "stages": ("settle", "wait", "on", "hold", "again"), "stage_wait_ts_max_steps": 500,
             "stage_on_damping_alpha": 1.0, "stage_hold_boundary_base_quiet": "false", "stage_hold_gravity": (0, 0, -12),
             "stage_hold_solve": "relax", "stage_again_boundary_base_quiet": "true", "stage_again_solve": "dynamic",
             "stage_again_ts_max_steps": 2000}
    done = harness.run(tmp_path, scene)
    rows, steps = done.histories(), [stage["steps"] for stage in done.summary["stages"]]
    z, start = np.asarray(rows["rock"]), np.searchsorted(rows["step"], np.cumsum(steps))
    assert np.abs(z[start[0]:start[2]] / z[start[0]] - 1).max() < 1e-6
    assert abs(z[start[3]] / z[start[0]] - 1.2) < 1e-5
    assert np.abs(z[start[3]:] / z[start[3]] - 1).max() < 1e-6


@pytest.mark.parametrize("change, message", [
    ({"stage_wait_boundary_base_fix": "xyz"}, "boundary 'base' is quiet and has"),
    ({"stage_settle_boundary_base_quiet": "true"}, "boundary 'base' is quiet and has"),
    ({"boundary_sides_release": "drop"}, "no use for -boundary_sides_release"),
])
def test_release_that_makes_no_sense(change, message, tmp_path):
    done = harness.call(tmp_path, {**QUIET, **change})
    assert done.returncode == 1 and message in done.stderr, done.stderr
