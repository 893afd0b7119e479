"""Interfaces without strengths of their own: the same run, to the last bit, as with those of the weaker block given."""
import sys
from pathlib import Path

import numpy as np
import pytest

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "verification"))
import harness  # noqa: E402
import meshes  # noqa: E402

SCENE = {
    "block_young": 2e9, "block_poisson": 0.25, "block_density": 2200.0, "gravity": (0, 0, -9.81), "boundaries": "zmin",
    "boundary_zmin_fix": "xyz", "velocity": (1.0, -0.4, 0.6), "ts_max_steps": 120, "output_interval": 60,
    "deterministic": None, "interface_stiffness_factor": 1.0,
}
LOWER = {"block_lower_law": "mohr_coulomb", "block_lower_cohesion": 2e5, "block_lower_friction": 35.0}  # tension: the apex
UPPER = {"block_upper_law": "breakage", "block_upper_cohesion": 3e5, "block_upper_friction": 25.0,
         "block_upper_tension": 1e5, "block_upper_residual_friction": 20.0}
APEX = 2e5 / np.tan(np.radians(35.0))
OWN = {"lower": (APEX, 2e5, 35.0), "upper": (1e5, 3e5, 25.0), "both": (1e5, 2e5, 25.0)}
PLACES = {"lower": "inside:lower", "upper": "inside:upper", "both": "between:lower:upper"}


def layers(folder, options):
    folder.mkdir(parents=True, exist_ok=True)
    meshes.hexahedra(folder / "layers.msh", np.linspace(0, 1, 4), np.linspace(0, 1, 4), np.linspace(0, 2, 7),
                     lambda centre: "lower" if centre[2] < 1 else "upper",
                     move=lambda points: meshes.jitter(points, 0.04, 2))
    return {"mesh": folder / "layers.msh", **SCENE, **options}


def brittle(names):
    """Interfaces of the law brittle, with the strengths of OWN."""
    options = {"interfaces": tuple(names), "interface_law": "brittle"}
    for name in names:
        strengths = dict(zip(("tension", "cohesion", "friction"), OWN[name]))
        options.update({f"interface_{name}_{key}": value for key, value in strengths.items()})
        options[f"interface_{name}_on"] = PLACES[name]
    return options


def motion(folder, options, **keywords):
    """All fields of all frames but the number of the interface, as bytes; and the run."""
    found = harness.run(folder, layers(folder, options), **keywords)
    content = {}
    for series in ("fields", "interfaces"):
        for i, (time, frame) in enumerate(found.frames(series)):
            for name, values in {**frame.point_data, **frame.cell_data}.items():
                if name != "interface":
                    content[series, i, name] = values.tobytes()
    return content, found


MORE = {
    "plain": {},
    "scattered": {"interface_cohesion_scatter": "weibull:4", "interface_tension_scatter": "uniform:0.3"},
    "dilating": {"interface_dilation": 10.0},
    "in stages": {"stages": ("first", "second"), "stage_second_strength_factor": 1.7},
}


@pytest.mark.parametrize("more", MORE)
def test_weaker_block_by_face(more, tmp_path):
    """One interface between and within blocks of two strengths, against three interfaces with numbers of their own."""
    scene = {**LOWER, **UPPER, **MORE[more]}
    taken, run = motion(tmp_path / "taken", {**scene, "interfaces": "all", "interface_all_on": "all",
                                             "interface_all_law": "brittle"})
    given, _ = motion(tmp_path / "given", {**scene, **brittle(OWN)})
    assert taken == given
    assert 0 < run.summary["broken_springs"] < run.summary["springs"], "the scene must break in part"
    note = f"interface all: tension 100000 to {APEX:g} Pa, cohesion 200000 to 300000 Pa, friction 25 to 35 degrees"
    assert note in run.stdout and "of the weaker block" in run.stdout, run.stdout


def test_ranks_agree(tmp_path):
    scene = {**LOWER, **UPPER, "interfaces": "all", "interface_all_on": "all", "interface_all_law": "brittle"}
    one, _ = motion(tmp_path / "1", scene)
    for ranks in (2, 3):
        assert motion(tmp_path / str(ranks), scene, ranks=ranks)[0] == one


def test_what_is_given_counts(tmp_path):
    """A block without strength on one side: the other one's; a number that is given stays."""
    scene = {"block_lower_law": "elastic", **UPPER, "interfaces": "both", "interface_both_on": PLACES["both"],
             "interface_both_law": "brittle", "interface_both_friction": 40.0}
    taken, run = motion(tmp_path / "taken", scene)
    given, _ = motion(tmp_path / "given", {**scene, "interface_both_tension": 1e5, "interface_both_cohesion": 3e5})
    assert taken == given
    assert "interface both: tension 100000 Pa, cohesion 300000 Pa, of the weaker block" in run.stdout, run.stdout
