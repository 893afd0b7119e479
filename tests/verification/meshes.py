"""Structured meshes of hexahedra or tetrahedra with named regions and surfaces, and those of .geo files, written by gmsh.

With CDEM_MESHES=DIR what gmsh has written is kept in that folder and taken from there: tests that ran here with it run with
a copy of the folder on a machine without gmsh."""
import functools
import hashlib
import itertools
import os
import shutil
from pathlib import Path

import numpy as np

# Corners of the six faces of a gmsh hexahedron whose corners are numbered z, y, x.
SIDES = {"xmin": ((0, 4, 7, 3), 0, 0), "xmax": ((1, 2, 6, 5), 0, 1), "ymin": ((0, 1, 5, 4), 1, 0),
         "ymax": ((3, 7, 6, 2), 1, 1), "zmin": ((0, 3, 2, 1), 2, 0), "zmax": ((4, 5, 6, 7), 2, 1)}


def kuhn():
    """The six tetrahedra of a hexahedron round its diagonal 0-6; neighbours cut their common face alike."""
    corner = {(0, 0, 0): 0, (1, 0, 0): 1, (1, 1, 0): 2, (0, 1, 0): 3, (0, 0, 1): 4, (1, 0, 1): 5, (1, 1, 1): 6, (0, 1, 1): 7}
    tetrahedra = []
    for order in itertools.permutations(range(3)):
        at, path = [0, 0, 0], [0]
        for axis in order:
            at[axis] = 1
            path.append(corner[tuple(at)])
        odd = sum(a > b for a, b in itertools.combinations(order, 2)) % 2
        tetrahedra.append([path[0], path[2], path[1], path[3]] if odd else path)
    return tetrahedra


def kept(write):
    """Of a function write(path, *what) that is called for the same file only once, where there is a folder to keep it."""
    @functools.wraps(write)
    def writer(path, *what):
        folder = os.environ.get("CDEM_MESHES")
        if not folder:
            write(path, *what)
            return
        file = Path(folder) / (hashlib.sha256(repr((write.__name__, *what)).encode()).hexdigest() + ".msh")
        if not file.exists():
            write(path, *what)
            file.parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(path, file)
        shutil.copy(file, path)
    return writer


def hexahedra(path, x, y, z, region, side=lambda name, centre: name, move=lambda points: points, version=4.1,
              binary=False, tetrahedra=False):
    """Writes the grid of the coordinate lists x, y, z as hexahedra, or each of them as six tetrahedra.

    region(centre) names the region of a cell; side(name, centre) names the surface of an outer face (name: xmin ... zmax)
    or gives None; move(points) displaces the nodes [n, 3] in the end (rotation, distortion)."""
    nx, ny, nz = len(x), len(y), len(z)
    points = np.array([(a, b, c) for c in z for b in y for a in x], dtype=float)
    node = lambda i, j, k: 1 + i + nx * (j + ny * k)
    parts = kuhn() if tetrahedra else [list(range(8))]
    cells, faces = {}, {}
    for k in range(nz - 1):
        for j in range(ny - 1):
            for i in range(nx - 1):
                corners = [node(i, j, k), node(i + 1, j, k), node(i + 1, j + 1, k), node(i, j + 1, k),
                           node(i, j, k + 1), node(i + 1, j, k + 1), node(i + 1, j + 1, k + 1), node(i, j + 1, k + 1)]
                centre = (points[corners[0] - 1] + points[corners[6] - 1]) / 2
                cells.setdefault(region(centre), []).extend([corners[c] for c in part] for part in parts)
                index, last = (i, j, k), (nx - 2, ny - 2, nz - 2)
                for name, (local, axis, upper) in SIDES.items():
                    if index[axis] == (last[axis] if upper else 0):
                        face = [corners[c] for c in local]
                        label = side(name, points[np.array(face) - 1].mean(axis=0))
                        if label is not None:
                            cut = [[corners[c] for c in part if c in local] for part in parts]
                            faces.setdefault(label, []).extend([f for f in cut if len(f) == 3] if tetrahedra else [face])
    write_grid(path, move(points).tolist(), cells, faces, version, binary, tetrahedra)


@kept
def write_grid(path, points, cells, faces, version, binary, tetrahedra):
    """Writes regions (cells) and surfaces (faces) by name, each a list of its elements' nodes."""
    import gmsh  # here: what makes no mesh runs without it

    gmsh.initialize()
    try:
        gmsh.option.setNumber("General.Terminal", 0)
        gmsh.option.setNumber("Mesh.MshFileVersion", version)
        gmsh.option.setNumber("Mesh.Binary", 1 if binary else 0)
        gmsh.model.add("grid")
        tag, element, first = 0, 1, True
        for dim, kind, groups in ((3, 4 if tetrahedra else 5, cells), (2, 2 if tetrahedra else 3, faces)):
            for label, items in groups.items():
                tag += 1
                gmsh.model.addDiscreteEntity(dim, tag)
                if first:
                    gmsh.model.mesh.addNodes(dim, tag, list(range(1, len(points) + 1)), [value for point in points for value in point])
                    first = False
                gmsh.model.mesh.addElementsByType(tag, kind, list(range(element, element + len(items))),
                                                  [n for item in items for n in item])
                element += len(items)
                gmsh.model.addPhysicalGroup(dim, [tag], tag)
                gmsh.model.setPhysicalName(dim, tag, label)
        gmsh.write(str(path))
    finally:
        gmsh.finalize()


def from_geo(path, geo, **numbers):
    """Meshes a .geo file, with other values of the numbers that it declares by DefineConstant."""
    write_geo(path, Path(geo).read_text(), tuple(sorted(numbers.items())))


@kept
def write_geo(path, geo, numbers):
    """Meshes the text of a .geo file."""
    import gmsh

    source = Path(path).with_suffix(".geo")
    source.write_text(geo)
    gmsh.initialize(["gmsh", "-v", "0", *(word for name, value in numbers for word in ("-setnumber", name, str(value)))])
    try:
        gmsh.open(str(source))
        gmsh.model.mesh.generate(3)
        gmsh.write(str(path))
    finally:
        gmsh.finalize()


def jitter(points, share, seed):
    """Moves every node by up to share of the unit spacing in each direction, repeatably."""
    return points + share * np.random.default_rng(seed).uniform(-1, 1, points.shape)


def rotation(angle):
    """Turns points about y by angle [degrees], x towards -z: the plane z = 0 becomes an incline that falls along +x."""
    a = np.radians(angle)
    matrix = np.array([[np.cos(a), 0, np.sin(a)], [0, 1, 0], [-np.sin(a), 0, np.cos(a)]])
    return lambda points: points @ matrix.T
