"""Small good meshes: hexahedra, tetrahedra and wedges with regions, an outer and an inner surface, a line and a point."""
from pathlib import Path

import msh
from msh import Element, Msh

ROOT = Path(__file__).resolve().parents[2]


def _mesh(nodes, elements, names):
    return Msh(names, [(i + 1, tuple(map(float, x))) for i, x in enumerate(nodes)],
               [Element(i + 1, kind, groups, tuple(corners)) for i, (kind, groups, corners) in enumerate(elements)])


def _grid(nx, ny, nz):
    return [(x, y, z) for z in range(nz) for y in range(ny) for x in range(nx)]


def bricks():
    return _mesh(_grid(2, 2, 3), [
        (15, (4,), (9,)), (1, (2,), (1, 2)), (3, (7,), (1, 2, 4, 3)), (3, (5,), (5, 6, 8, 7)),
        (5, (1,), (1, 2, 4, 3, 5, 6, 8, 7)), (5, (3,), (5, 6, 8, 7, 9, 10, 12, 11))],
        {(0, 4): "tip", (1, 2): "edge", (2, 7): "base", (2, 5): "fault", (3, 1): "hard rock", (3, 3): "cap"})


def tets():
    corners = ((1, 2, 4, 8), (1, 4, 3, 8), (1, 3, 7, 8), (1, 7, 5, 8), (1, 5, 6, 8), (1, 6, 2, 8))
    return _mesh(_grid(2, 2, 2), [
        (2, (3,), (1, 2, 4)), (2, (3,), (1, 4, 3)), (2, (6,), (1, 4, 8)), (2, (6,), (1, 5, 8))] +
        [(4, (), c) for c in corners], {(2, 3): "base", (2, 6): "fault"})


def wedges():
    return _mesh(_grid(2, 2, 3), [
        (2, (2,), (1, 2, 4)), (2, (2,), (1, 4, 3)), (3, (1,), (1, 4, 8, 5)), (2, (1,), (5, 6, 8)),
        (6, (9,), (1, 2, 4, 5, 6, 8)), (6, (9,), (1, 4, 3, 5, 8, 7)),
        (6, (9,), (5, 6, 8, 9, 10, 12)), (6, (9,), (5, 8, 7, 9, 12, 11))],
        {(2, 2): "base", (2, 1): "fault", (3, 9): "rock"})


def _file(path):
    return (ROOT / path).read_bytes()


MADE = {"bricks": bricks, "tets": tets, "wedges": wedges,
        "mixed": lambda: msh.read(_file("tests/meshes/mixed_41a.msh")),
        "incline": lambda: msh.read(_file("meshes/incline.msh"))}
GMSHS = ("tests/meshes/mixed_22a.msh", "tests/meshes/mixed_22b.msh", "tests/meshes/mixed_41a.msh",
         "tests/meshes/mixed_41b.msh", "meshes/incline.msh", "meshes/specimen.msh")
# names: boundary, interface
USES = {"bricks": (("base", "fault"), ("edge", "fault"), ("tip", None)), "tets": (("base", "fault"), ("base", None)),
        "wedges": (("base", "fault"), ("base", None)),
        "mixed": (("bottom", "fault"), ("hinge", "fault"), ("tip", None)), "incline": (("base", "contact"),),
        "specimen": (("base", None),)}


def seed(rng):
    """(name, bytes of a good file, Msh or None, version, binary)."""
    if rng.random() < 0.3:
        path = rng.choice(GMSHS)
        data = _file(path)
        return Path(path).stem.split("_")[0], data, None, 22 if data[12:15] == b"2.2" else 41, data[16:17] == b"1"
    name = rng.choice(list(MADE))
    mesh, version, binary = MADE[name](), rng.choice((22, 41)), rng.random() < 0.35
    return name, msh.write(mesh, version, binary), mesh, version, binary
