"""The fortress at rest against the static solution of the same mesh, found here by conjugate gradients (half a minute).

The elements are assembled independently of the program; only the mesh file is shared."""
import itertools
import os
import sys

import numpy as np
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
    k = np.zeros((len(hexes), 24, 24))
    mass = np.zeros((len(hexes), 8))
    for p in itertools.product((-1 / np.sqrt(3), 1 / np.sqrt(3)), repeat=3):
        t = 1 + CORNERS * np.array(p)
        dn = np.stack([CORNERS[:, a] * t[:, (a + 1) % 3] * t[:, (a + 2) % 3] for a in range(3)]) / 8
        jacobian = dn @ x[hexes]
        det = np.linalg.det(jacobian)
        g = np.linalg.solve(jacobian, np.broadcast_to(dn, (len(hexes), 3, 8))).transpose(0, 2, 1)
        mass += DENSITY * det[:, None] * t.prod(1) / 8
        # K_ab = la g_a g_b^T + mu g_b g_a^T + mu (g_a . g_b) 1
        flat = g.reshape(-1, 24)
        k += (la * det)[:, None, None] * flat[:, :, None] * flat[:, None, :]
        swap = (g[:, :, None, None, :] * g[:, None, :, :, None]).transpose(0, 1, 3, 2, 4)  # [a, k, b, l] = g_b[k] g_a[l]
        swap = swap + (g @ g.transpose(0, 2, 1))[:, :, None, :, None] * np.eye(3)[None, None, :, None, :]
        k += (mu * det)[:, None, None] * swap.reshape(-1, 24, 24)
    return k, mass


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
    scale = free / stiffness.diagonal()
    u, r = np.zeros(n), load * free
    z = scale * r
    p, rz = z.copy(), r @ z
    stop = relative**2 * rz
    while rz > stop:
        kp = (stiffness @ p) * free
        a = rz / (p @ kp)
        u += a * p
        r -= a * kp
        z = scale * r
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
