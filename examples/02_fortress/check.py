"""The fortress at rest against the static solution of the same mesh, found here by conjugate gradients (ten seconds).

The elements are assembled independently of the program; only the mesh file is shared."""
import itertools
import os
import sys

import numpy as np
import scipy.linalg
import scipy.sparse

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(HERE, ".."))
import checks

YOUNG, POISSON, DENSITY, GRAVITY = 5.0e9, 0.2, 2200.0, 9.81
POINTS = {"keep": (4.4, 3.675, 12.5), "gate": (0, -11.965, 9.0), "tower": (-14.44, -11.965, 9.0)}
CORNERS = np.array([[-1, -1, -1], [1, -1, -1], [1, 1, -1], [-1, 1, -1],
                    [-1, -1, 1], [1, -1, 1], [1, 1, 1], [-1, 1, 1]], float)


def read_mesh(path):
    """Nodes (n, 3) and hexahedra (m, 8) of a binary gmsh 2.2 file."""
    with open(path, "rb") as f:
        data = f.read()
    at = data.index(b"\n", data.index(b"$Nodes\n") + 7) + 1
    n = int(data[data.index(b"$Nodes\n") + 7:at])
    nodes = np.frombuffer(data, np.dtype([("tag", "<i4"), ("x", "<f8", 3)]), n, at)
    begin = data.index(b"$Elements\n", at + n * 28) + 10
    at = data.index(b"\n", begin) + 1
    left, hexes = int(data[begin:at]), []
    while left > 0:
        kind, many, tags = np.frombuffer(data, "<i4", 3, at)
        corners = {3: 4, 5: 8}[int(kind)]
        width = 1 + tags + corners
        if kind == 5:
            hexes.append(np.frombuffer(data, "<i4", many * width, at + 12).reshape(many, width)[:, 1 + tags:])
        at += 12 + 4 * int(many) * int(width)
        left -= many
    number = np.zeros(nodes["tag"].max() + 1, int)
    number[nodes["tag"]] = np.arange(n)
    return nodes["x"], number[np.concatenate(hexes)]


def elements(x, hexes):
    """Stiffness matrices (m, 24, 24) and corner masses (m, 8), 2 x 2 x 2 Gauss points."""
    la = YOUNG * POISSON / ((1 + POISSON) * (1 - 2 * POISSON))
    mu = YOUNG / (2 * (1 + POISSON))
    law = la * np.pad(np.ones((3, 3)), (0, 3)) + mu * np.diag([2, 2, 2, 1, 1, 1])
    k = np.zeros((len(hexes), 24, 24))
    mass = np.zeros((len(hexes), 8))
    for p in itertools.product((-1 / np.sqrt(3), 1 / np.sqrt(3)), repeat=3):
        t = 1 + CORNERS * np.array(p)
        dn = np.stack([CORNERS[:, a] * t[:, (a + 1) % 3] * t[:, (a + 2) % 3] for a in range(3)]) / 8
        jacobian = dn @ x[hexes]
        det = np.linalg.det(jacobian)
        g = np.linalg.solve(jacobian, np.broadcast_to(dn, (len(hexes), 3, 8)))
        mass += DENSITY * det[:, None] * t.prod(1) / 8
        strain = np.zeros((len(hexes), 6, 8, 3))  # of unit displacements: xx, yy, zz, twice xy, yz, zx
        for row, (i, j) in enumerate(((0, 0), (1, 1), (2, 2), (0, 1), (1, 2), (2, 0))):
            strain[:, row, :, i], strain[:, row, :, j] = g[:, j], g[:, i]
        strain = strain.reshape(-1, 6, 24)
        k += strain.transpose(0, 2, 1) @ (det[:, None, None] * (law @ strain))
    return k, mass


def rigid_motions(x, free, size=4.0):
    """Those of the parts of the body in boxes of this size [m], as columns: the slow part of the conjugate gradients."""
    _, part, nodes = np.unique(np.floor(x / size), axis=0, return_inverse=True, return_counts=True)
    part = part.ravel()
    arm = x - np.stack([np.bincount(part, x[:, a]) / nodes for a in range(3)], axis=1)[part]
    modes = np.zeros((len(x), 3, 6))
    modes[:, range(3), range(3)] = 1
    for a in range(3):
        modes[:, (a + 1) % 3, 3 + a], modes[:, (a + 2) % 3, 3 + a] = -arm[:, (a + 2) % 3], arm[:, (a + 1) % 3]
    columns = np.repeat(6 * part, 3)[:, None] + np.arange(6)
    values = modes.reshape(-1, 6) * free[:, None]
    return scipy.sparse.csr_matrix((values.ravel(), columns.ravel(), 6 * np.arange(len(free) + 1)), (len(free), 6 * len(nodes)))


def static(x, hexes, relative=1e-8):
    """Displacements at rest (n, 3) and the work of gravity."""
    k, corner_mass = elements(x, hexes)
    dofs = (3 * hexes[:, :, None] + np.arange(3)).reshape(len(hexes), 24)
    n = 3 * len(x)

    mass = np.bincount(hexes.ravel(), corner_mass.ravel(), len(x))
    load = np.zeros((len(x), 3))
    load[:, 2] = -GRAVITY * mass
    load = load.ravel()
    free = np.repeat(x[:, 2] > 1e-6, 3)
    rows, columns = np.repeat(dofs, 24, axis=1), np.tile(dofs, (1, 24))
    stiffness = scipy.sparse.coo_matrix((k.ravel(), (rows.ravel(), columns.ravel())), (n, n)).tobsr((3, 3))
    scale, rigid = free / stiffness.diagonal(), rigid_motions(x, free)
    coarse = (rigid.T @ (stiffness @ rigid)).toarray()
    coarse[np.diag_indices_from(coarse)] += 1e-9 * coarse.max()  # parts that are held, or lie on a line
    factor = scipy.linalg.cho_factor(coarse)

    def eased(r):
        return scale * r + rigid @ scipy.linalg.cho_solve(factor, rigid.T @ r)

    u, r = np.zeros(n), load * free
    z = eased(r)
    p, rz = z.copy(), r @ z
    stop = relative**2 * rz
    while rz > stop:
        kp = (stiffness @ p) * free
        a = rz / (p @ kp)
        u += a * p
        r -= a * kp
        z = eased(r)
        rz, old = r @ z, rz
        p = z + rz / old * p
    return u.reshape(-1, 3), load @ u


def main():
    out = checks.folder()
    h, s = checks.histories(out), checks.summary(out)
    x, hexes = read_mesh(os.path.join(HERE, "../../meshes/fortress.msh"))
    u, work = static(x, hexes)
    rows = [("hexahedra", 41232, sum(s["elements"].values()), 0)]
    for name, at in POINTS.items():
        node = np.argmin(((x - at) ** 2).sum(1))
        rows.append((f"settlement of the {name} (m)", u[node, 2], h[name][-1], 1e-5))
    rows.append(("strain energy, half the work of gravity (J)", work / 2, s["energy"]["strain"], 1e-5))
    checks.report(rows)


if __name__ == "__main__":
    main()
