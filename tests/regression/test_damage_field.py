"""The field `damage` of interface frames: that of the law's own formula, on cubes of which every node is driven."""
import sys
from pathlib import Path

import numpy as np
import pytest

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "verification"))
import harness  # noqa: E402
import meshes  # noqa: E402

KN, TENSION, GI = 1e12, 3e6, 60.0
FIRST, END = TENSION / KN, 2 * GI / TENSION  # m: openings at which damage begins and is complete
STEPS, STEP = 40, 1e-6


def column(folder, law, turning):
    """Three cubes, both of whose joints open by the same amount: to the end times turning, back to zero, and to the end."""
    meshes.hexahedra(folder / "column.msh", (0, 1), (0, 1), (0, 1, 2, 3), lambda centre: "abc"[int(centre[2])],
                     lambda name, centre: None if name[0] == "z" else f"sides_{'abc'[int(centre[2])]}")
    path = [(0, 0.0), (10, turning * END), (20, 0.0), (STEPS, 1.2 * END)]
    (folder / "path.txt").write_text("".join(f"{step * STEP!r} {float(value)!r}\n" for step, value in path))
    drive = np.interp(np.arange(STEPS + 1), *zip(*path))
    options = {
        "mesh": folder / "column.msh", "block_young": 1e9, "block_poisson": 0.25, "block_density": 2000.0,
        "interfaces": ("low", "high"), "interface_low_on": "between:a:b", "interface_high_on": "between:b:c",
        "interface_low_law": law, "interface_high_law": "brittle", "interface_kn": KN, "interface_ks": KN,
        "interface_tension": TENSION, "interface_cohesion": TENSION, "interface_friction": 30.0,
        "boundaries": ("sides_a", "sides_b", "sides_c"), "boundary_sides_a_fix": "xyz", "boundary_table": "path",
        "boundary_sides_b_displacement": (0, 0, 1.0), "boundary_sides_c_displacement": (0, 0, 2.0),
        "tables": "path", "table_path_type": "file", "table_path_file": folder / "path.txt",
        "ts_dt": STEP, "ts_central_check": "off", "ts_max_steps": STEPS, "output_interval": 1}
    if law == "softening":
        options.update({"interface_low_gi": GI, "interface_low_gii": GI})
    return drive, options


def fields(run, name):
    """[frame][interface] of a number of their one face each."""
    return np.array([frame.cell_data[name].ravel()[np.argsort(frame.cell_data["interface"].ravel())]
                     for _, frame in run.frames("interfaces")])


@pytest.mark.parametrize("turning", [0.4, 0.9])
def test_damage_is_that_of_the_law(turning, tmp_path):
    drive, options = column(tmp_path, "softening", turning)
    run = harness.run(tmp_path, options)
    damage, state = fields(run, "damage"), fields(run, "state")
    widest = np.maximum.accumulate(drive)
    exact = np.clip((widest - FIRST) / (END - FIRST), 0, 1)
    exact = np.concatenate([[0.0], exact[:-1]])  # a frame shows the history that the step before has left,
    exact[state[:, 0] > 0] = 1.0                 # and what breaks at its displacements
    np.testing.assert_allclose(damage[:, 0], exact, rtol=0, atol=1e-9)
    assert 0.3 < damage[20, 0] < 1 and damage[20, 0] == damage[11, 0], "damage stays while the joint closes"
    assert damage[-1, 0] == 1 and state[-1, 0] == 1
    np.testing.assert_array_equal(damage[:, 1], state[:, 1])  # a law without damage: broken or not


def test_ranks_agree(tmp_path):
    _, options = column(tmp_path, "softening", 0.6)
    one = fields(harness.run(tmp_path, {**options, "output": "one", "deterministic": None}), "damage")
    two = fields(harness.run(tmp_path, {**options, "output": "two"}, ranks=2), "damage")
    assert one.tobytes() == two.tobytes()


def test_only_where_a_law_has_it(tmp_path):
    _, options = column(tmp_path, "brittle", 0.4)
    frame = harness.run(tmp_path, options).last_frame("interfaces")
    assert "damage" not in frame.cell_data and "state" in frame.cell_data


def test_it_can_be_chosen(tmp_path):
    _, options = column(tmp_path, "softening", 0.4)
    frame = harness.run(tmp_path, {**options, "output_fields": "damage"}).last_frame("interfaces")
    assert set(frame.cell_data) == {"damage"} and not frame.point_data
