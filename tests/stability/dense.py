"""The exact critical step of a small scene: a dense stiffness matrix, made here from the nodes of its first frame."""
import itertools

import numpy as np

CORNERS = np.array([(-1, -1, -1), (1, -1, -1), (1, 1, -1), (-1, 1, -1), (-1, -1, 1), (1, -1, 1), (1, 1, 1), (-1, 1, 1)])
GAUSS = np.array(list(itertools.product((-1, 1), repeat=3))) / np.sqrt(3)
FACES = {8: ((0, 3, 2, 1), (4, 5, 6, 7), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7)),
         4: ((0, 2, 1), (0, 1, 3), (1, 2, 3), (2, 0, 3))}


def gradients(x):
    """Volumes and gradients of the shape functions, dN/dx, at the points of a hexahedron or a tetrahedron."""
    if len(x) == 4:
        edges = x[1:] - x[0]
        inverse = np.linalg.inv(edges).T
        return [(abs(np.linalg.det(edges)) / 6, np.vstack((-inverse.sum(axis=0), inverse)))]
    found = []
    for point in GAUSS:
        factors = 1 + CORNERS * point
        local = np.stack([CORNERS[:, k] * np.delete(factors, k, axis=1).prod(axis=1) / 8 for k in range(3)], axis=1)
        jacobian = x.T @ local
        found.append((np.linalg.det(jacobian), local @ np.linalg.inv(jacobian)))
    return found


def element(x, lame, shear, mean_dilatation=False):
    """Stiffness of an element of nodes x, full integration or mean dilatation; and its volume per node (row sum)."""
    points, n = gradients(x), len(x)
    volume = sum(w for w, _ in points)
    mean = sum(w * g for w, g in points).ravel() / volume
    stiffness, share = np.zeros((3 * n, 3 * n)), np.full(n, volume / n)
    if n == 8:
        share = sum(w * (1 + CORNERS * p).prod(axis=1) / 8 for (w, _), p in zip(points, GAUSS))
    for w, g in points:
        strain = np.zeros((6, 3 * n))
        for row, (a, b) in enumerate(((0, 0), (1, 1), (2, 2), (0, 1), (1, 2), (2, 0))):
            strain[row, a::3] += g[:, b]
            if a != b:
                strain[row, b::3] += g[:, a]
        dilation = g.ravel()
        if mean_dilatation:
            strain[:3] += (mean - dilation) / 3
            dilation = mean
        stiffness += w * (lame * np.outer(dilation, dilation) + shear * strain.T @ np.diag((2, 2, 2, 1, 1, 1)) @ strain)
    return stiffness, share


def face_areas(x):
    """The integrals of N_j n dA over a face."""
    if len(x) == 3:
        return np.tile(np.cross(x[1] - x[0], x[2] - x[0]) / 6, (3, 1))
    areas, corner = np.zeros((4, 3)), CORNERS[:4, :2]
    for point in itertools.product((-1, 1), repeat=2):
        factors = 1 + corner * np.array(point) / np.sqrt(3)
        along = [(corner[:, k] * factors[:, 1 - k] / 4) @ x for k in range(2)]
        areas += np.outer(factors.prod(axis=1) / 4, np.cross(*along))
    return areas


def critical_step(frame, young, poisson, density, free=lambda x: np.ones(len(x), bool), factor=None, mean_dilatation=False):
    """2/w of the nodes that are free [s]; young: a number or one per cell; springs where two cells have a face at one place
    but no node in common, of this stiffness factor."""
    cells = [frame.nodes(c) for c in range(len(frame.offsets) - 1)]
    young = np.broadcast_to(young, len(cells))
    lame, shear = young * poisson / ((1 + poisson) * (1 - 2 * poisson)), young / (2 * (1 + poisson))
    x = np.asarray(frame.points, float)
    size = np.ptp(x, axis=0).max()
    stiffness, mass, faces = np.zeros((3 * len(x), 3 * len(x))), np.zeros(len(x)), {}
    for c, nodes in enumerate(cells):
        dofs = (3 * np.asarray(nodes)[:, None] + np.arange(3)).ravel()
        k, share = element(x[nodes], lame[c], shear[c], mean_dilatation)
        stiffness[np.ix_(dofs, dofs)] += k
        mass[nodes] += density * share
        for face in FACES[len(nodes)]:
            corners = np.asarray(nodes)[list(face)]
            key = tuple(sorted(map(tuple, np.round(x[corners] / size, 9))))
            faces.setdefault(key, []).append((c, corners))
    for pair in faces.values():
        if factor is None or len(pair) < 2 or set(pair[0][1]) & set(pair[1][1]):
            continue
        (a, left), (b, right) = pair
        h = np.linalg.norm(x[cells[a]].mean(axis=0) - x[cells[b]].mean(axis=0))
        soft = min((a, b), key=lambda c: lame[c] + 2 * shear[c])
        kn, ks = factor * (lame[soft] + 2 * shear[soft]) / h, factor * shear[soft] / h
        for node, area in zip(left, face_areas(x[left])):
            other = right[np.argmin(np.linalg.norm(x[right] - x[node], axis=1))]
            size_of, n = np.linalg.norm(area), area / np.linalg.norm(area)
            k = size_of * (kn * np.outer(n, n) + ks * (np.eye(3) - np.outer(n, n)))
            for p, q, sign in ((node, node, 1), (other, other, 1), (node, other, -1), (other, node, -1)):
                stiffness[3 * p:3 * p + 3, 3 * q:3 * q + 3] += sign * k
    keep = np.repeat(free(x), 3)
    root = np.repeat(np.sqrt(mass), 3)[keep]
    return 2 / np.sqrt(np.linalg.eigvalsh(stiffness[np.ix_(keep, keep)] / np.outer(root, root))[-1])
