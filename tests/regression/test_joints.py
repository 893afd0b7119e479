"""Random joints in a whole run: joints.csv, the header and summary.json are the same on 1, 2 and 3 ranks; the network
does not depend on the mesh or on other sets; scripts/joints draws it."""
import csv
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "verification"))
import harness  # noqa: E402

SCENE = {
    "mesh": "box", "mesh_box_cells": (8, 8, 8), "mesh_box_size": (10, 10, 10), "mesh_box_shape": "tet",
    "mesh_box_jitter": 0.12, "block_young": 1e10, "block_poisson": 0.25, "block_density": 2500.0,
    "joints": "steep,flat", "joint_fisher": 40.0,
    "joint_steep_p32": 0.5, "joint_steep_dip": 75.0, "joint_steep_dip_direction": 200.0,
    "joint_steep_diameter": "power:2.5,2,12",
    "joint_flat_count": 0.02, "joint_flat_dip": 10.0, "joint_flat_dip_direction": 20.0, "joint_flat_diameter": "lognormal:4,1",
    "interfaces": "a,b", "interface_law": "brittle", "interface_tension": 1e4, "interface_cohesion": 1e4,
    "interface_a_on": "joints:steep", "interface_b_on": "joints:flat", "interface_a_friction": 30.0,
    "interface_b_friction": 20.0, "boundaries": "zmin", "boundary_zmin_fix": "xyz", "gravity": (0, 0, -9.81),
    "ts_max_steps": 20, "device": "cpu",
}


def discs(results):
    with open(results.out / "joints.csv", newline="") as file:
        return list(csv.DictReader(file))


def lines(results):
    return [line for line in results.stdout.splitlines() if line.startswith("joints")]


@pytest.fixture(scope="module")
def first(tmp_path_factory):
    return harness.run(tmp_path_factory.mktemp("first"), SCENE)


def test_figures_agree(first):
    table, summary = discs(first), first.summary["joints"]
    assert [s["name"] for s in summary] == ["steep", "flat"]
    assert len(lines(first)) == 2 and "(0.5 wanted)" in lines(first)[0]
    for s in summary:
        rows = [row for row in table if row["set"] == s["name"]]
        area = sum(float(row["area_inside"]) for row in rows)
        assert len(rows) == s["discs"] > 5
        assert s["disc_area"] == pytest.approx(area, rel=1e-12)
        assert s["p32"] == pytest.approx(area / 1000, rel=1e-12)
        assert s["area_ratio"] == pytest.approx(s["face_area"] / area, rel=1e-12)
        assert 0 < s["face_share"] < 1 and s["faces"] > 0
        assert all(float(row["area_inside"]) <= np.pi / 4 * float(row["diameter"])**2 * (1 + 1e-12) for row in rows)
    assert summary[0]["p32_wanted"] == 0.5 and summary[0]["p32"] == pytest.approx(0.5, rel=0.05)
    assert summary[1]["p32_wanted"] is None
    assert first.summary["interfaces"] <= sum(s["faces"] for s in summary)


@pytest.mark.parametrize("ranks", [2, 3])
def test_ranks_do_not_matter(first, ranks, tmp_path):
    other = harness.run(tmp_path, SCENE, ranks=ranks)
    assert (other.out / "joints.csv").read_bytes() == (first.out / "joints.csv").read_bytes()
    assert other.summary["joints"] == first.summary["joints"]
    assert lines(other) == lines(first)
    for key in ("interfaces", "springs", "nodes", "blocks"):
        assert other.summary[key] == first.summary[key]


def test_other_sets_and_meshes_do_not_matter(first, tmp_path):
    alone = {key: value for key, value in SCENE.items() if "flat" not in key and "interface_b" not in key}
    alone.update(joints="steep", interfaces="a", mesh_box_shape="hex", mesh_box_jitter=0.0, mesh_box_cells=(5, 5, 5))
    one = discs(harness.run(tmp_path, alone))
    before = [row for row in discs(first) if row["set"] == "steep"]
    assert len(one) == len(before)
    for key in ("x", "y", "z", "dip", "dip_direction", "diameter"):
        assert [row[key] for row in one] == [row[key] for row in before]
    assert [float(row["area_inside"]) for row in one] == pytest.approx([float(row["area_inside"]) for row in before])


def test_seed_matters(first, tmp_path):
    other = harness.run(tmp_path, {**SCENE, "seed": 2, "mesh_box_jitter": 0.0})
    assert {row["x"] for row in discs(other)}.isdisjoint({row["x"] for row in discs(first)})


def test_a_written_network_can_be_read_again(first, tmp_path):
    path = tmp_path / "steep.txt"
    keys = ("x", "y", "z", "dip", "dip_direction", "diameter")
    path.write_text("".join(", ".join(row[key] for key in keys) + "\n" for row in discs(first) if row["set"] == "steep"))
    scene = {key: value for key, value in SCENE.items() if not key.startswith("joint_") and "interface_b" not in key}
    again = harness.run(tmp_path, {**scene, "joints": "steep", "interfaces": "a", "joint_steep_file": "steep.txt"})
    old, new = first.summary["joints"][0], again.summary["joints"][0]
    assert new["faces"] == old["faces"] and new["discs"] == old["discs"]
    assert new["disc_area"] == pytest.approx(old["disc_area"], rel=1e-9)


def test_an_old_table_is_a_result(first, tmp_path):
    out = tmp_path / "out"
    out.mkdir()
    (out / "joints.csv").write_text("precious")
    done = harness.call(tmp_path, {**SCENE, "output": "out"})
    assert done.returncode != 0 and "joints.csv" in done.stderr + done.stdout
    assert (out / "joints.csv").read_text() == "precious"


def has_matplotlib():
    return subprocess.run([sys.executable, "-c", "import matplotlib"], capture_output=True).returncode == 0


@pytest.mark.skipif(not has_matplotlib(), reason="no matplotlib")
def test_script_draws(first, tmp_path):
    subprocess.run([sys.executable, harness.ROOT / "scripts" / "joints", first.out, tmp_path / "net.png"], check=True)
    assert (tmp_path / "net.png").read_bytes()[:4] == b"\x89PNG"
