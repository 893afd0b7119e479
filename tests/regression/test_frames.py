"""Frames for ParaView: what is in the files, and who can read them: h5py, VTK, pyvista and ParaView (the last three
where they are installed). A frame that the series lists is whole, whenever the run is killed."""
import json
import os
import random
import shutil
import subprocess
import sys
import time
from collections import namedtuple
from pathlib import Path

import h5py
import numpy as np
import pytest

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "verification"))
import harness  # noqa: E402

CDEM = harness.program()
BLOCK = ["-block_young", "1e9", "-block_poisson", "0.25", "-block_density", "2500", "-gravity", "0,0,-9.81",
         "-boundaries", "zmin", "-boundary_zmin_fix", "xyz", "-device", "cpu"]
BOX = ["-mesh", "box", "-mesh_box_cells", "4,3,5", "-mesh_box_size", "4,3,5", *BLOCK]
JOINTS = ["-interfaces", "joint", "-interface_joint_on", "all", "-interface_joint_law", "brittle",
          "-interface_joint_tension", "1e5", "-interface_joint_cohesion", "1e5", "-interface_joint_friction", "30",
          "-interface_joint_stiffness_factor", "1"]
STEPS, INTERVAL = 40, 10
FRAMES = STEPS // INTERVAL + 1
TIMES = ["-ts_max_steps", str(STEPS), "-output_interval", str(INTERVAL)]

# What each series of each run must hold; type is VTK's.
Expected = namedtuple("Expected", "points cells corners type point_fields cell_fields")
FACES = 3 * 3 * 5 + 4 * 2 * 5 + 4 * 3 * 4
VECTORS, TENSORS = {"displacement": 3, "velocity": 3}, {"stress": 6, "region": 1}
SERIES = {
    ("joined", "fields"): Expected(5 * 4 * 6, 60, 8, 12, VECTORS, TENSORS),
    ("jointed", "fields"): Expected(8 * 60, 60, 8, 12, VECTORS, TENSORS),
    ("jointed", "interfaces"): Expected(4 * FACES, FACES, 4, 9, {"displacement": 3},
                                        {"opening": 1, "slip": 1, "state": 1}),
}
each_series = pytest.mark.parametrize("run, name", SERIES)


def cdem(*options, ranks=1):
    command = [CDEM, *map(str, options)]
    if ranks > 1:
        command = [*harness.MPIRUN, "-n", str(ranks), *command]
    return subprocess.run(command, env=harness.environment(ranks), capture_output=True, text=True, timeout=300)


def good(*options, **keywords):
    done = cdem(*options, **keywords)
    assert done.returncode == 0, done.stdout + done.stderr


def listed(folder, name="fields"):
    """Frames of a series: [(file, time)]."""
    content = json.loads((folder / f"{name}.hdf.series").read_text())
    assert content["file-series-version"] == "1.0"
    return [(entry["name"], entry["time"]) for entry in content["files"]]


def frames(folder):
    """Content of all files that ParaView reads."""
    return {path.name: path.read_bytes() for path in folder.iterdir() if path.suffix in (".hdf", ".h5", ".series")}


@pytest.fixture(scope="module")
def runs(tmp_path_factory):
    """Both runs, in folders that were moved afterwards: names in the files are relative."""
    top, folders = tmp_path_factory.mktemp("frames"), {}
    for run, more in (("joined", []), ("jointed", JOINTS)):
        good(*BOX, *TIMES, *more, "-output", top / "first")
        folders[run] = top / f"moved {run}"
        shutil.move(top / "first", folders[run])
    return folders


@each_series
def test_layout(runs, run, name):
    folder, expected = runs[run], SERIES[run, name]
    summary = json.loads((folder / "summary.json").read_text())
    files = listed(folder, name)
    assert [file for file, _ in files] == [f"{name}_{i:06d}.hdf" for i in range(FRAMES)]
    np.testing.assert_allclose([t for _, t in files], summary["dt"] * INTERVAL * np.arange(FRAMES), rtol=1e-12)
    ids = expected.cells * expected.corners
    for i, (file, t) in enumerate(files):
        with h5py.File(folder / file, "r") as content:
            top = content["VTKHDF"]
            version, kind = (h5py.h5a.open(top.id, key) for key in (b"Version", b"Type"))
            assert version.dtype == np.int64 and top.attrs["Version"].tolist() == [1, 0]
            assert kind.shape == () and kind.dtype == np.dtype("S16") and top.attrs["Type"] == b"UnstructuredGrid"
            assert kind.get_type().get_cset() == h5py.h5t.CSET_ASCII
            for part, dtype, shape in (
                ("NumberOfPoints", np.int64, (1,)), ("NumberOfCells", np.int64, (1,)),
                ("NumberOfConnectivityIds", np.int64, (1,)), ("Points", np.float64, (expected.points, 3)),
                ("Connectivity", np.int64, (ids,)), ("Offsets", np.int64, (expected.cells + 1,)),
                ("Types", np.uint8, (expected.cells,)),
            ):
                link = top.get(part, getlink=True)
                assert isinstance(link, h5py.ExternalLink)
                assert (link.filename, link.path) == (f"{name}_mesh_000.h5", f"/VTKHDF/{part}")
                assert top[part].dtype == dtype and top[part].shape == shape, part
            counts = [top[f"NumberOf{part}"][0] for part in ("Points", "Cells", "ConnectivityIds")]
            assert counts == [expected.points, expected.cells, ids]
            assert set(top["Connectivity"][:].tolist()) == set(range(expected.points))
            assert top["Offsets"][:].tolist() == list(range(0, ids + 1, expected.corners))
            assert set(top["Types"][:].tolist()) == {expected.type}
            assert top["FieldData/Time"][:].tolist() == [t]
            assert top["FieldData/Step"][:].tolist() == [i * INTERVAL]
            for data, count, fields in (("PointData", expected.points, expected.point_fields),
                                        ("CellData", expected.cells, expected.cell_fields)):
                assert set(fields) <= set(top[data])
                for field, values in top[data].items():
                    assert values.dtype == np.float64 and values.shape[0] == count and np.isfinite(values[:]).all()
                    components = fields.get(field)
                    assert components in (None, 1 if values.ndim == 1 else values.shape[1]), field
    assert not list(folder.glob("*.part"))


def test_values(runs):
    """The box is the box, hexahedra are not inside out, the fixed side stays, the rest falls."""
    for run in ("joined", "jointed"):
        with h5py.File(runs[run] / f"fields_{FRAMES - 1:06d}.hdf", "r") as content:
            top = content["VTKHDF"]
            points, corners = top["Points"][:], top["Connectivity"][:].reshape(-1, 8)
            assert points.min(axis=0).tolist() == [0, 0, 0] and points.max(axis=0).tolist() == [4, 3, 5]
            edge = points[corners[:, [1, 3, 4]]] - points[corners[:, [0]]]
            np.testing.assert_allclose(np.linalg.det(edge), 1, rtol=1e-12)
            down = top["PointData/displacement"][:, 2]
            assert (down[points[:, 2] == 0] == 0).all() and (down[points[:, 2] > 0] < 0).all()
            assert (top["CellData/stress"][:, 2] < 0).any()
        with h5py.File(runs[run] / "fields_000000.hdf", "r") as content:
            assert (content["VTKHDF/PointData/displacement"][:] == 0).all()


def test_same_bytes(runs, tmp_path):
    """Neither the number of ranks nor the time of day is in a frame; scene.opts gives the same run again."""
    for ranks in (1, 2, 3):
        good(*BOX, *TIMES, *JOINTS, "-output", tmp_path / str(ranks), ranks=ranks)
        assert frames(tmp_path / str(ranks)) == frames(runs["jointed"]), f"{ranks} ranks"
    good("-options_file", tmp_path / "2" / "scene.opts", "-output", tmp_path / "again")
    assert frames(tmp_path / "again") == frames(runs["jointed"])


def test_chosen_fields(tmp_path):
    good(*BOX, *TIMES, "-output", tmp_path / "out", "-output_fields", "velocity,region")
    with h5py.File(tmp_path / "out" / "fields_000001.hdf", "r") as content:
        assert list(content["VTKHDF/PointData"]) == ["velocity"] and list(content["VTKHDF/CellData"]) == ["region"]


def test_results_are_not_overwritten(tmp_path):
    out = tmp_path / "out"
    good(*BOX, *TIMES, "-output", out)
    (out / "notes.txt").write_text("mine")
    before = frames(out)
    refused = cdem(*BOX, *TIMES, "-output", out)
    assert refused.returncode == 1 and str(out) in refused.stderr and "-output_overwrite" in refused.stderr
    assert frames(out) == before
    good(*BOX, "-ts_max_steps", 10, "-output_interval", 10, "-output", out, "-output_overwrite")
    assert len(listed(out)) == 2 and not (out / "fields_000002.hdf").exists()
    assert (out / "notes.txt").read_text() == "mine"


@pytest.mark.parametrize("ranks", [1, 2])
def test_folder_that_cannot_be_made(tmp_path, ranks):
    (tmp_path / "file").write_text("")
    refused = cdem(*BOX, *TIMES, "-output", tmp_path / "file" / "out", ranks=ranks)
    assert refused.returncode == 1 and refused.stderr.count("cdem: error: ") == 1
    assert str(tmp_path / "file" / "out") in refused.stderr and "HDF5-DIAG" not in refused.stderr


def test_no_room(tmp_path):
    """A limit on the size of files is met as a full disk is: one message, nothing half written."""
    # Python ignores SIGXFSZ, and so does the program then: it sees the error.
    # The mesh has 9 MB. Open MPI needs some megabytes as well.
    command = ["bash", "-c", 'ulimit -f 8192; exec "$@"', "-", CDEM, *BOX, "-mesh_box_cells", "45,45,45",
               "-ts_max_steps", "1", "-output", str(tmp_path / "out")]
    refused = subprocess.run(command, env=harness.environment(), capture_output=True, text=True, timeout=300,
                             restore_signals=False)
    assert refused.returncode == 1 and refused.stderr.count("cdem: error: ") == 1, refused.stderr
    assert f"cannot write {tmp_path}/out/fields_mesh_000.h5" in refused.stderr
    assert "HDF5-DIAG" not in refused.stderr and not list((tmp_path / "out").glob("fields*"))


def check_whole(folder, file, t, box):
    with h5py.File(folder / file, "r") as content:
        top = content["VTKHDF"]
        assert top["FieldData/Time"][0] == t
        assert top["Points"][:].max() == box and top["Connectivity"].shape == (8 * top["NumberOfCells"][0],)
        for values in [*top["PointData"].values(), *top["CellData"].values()]:
            assert np.isfinite(values[:]).all()


@pytest.mark.parametrize("ranks", [1, 2])
def test_killed_run_keeps_its_frames(tmp_path, ranks):
    """SIGKILL at some moment while frames are written without a pause; a reader looks on meanwhile."""
    n, rng = 20, random.Random(ranks)
    options = ["-mesh", "box", "-mesh_box_cells", f"{n},{n},{n}", "-mesh_box_size", f"{n},{n},{n}", *BLOCK,
               "-ts_max_steps", "100000000", "-output_interval", "1"]
    whole = {}
    for kill in range(6 if ranks == 1 else 3):
        out = tmp_path / str(kill)
        command = [*harness.MPIRUN, "-n", str(ranks)] if ranks > 1 else []
        run = subprocess.Popen([*command, CDEM, *options, "-output", str(out)], env=harness.environment(ranks),
                               stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        try:
            deadline = time.monotonic() + 120
            while not (out / "fields.hdf.series").exists() or len(listed(out)) < 3:
                assert run.poll() is None and time.monotonic() < deadline
                time.sleep(0.01)
            end = time.monotonic() + rng.uniform(0, 0.5)
            while time.monotonic() < end:
                check_whole(out, *listed(out)[-1], n)
        finally:
            harness.kill(run)
        files = listed(out)
        assert [file for file, _ in files] == [f"fields_{i:06d}.hdf" for i in range(len(files))]
        for file, t in files:
            check_whole(out, file, t, n)
            content = (out / file).read_bytes()
            assert whole.setdefault(file, content) == content, "the same frame as in the runs before"
        # At most one frame has its name but is not in the list yet, at most one file is half written.
        assert len(list(out.glob("fields_*.hdf"))) - len(files) in (0, 1)
        assert len(list(out.glob("*.part"))) <= 1
        again = cdem(*options[:-4], *TIMES, "-output", out, "-output_overwrite")
        assert again.returncode == 0 and len(listed(out)) == FRAMES and not list(out.glob("*.part")), again.stderr


@each_series
def test_vtk(runs, run, name):
    vtk = pytest.importorskip("vtk")
    from vtk.util.numpy_support import vtk_to_numpy
    if not hasattr(vtk, "vtkHDFReader"):
        pytest.skip("a VTK without vtkHDFReader")
    expected = SERIES[run, name]
    for i, (file, t) in enumerate(listed(runs[run], name)):
        reader = vtk.vtkHDFReader()
        reader.SetFileName(str(runs[run] / file))
        reader.Update()
        grid = reader.GetOutput()
        assert (grid.GetNumberOfPoints(), grid.GetNumberOfCells()) == (expected.points, expected.cells)
        assert grid.GetCellType(0) == expected.type and grid.GetFieldData().GetArray("Time").GetValue(0) == t
        with h5py.File(runs[run] / file, "r") as content:
            for data, there in (("PointData", grid.GetPointData()), ("CellData", grid.GetCellData())):
                for field, values in content[f"VTKHDF/{data}"].items():
                    assert (vtk_to_numpy(there.GetArray(field)) == values[:]).all(), field


@each_series
def test_pyvista_time_series(runs, run, name):
    pyvista = pytest.importorskip("pyvista")
    reader = pyvista.get_reader(str(runs[run] / f"{name}.hdf.series"))
    files = listed(runs[run], name)
    assert list(reader.time_values) == [t for _, t in files]
    for _, t in files:
        reader.set_active_time_value(t)
        grid = reader.read()
        assert (grid.n_points, grid.n_cells) == (SERIES[run, name].points, SERIES[run, name].cells)
        assert grid.field_data["Time"][0] == t
    if name == "fields":
        np.testing.assert_allclose(grid.volume, 60, rtol=1e-12)


PVPYTHON = """
import sys
from paraview.simple import OpenDataFile, servermanager
reader = OpenDataFile(sys.argv[1])
for t in list(reader.TimestepValues):
    reader.UpdatePipeline(t)
    grid = servermanager.Fetch(reader)
    point, low = grid.GetPointData().GetArray("displacement"), 0.0
    for i in range(grid.GetNumberOfPoints()):
        low = min(low, point.GetComponent(i, 2))
    print("frame", repr(t), grid.GetNumberOfPoints(), grid.GetNumberOfCells(),
          repr(grid.GetFieldData().GetArray("Time").GetValue(0)), repr(low))
"""


@each_series
def test_paraview_time_series(runs, run, name, tmp_path):
    if not shutil.which("pvpython"):
        pytest.skip("no pvpython")
    command = ["pvpython"]
    if not os.environ.get("DISPLAY"):  # Debian's pvpython needs one
        if not shutil.which("xvfb-run"):
            pytest.skip("no display for pvpython and no xvfb-run")
        command = ["xvfb-run", "-a", "pvpython"]
    (tmp_path / "read.py").write_text(PVPYTHON)
    done = subprocess.run([*command, str(tmp_path / "read.py"), str(runs[run] / f"{name}.hdf.series")],
                          capture_output=True, text=True, timeout=300)
    found = [line.split()[1:] for line in done.stdout.splitlines() if line.startswith("frame ")]
    files = listed(runs[run], name)
    assert [float(line[0]) for line in found] == [t for _, t in files], done.stdout + done.stderr
    assert "Warning" not in done.stderr and "ERR" not in done.stderr, done.stderr
    for (file, t), line in zip(files, found):
        assert [int(line[1]), int(line[2])] == [SERIES[run, name].points, SERIES[run, name].cells]
        with h5py.File(runs[run] / file, "r") as content:
            low = content["VTKHDF/PointData/displacement"][:, 2].min()
        assert float(line[3]) == t and float(line[4]) == min(low, 0)
