"""Structured meshes of hexahedra with named regions and surfaces, written by gmsh."""
import gmsh
import numpy as np

# Corners of the six faces of a gmsh hexahedron whose corners are numbered z, y, x.
SIDES = {"xmin": ((0, 4, 7, 3), 0, 0), "xmax": ((1, 2, 6, 5), 0, 1), "ymin": ((0, 1, 5, 4), 1, 0),
         "ymax": ((3, 7, 6, 2), 1, 1), "zmin": ((0, 3, 2, 1), 2, 0), "zmax": ((4, 5, 6, 7), 2, 1)}


def hexahedra(path, x, y, z, region, side=lambda name, centre: name, move=lambda points: points, version=4.1,
              binary=False):
    """Writes the grid of the coordinate lists x, y, z as hexahedra.

    region(centre) names the region of a cell; side(name, centre) names the surface of an outer face (name: xmin ... zmax)
    or gives None; move(points) displaces the nodes [n, 3] in the end (rotation, distortion)."""
    nx, ny, nz = len(x), len(y), len(z)
    points = np.array([(a, b, c) for c in z for b in y for a in x], dtype=float)
    node = lambda i, j, k: 1 + i + nx * (j + ny * k)
    cells, faces = {}, {}
    for k in range(nz - 1):
        for j in range(ny - 1):
            for i in range(nx - 1):
                corners = [node(i, j, k), node(i + 1, j, k), node(i + 1, j + 1, k), node(i, j + 1, k),
                           node(i, j, k + 1), node(i + 1, j, k + 1), node(i + 1, j + 1, k + 1), node(i, j + 1, k + 1)]
                centre = (points[corners[0] - 1] + points[corners[6] - 1]) / 2
                cells.setdefault(region(centre), []).append(corners)
                index, last = (i, j, k), (nx - 2, ny - 2, nz - 2)
                for name, (local, axis, upper) in SIDES.items():
                    if index[axis] == (last[axis] if upper else 0):
                        face = [corners[c] for c in local]
                        label = side(name, points[np.array(face) - 1].mean(axis=0))
                        if label is not None:
                            faces.setdefault(label, []).append(face)
    gmsh.initialize()
    try:
        gmsh.option.setNumber("General.Terminal", 0)
        gmsh.option.setNumber("Mesh.MshFileVersion", version)
        gmsh.option.setNumber("Mesh.Binary", 1 if binary else 0)
        gmsh.model.add("grid")
        tag, element, first = 0, 1, True
        for dim, kind, groups in ((3, 5, cells), (2, 3, faces)):
            for label, items in groups.items():
                tag += 1
                gmsh.model.addDiscreteEntity(dim, tag)
                if first:
                    gmsh.model.mesh.addNodes(dim, tag, list(range(1, len(points) + 1)), move(points).ravel().tolist())
                    first = False
                gmsh.model.mesh.addElementsByType(tag, kind, list(range(element, element + len(items))),
                                                  [n for item in items for n in item])
                element += len(items)
                gmsh.model.addPhysicalGroup(dim, [tag], tag)
                gmsh.model.setPhysicalName(dim, tag, label)
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
