#!/usr/bin/env python3
"""The peer of the GPU table: PyTorch, element by element. A step gathers the displacements of the eight corners, multiplies
them by the element's stiffness (one 24x24 matrix for all where the mesh is congruent, else one for each), adds the forces
up with index_add, and moves the nodes.

peer_torch.py FOLDER JSON REPEAT: as peer.py, whose output it has too. Needs torch with CUDA, numpy and h5py."""
import json
import sys
import time
from pathlib import Path

import numpy as np
import torch

from measure import median_of
from outside import last_frame
from peer_scene import element_matrices

SHARE = 0.7  # of the GPU's free memory that matrices may take


def main():
    folder, scene, repeat = Path(sys.argv[1]), json.loads(sys.argv[2]), int(sys.argv[3])
    points, cells, theirs = last_frame(folder)
    n, device = len(points), torch.device("cuda")
    constants = scene["young"], scene["poisson"], scene["density"]
    start = time.perf_counter()
    corners = points[cells[:, 0], None] - points[cells]
    congruent = bool(abs(corners - corners[:1]).max() < 1e-9 * abs(corners[0]).max())
    del corners
    mass, own = np.zeros(n), None
    if not congruent:
        need, room = 8 * 24 * 24 * len(cells), torch.cuda.mem_get_info()[0]
        if need > SHARE * room:
            sys.exit(f"{need / 2**30:.1f} GiB of matrices do not fit into {room / 2**30:.1f} GiB")
        own = torch.empty((len(cells), 24, 24), dtype=torch.float64, device=device)
    for first in range(0, len(cells), 4000):
        some = cells[first:first + 4000]
        stiffness, m = element_matrices(points[some], *constants)
        np.add.at(mass, some, m)
        if own is not None:
            own[first:first + 4000] = torch.from_numpy(stiffness).to(device)
        elif first == 0:
            shared = torch.from_numpy(stiffness[0]).to(device)
    free = np.repeat(points[:, 2] > points[:, 2].min(), 3).reshape(-1, 3)
    scale = torch.from_numpy(scene["dt"] ** 2 * free / mass[:, None]).to(device)
    load = torch.from_numpy(scene["dt"] ** 2 * np.where(free, np.array(scene["gravity"]), 0.0)).to(device)
    nodes = torch.from_numpy(cells.astype(np.int64)).to(device)
    flat = nodes.reshape(-1)
    torch.cuda.synchronize()
    assembly = time.perf_counter() - start

    def motion():
        w = 0.5 * load
        u, f = w.clone(), torch.empty_like(w)
        for _ in range(scene["steps"] - 1):
            of = u[nodes].reshape(-1, 24)
            of = of @ shared if congruent else torch.bmm(own, of.unsqueeze(2))  # the shared one is symmetric
            f.zero_().index_add_(0, flat, of.reshape(-1, 3))
            w += load
            w.addcmul_(scale, f, value=-1)
            u += w
        return u

    def run():
        torch.cuda.synchronize()
        start, cpu = time.perf_counter(), time.process_time()
        u = motion()
        torch.cuda.synchronize()
        solve, cpu = time.perf_counter() - start, time.process_time() - cpu
        return {"solve": solve, "cpu": cpu, "share": min(1.0, cpu / solve),
                "difference": float(abs(u.cpu().numpy() - theirs).max() / abs(theirs).max())}

    name = "PyTorch, gather, one 24x24, index_add" if congruent else "PyTorch, gather, bmm of own matrices, index_add"
    print(json.dumps({"assembly": assembly, "version": f"PyTorch {torch.__version__}",
                      "forms": {name: median_of(run, repeat, True, False)}}))


if __name__ == "__main__":
    main()
