"""CPU against GPU where strengths scatter: the same motion to 1e-10 until something fails, and from then on, where every
tie that rounding decides is amplified, the same share of broken springs and blocks within 1 %."""
import json
import os
import sys
from pathlib import Path

import numpy as np
import pytest

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "verification"))
import harness  # noqa: E402

DEVICES = ("cpu", os.environ.get("CDEM_DEVICE", "cuda"))
BEFORE, SHARE = 1e-10, 0.01  # bars: relative until the first failure; of all springs (blocks) after it
EVERY = 10                   # steps from one look to the next

SCENE = {
    "mesh": "box", "mesh_box_cells": (10, 8, 8), "mesh_box_size": (10, 8, 8), "mesh_box_jitter": 0.15,
    "block_young": 2e9, "block_poisson": 0.25, "block_density": 2200.0, "gravity": (0, 0, -1.0), "seed": 5,
    "boundaries": ("zmin", "zmax"), "boundary_zmin_fix": "xyz", "boundary_zmax_velocity": (0.08, 0.02, 0.06),
    "boundary_zmax_table": "pulse", "tables": "pulse", "table_pulse_type": "sine", "table_pulse_frequency": 20.0,
    "output_interval": EVERY, "output_fields": "displacement,velocity",
    "monitor_convergence": "ascii:watch.txt", "monitor_convergence_interval": EVERY,
    "ts_dt": 3e-5, "ts_max_steps": 2000,
}
JOINTS = {"interfaces": "j", "interface_j_on": "all", "interface_j_tension": 2e5, "interface_j_cohesion": 4e5,
          "interface_j_friction": 30.0, "interface_j_tension_scatter": "weibull:6",
          "interface_j_cohesion_scatter": "weibull:6", "damping_beta": 2e-5}
BRITTLE = {**JOINTS, "interface_j_law": "brittle"}
SOFTENING = {**JOINTS, "interface_j_law": "softening", "interface_j_gi": 20.0, "interface_j_gii": 80.0}
BLOCKS = {"block_law": "breakage", "block_cohesion": 3e5, "block_friction": 30.0, "block_tension": 1e5,
          "block_residual_friction": 20.0, "block_cohesion_scatter": "weibull:6", "block_tension_scatter": "weibull:6"}
SCENES = {
    "brittle springs, hexahedra": BRITTLE,
    "brittle springs, tetrahedra": {**BRITTLE, "mesh_box_shape": "tet", "mesh_box_cells": (6, 5, 5)},
    "softening springs": SOFTENING,
    "breaking blocks": BLOCKS,
    "breaking blocks with brittle springs": {**BRITTLE, **BLOCKS, "interface_j_tension": 1e5, "interface_j_cohesion": 2e5},
}


def watched(folder, options):
    """A run: the files of its frames, and at every look the step and the shares broken (springs, blocks)."""
    run = harness.run(folder, options)
    look = run.monitor("watch.txt")
    springs = look["broken"] / max(1, run.summary["springs"])
    blocks = look.get("broken_blocks", np.zeros_like(springs))
    frames = [run.out / entry["name"] for entry in json.loads((run.out / "fields.hdf.series").read_text())["files"]]
    assert len(frames) == len(look["step"]), "a frame for every look"
    return frames, look["step"], np.array([springs, blocks])


def apart(first, second, name):
    """Largest difference of a field of two frames, relative to its largest number."""
    a, b = (harness.Frame(path).point_data[name] for path in (first, second))
    return np.max(np.abs(a - b)) / max(np.max(np.abs(a)), 1e-300)


def differences(folder, first, second):
    """Of two scenes that are computed alike but for rounding: the last step at which both are whole, the largest relative
    difference of the fields up to then, the largest difference of a share at any time, and the shares in the end."""
    frames, steps, shares = zip(watched(folder / "first", first), watched(folder / "second", second))
    np.testing.assert_array_equal(steps[0], steps[1])
    whole = int(np.count_nonzero(np.cumsum((shares[0] + shares[1]).sum(axis=0)) == 0))
    before = [apart(a, b, name) for a, b in list(zip(*frames))[1:whole] for name in ("displacement", "velocity")]
    return int(steps[0][max(0, whole - 1)]), max(before, default=0.0), np.max(np.abs(shares[0] - shares[1])), shares[0][:, -1]


@pytest.mark.parametrize("name", SCENES)
def test_shares(name, tmp_path):
    scene = {**SCENE, **SCENES[name]}
    last, before, share, broken = differences(tmp_path, *({**scene, "device": device} for device in DEVICES))
    print(f"{name}: whole until step {last}, apart by {before:.1e}; shares apart by {100 * share:.2f} %, "
          f"broken in the end {100 * broken[0]:.1f} % of the springs, {100 * broken[1]:.1f} % of the blocks")
    assert last >= 2 * EVERY, "the scene must be whole at first"
    assert 0.05 < broken.max() < 0.95, "the scene must break in part"
    assert before <= BEFORE
    assert share <= SHARE
