"""Regions that stages remove are in no later frame, for h5py, VTK, pyvista and ParaView (the last three where installed)."""
import json
import os
import shutil
import subprocess
import sys
from pathlib import Path

import h5py
import numpy as np
import pytest

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "verification"))
import harness  # noqa: E402
import meshes  # noqa: E402

SCENE = {
    "mesh": "../parts.msh", "block_young": 1e9, "block_poisson": 0.25, "block_density": 2500.0, "gravity": (0, 0, -9.81),
    "boundaries": "zmin", "boundary_zmin_fix": "xyz", "interfaces": "j", "interface_j_on": "all", "interface_j_law": "elastic",
    "stages": ("whole", "dig", "more"), "ts_max_steps": 20, "output_interval": 10, "stage_dig_remove": "a",
    "stage_more_remove": "b", "checkpoint_interval": 1000,
}
CELLS = [27] * 3 + [18] * 2 + [9] * 2  # frames at 0, 10, ... 60; those of the ends of stages are before the next removal
FACES = [54] * 3 + [24] * 2 + [12] * 2


@pytest.fixture(scope="module")
def run(tmp_path_factory):
    top = tmp_path_factory.mktemp("removed")
    grid = [0.0, 1.0, 2.0, 3.0]
    meshes.hexahedra(top / "parts.msh", grid, grid, grid, lambda centre: "cab"[int(centre[0])])  # a lies in the middle
    return harness.run(top / "one", SCENE).out


def listed(out, name):
    return [entry["name"] for entry in json.loads((out / f"{name}.hdf.series").read_text())["files"]]


@pytest.mark.parametrize("name, count", [("fields", CELLS), ("interfaces", FACES)])
def test_content(run, name, count):
    files = listed(run, name)
    assert len(files) == len(count)
    for file, n in zip(files, count):
        with h5py.File(run / file, "r") as content:
            top = content["VTKHDF"]
            assert top["NumberOfCells"][0] == n and top["Types"].shape == (n,) and top["Offsets"].shape == (n + 1,)
            for field, values in top["CellData"].items():
                assert values.shape[0] == n, field
            if name == "fields":
                assert len(set(top["CellData/region"][:])) == n // 9
                centres = top["Points"][:][top["Connectivity"][:].reshape(-1, 8)].mean(axis=1)
                gone = {27: [], 18: [1.5], 9: [1.5, 2.5]}[n]
                assert not np.isin(centres[:, 0], gone).any()


def test_ranks_and_restart(run, tmp_path):
    """The same files on several ranks, and from a checkpoint in between."""
    (tmp_path / "two").mkdir()
    shutil.copy(run.parent.parent / "parts.msh", tmp_path / "parts.msh")
    out = harness.run(tmp_path / "two", SCENE, ranks=3).out
    again = harness.run(tmp_path / "two", {**SCENE, "output": "again", "restart": "out/checkpoint_40.h5"}, ranks=2)
    for name in ("fields", "interfaces"):
        for file in [*listed(run, name), *(f"{name}_mesh_00{i}.h5" for i in range(3))]:
            assert (out / file).read_bytes() == (run / file).read_bytes(), file
        with h5py.File(again.folder / "again" / listed(again.folder / "again", name)[-1], "r") as content:
            assert content["VTKHDF/NumberOfCells"][0] == (CELLS if name == "fields" else FACES)[-1]


@pytest.mark.parametrize("name, count", [("fields", CELLS), ("interfaces", FACES)])
def test_vtk(run, name, count):
    vtk = pytest.importorskip("vtk")
    if not hasattr(vtk, "vtkHDFReader"):
        pytest.skip("a VTK without vtkHDFReader")
    for file, n in zip(listed(run, name), count):
        reader = vtk.vtkHDFReader()
        reader.SetFileName(str(run / file))
        reader.Update()
        surface = vtk.vtkGeometryFilter()
        surface.SetInputConnection(reader.GetOutputPort())
        surface.Update()
        assert reader.GetOutput().GetNumberOfCells() == n
        assert surface.GetOutput().GetNumberOfCells() == (6 * n if name == "fields" else n)  # every block has its own nodes


def test_pyvista_time_series(run):
    pyvista = pytest.importorskip("pyvista")
    reader = pyvista.get_reader(str(run / "fields.hdf.series"))
    for t, n in zip(reader.time_values, CELLS):
        reader.set_active_time_value(t)
        assert reader.read().n_cells == n


PVPYTHON = """
import sys
from paraview.simple import OpenDataFile, ExtractSurface, servermanager
reader = OpenDataFile(sys.argv[1])
surface = ExtractSurface(Input=reader)
for t in list(reader.TimestepValues):
    surface.UpdatePipeline(t)
    print("frame", servermanager.Fetch(reader).GetNumberOfCells(), servermanager.Fetch(surface).GetNumberOfCells())
"""


def test_paraview(run, tmp_path):
    if not shutil.which("pvpython"):
        pytest.skip("no pvpython")
    command = ["pvpython"]
    if not os.environ.get("DISPLAY"):  # Debian's pvpython needs one
        if not shutil.which("xvfb-run"):
            pytest.skip("no display for pvpython and no xvfb-run")
        command = ["xvfb-run", "-a", "pvpython"]
    (tmp_path / "read.py").write_text(PVPYTHON)
    done = subprocess.run([*command, str(tmp_path / "read.py"), str(run / "fields.hdf.series")], capture_output=True, text=True,
                          timeout=300)
    found = [[int(word) for word in line.split()[1:]] for line in done.stdout.splitlines() if line.startswith("frame ")]
    assert found == [[n, 6 * n] for n in CELLS], done.stdout + done.stderr
