#!/usr/bin/env python3
"""The peer of the CPU table: the assembled stiffness of the same mesh, multiplied by the displacement in every step.

peer.py FOLDER JSON REPEAT: FOLDER holds the frames of a finished run of cdem on a box whose lowest face is held, JSON
gives young, poisson, density, gravity, dt, steps. Prints JSON: seconds of the loop for each form of the matrix, and the
largest difference of the end state from cdem's, over the largest displacement. Needs numpy, scipy and h5py.

It assembles from the frame's points and cells by its own code (8-node hexahedra, 2x2x2 Gauss points), folds dt^2, mass
and support into the matrix, and so needs one product and two sums a step: the cheapest form of this way."""
import json
import sys
import tempfile
import time
from pathlib import Path

import numpy as np
import scipy
import scipy.sparse as sparse

import block_csr
from measure import Failed, median_of
from outside import last_frame
from peer_scene import element_matrices


def stiffness(points, cells, scene):
    """Stiffness (CSR, three rows a node) and lumped masses of the nodes."""
    n = len(points)
    mass, parts = np.zeros(n), []
    for some in np.array_split(cells, max(1, len(cells) // 4000)):
        k, m = element_matrices(points[some], scene["young"], scene["poisson"], scene["density"])
        np.add.at(mass, some, m)
        dof = (3 * some[:, :, None] + np.arange(3)).reshape(-1, 24)
        rows, columns = np.repeat(dof, 24, axis=1), np.tile(dof, (1, 24))
        parts.append(sparse.coo_matrix((k.ravel(), (rows.ravel(), columns.ravel())), shape=(3 * n, 3 * n)).tocsr())
    while len(parts) > 1:  # sums of neighbours stay small
        parts = [sum(parts[i + 1:i + 2], parts[i]) for i in range(0, len(parts), 2)]
    return parts[0], mass


def assemble(points, cells, scene):
    """dt^2 M^-1 K with the rows of the held nodes empty, and dt^2 times the acceleration by weight."""
    matrix, mass = stiffness(points, cells, scene)
    free = np.repeat(points[:, 2] > points[:, 2].min(), 3)
    scale = scene["dt"] ** 2 * free / np.repeat(mass, 3)
    load = scene["dt"] ** 2 * np.where(free, np.tile(scene["gravity"], len(points)), 0.0)
    return (sparse.diags(scale) @ matrix).tocsr(), load


def main():
    folder, scene, repeat = Path(sys.argv[1]), json.loads(sys.argv[2]), int(sys.argv[3])
    points, cells, theirs = last_frame(folder)
    theirs = theirs.ravel()
    start = time.perf_counter()
    matrix, load = assemble(points, cells, scene)
    assembly = time.perf_counter() - start
    blocks = matrix.tobsr((3, 3))
    scratch = tempfile.TemporaryDirectory()
    try:
        loop = block_csr.loop(scratch.name)
    except Failed:  # the forms of scipy need no compiler
        loop = None

    def product(a):
        u, w = np.zeros_like(load), 0.5 * load
        u += w
        for _ in range(scene["steps"] - 1):
            w += load
            w -= a @ u
            u += w
        return u

    def native():
        u, w = 0.5 * load, 0.5 * load
        loop(blocks, scene["steps"] - 1, load, u, w)
        return u

    forms = {"CSR, scipy": lambda: product(matrix), "block CSR 3x3, scipy": lambda: product(blocks)}
    if loop:
        forms["block CSR 3x3, plain C loop (cc -O3 -march=native)"] = native
    result = {"assembly": assembly, "version": f"scipy {scipy.__version__}", "forms": {}}
    for name, form in forms.items():
        def run():
            start, cpu = time.perf_counter(), time.process_time()
            u = form()
            solve, cpu = time.perf_counter() - start, time.process_time() - cpu
            return {"solve": solve, "cpu": cpu, "share": min(1.0, cpu / solve),
                    "difference": float(abs(u - theirs).max() / abs(theirs).max())}
        result["forms"][name] = median_of(run, repeat, False, True)
    print(json.dumps(result))


if __name__ == "__main__":
    main()
