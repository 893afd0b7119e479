"""Bad numbers of the interface laws: refused like every bad input, before anything is computed."""
import json
import sys
from pathlib import Path

import pytest

sys.path.insert(0, str(Path(__file__).resolve().parent))
from test_errors import DROP, JOINTS, MOHR, SPRINGS, assert_refused, changed, harness, text_of  # noqa: E402

SOFT = {**JOINTS, "interface_joints_law": "softening", "interface_joints_gi": 50.0, "interface_joints_gii": 200.0}
DILATING = {"interface_joints_dilation": 30.0, "interface_joints_dilation_slip": 1e-3}

OPTIONS = {
    "no fracture energy": ({**SOFT, "interface_joints_gi": DROP}, ["gi", "joints", "J/m^2"]),
    "fracture energy zero": ({**SOFT, "interface_joints_gii": 0.0}, ["-interface_joints_gii", "0", "above"]),
    "fracture energy negative": ({**SOFT, "interface_joints_gi": -5.0}, ["-interface_joints_gi", "-5"]),
    "fracture energy of a law without": ({**JOINTS, "interface_joints_gi": 5.0}, ["-interface_joints_gi"]),
    "softening without tension": ({**SOFT, "interface_joints_tension": 0.0}, ["-interface_joints_tension", "0", "above"]),
    "strength that the blocks have not either": ({**JOINTS, "interface_joints_cohesion": DROP},
                                                 ["joints", "no cohesion", "-interface_joints_cohesion", "Pa", "box"]),
    "tension that the blocks do not limit": ({**JOINTS, **MOHR, "block_friction": 0.0, "interface_joints_tension": DROP},
                                             ["joints", "no tension", "-interface_joints_tension", "box"]),
    "tension zero of the blocks of a softening law": ({**SOFT, **MOHR, "block_tension": 0.0, "interface_joints_tension": DROP},
                                                      ["joints", "tension", "0", "box"]),
    "dilation above the blocks' friction": ({**JOINTS, **MOHR, "interface_joints_friction": DROP, "interface_joints_dilation": 31.0},
                                            ["joints", "blocks", "dilation", "31", "friction", "30"]),
    "tension kept by a law that has one damage": ({**SOFT, "interface_joints_keep_tension": None}, ["-interface_joints_keep_tension"]),
    # k_n = 20 (lambda + 2 mu)/h = 2.4e10, k_s = 8e9 Pa/m: sqrt(2 gi k_n) = 1.54919e6 Pa, sqrt(2 gii k_s) = 1.78885e6 Pa
    "tension above gi": ({**SOFT, "interface_joints_tension": 1.56e6, "interface_joints_cohesion": 1.7e6},
                         ["joints", "tension", "1.56e+06", "gi", "1.54919e+06", "largest"]),
    "cohesion above gii": ({**SOFT, "interface_joints_cohesion": 1.8e6}, ["joints", "cohesion", "gii", "1.78885e+06", "largest"]),
    "tension above gi on soft springs": ({**SOFT, "interface_joints_kn": 1e8}, ["joints", "tension", "gi", "100000"]),
    "dilation above friction": ({**JOINTS, "interface_joints_dilation": 31.0}, ["joints", "dilation", "31", "friction", "30"]),
    "dilation negative": ({**SOFT, "interface_joints_dilation": -1.0}, ["-interface_joints_dilation", "-1"]),
    "slip of dilation zero": ({**JOINTS, "interface_joints_dilation": 5.0, "interface_joints_dilation_slip": 0.0},
                              ["-interface_joints_dilation_slip", "0"]),
    "dilation of a law without": ({"interfaces": "joints", "interface_joints_on": "all", "interface_joints_dilation": 5.0},
                                  ["-interface_joints_dilation"]),
}


@pytest.mark.parametrize("name", OPTIONS)
def test_option(name, tmp_path):
    changes, words = OPTIONS[name]
    assert_refused(tmp_path, changed(changes), words)


@pytest.mark.parametrize("ranks", [2, 3])
def test_strength_of_a_face_on_several_ranks(ranks, tmp_path):
    changes, words = OPTIONS["tension above gi"]
    assert_refused(tmp_path, changed(changes), words, ranks=ranks)


@pytest.mark.parametrize("changes", [SOFT, {**JOINTS, **DILATING}, {**SOFT, **DILATING},
                                     {**SOFT, "interface_joints_initial": "broken"}])
def test_good_laws_are_accepted(changes, tmp_path):
    done = harness.call(tmp_path, changed(changes))
    assert done.returncode == 0, text_of(done)
    assert (tmp_path / "out" / "summary.json").exists()


def test_cut_tension_is_said(tmp_path):
    """sigma_t above c/tan(phi) = 1e5/tan(30) = 173205 Pa."""
    done = harness.call(tmp_path, changed({**SOFT, "interface_joints_tension": 2e5}))
    assert done.returncode == 0, text_of(done)
    assert "tension cut to cohesion / tan(friction) = 173205" in text_of(done)


@pytest.mark.parametrize("gi, scatter, said", [(50.0, DROP, False), (25.0, DROP, True), (25.0, "uniform:1e-6", True)])
def test_cells_too_large_for_softening_are_said(gi, scatter, said, tmp_path):
    """h <= l_ch/5: here E gi/tension^2/5 = 1 m (0.5 m), and cells of 1 m."""
    done = harness.call(tmp_path, changed({**SOFT, "interface_joints_gi": gi, "interface_joints_gi_scatter": scatter}))
    assert done.returncode == 0, text_of(done)
    lines = [line for line in text_of(done).splitlines() if "too large" in line]
    assert bool(lines) == said, text_of(done)
    assert not said or all(word in lines[0] for word in ("joints", "2 times", "l_ch")), lines


def test_cells_too_large_by_the_blocks_tension_are_said(tmp_path):
    """Likewise where the tension is that of the blocks."""
    scene = {**SOFT, **MOHR, "block_tension": 1e5, "interface_joints_gi": 25.0, "interface_joints_tension": DROP}
    done = harness.call(tmp_path, changed(scene))
    assert done.returncode == 0, text_of(done)
    assert "up to 2 times too large for its softening" in text_of(done), text_of(done)


@pytest.mark.parametrize("gf, scatter, said", [(1667.0, DROP, False), (2500 / 3, DROP, True), (2500 / 3, "uniform:1e-6", True)])
def test_cells_too_large_for_softening_blocks_are_said(gf, scatter, said, tmp_path):
    """V^(1/3) <= 2 G gf/k^2, k = 2 c/sqrt(3): here 1 m (0.5 m), and cells of 1 m."""
    done = harness.call(tmp_path, changed({"block_law": "drucker_prager", "block_cohesion": 1e6, "block_friction": 0.0,
                                           "block_gf": gf, "block_cohesion_scatter": scatter}))
    assert done.returncode == 0, text_of(done)
    lines = [line for line in text_of(done).splitlines() if "too large" in line]
    assert bool(lines) == said, text_of(done)
    assert not said or all(word in lines[0] for word in ("box", "2 times", "gf")), lines


def test_blocks_of_springs_count_as_broken_blocks(tmp_path):
    """A box whose top is drawn away by ten times the strain it bears: every block breaks."""
    pulled = {**SPRINGS, "mesh_box_cells": (2, 2, 1), "gravity": (0, 0, 0), "boundaries": ("zmin", "zmax"),
              "boundary_zmax_velocity": (0, 0, 20.0), "ts_max_steps": 40}
    done = harness.call(tmp_path, changed(pulled))
    assert done.returncode == 0, text_of(done)
    summary = json.loads((tmp_path / "out" / "summary.json").read_text())
    assert summary["broken_blocks"] == 1
