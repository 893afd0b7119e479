"""What a mesh file means, worked out from its bytes alone, against what the program made of it."""
import re
from collections import defaultdict

import numpy as np

import msh

FACES = {4: ((0, 1, 2), (0, 1, 3), (1, 2, 3), (0, 2, 3)),
         5: ((0, 1, 2, 3), (4, 5, 6, 7), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7)),
         6: ((0, 1, 2), (3, 4, 5), (0, 1, 4, 3), (1, 2, 5, 4), (2, 0, 3, 5))}
EDGES = {4: ((1, 2, 3), (2, 0, 3), (0, 1, 3), (0, 2, 1)),  # three neighbours of each corner, right-handed
         5: ((1, 3, 4), (2, 0, 5), (3, 1, 6), (0, 2, 7), (7, 5, 0), (4, 6, 1), (5, 7, 2), (6, 4, 3)),
         6: ((1, 2, 3), (2, 0, 4), (0, 1, 5), (5, 4, 0), (3, 5, 1), (4, 3, 2))}
SHAPE = {4: "tet4", 5: "hex8", 6: "wedge6"}


class Wrong(Exception):
    """The program accepted what it should not have, or made something else of it."""


def demand(condition, text):
    if not condition:
        raise Wrong(text)


class Truth:
    """Cells, faces, nodes and groups of a file. Raises Wrong for a mesh that nobody should accept."""

    def __init__(self, data):
        try:
            mesh = msh.read(data)
        except msh.Unreadable as error:
            raise Wrong(f"accepted a file that cannot be read: {error}")
        self.mesh = mesh
        self.x = dict(mesh.nodes)
        demand(len(self.x) == len(mesh.nodes), "accepted two nodes of one number")
        demand(np.all(np.isfinite([x for _, x in mesh.nodes])), "accepted a coordinate that is not finite")
        for e in mesh.elements:
            demand(all(c in self.x for c in e.corners), f"accepted element {e.number} of a node that is not there")
            demand(len(set(e.corners)) == len(e.corners), f"accepted element {e.number} with a node twice")
        self.cells = [e for e in mesh.elements if e.kind in FACES]
        demand(self.cells, "accepted a mesh without volumes")
        self._check_cells()
        self._check_faces()
        self._split()

    def _check_cells(self):
        grouped = sum(bool(e.groups) for e in self.cells)
        demand(grouped in (0, len(self.cells)), "accepted volumes with and without a group")
        demand(all(len(e.groups) < 2 for e in self.cells), "accepted a volume in two groups")
        for e in self.cells:
            x = np.array([self.x[c] for c in e.corners])
            for corner, ends in enumerate(EDGES[e.kind]):
                demand(np.linalg.det(x[list(ends)] - x[corner]) > 0, f"accepted the inverted element {e.number}")

    def _check_faces(self):
        self.face_cells = defaultdict(list)
        for i, e in enumerate(self.cells):
            for face in FACES[e.kind]:
                self.face_cells[frozenset(e.corners[k] for k in face)].append(i)
        demand(max(map(len, self.face_cells.values())) <= 2, "accepted more than two elements at a face")
        corners = [frozenset(e.corners) for e in self.cells]
        demand(len(set(corners)) == len(corners), "accepted an element twice")
        self.groups = defaultdict(list)  # (dimension, tag) -> corner sets
        for e in self.mesh.elements:
            for tag in e.groups:
                self.groups[msh.DIMENSION[e.kind], tag].append(frozenset(e.corners))
            if msh.DIMENSION[e.kind] == 2 and e.groups:
                demand(frozenset(e.corners) in self.face_cells, f"accepted surface element {e.number}, which is no face")

    def name(self, dim, tag):
        """The group's name as options have it."""
        name = self.mesh.names.get((dim, tag), "")
        kind = ("point", "line", "surface", "region")[dim]
        return re.sub(r"[^A-Za-z0-9_.\x80-\xff-]", "_", name) or f"{kind}_{tag}"

    def tag(self, dim, name):
        found = [tag for d, tag in self.groups if d == dim and self.name(dim, tag) == name]
        return found[0] if len(found) == 1 else None

    def _split(self):
        """Nodes: corners of cells, joined across faces."""
        self.parent = {(i, c): (i, c) for i, e in enumerate(self.cells) for c in e.corners}

    def find(self, key):
        while self.parent[key] != key:
            key = self.parent[key]
        return key

    def n_nodes(self, interface_faces):
        self._split()
        for face, cells in self.face_cells.items():
            if len(cells) == 2 and face not in interface_faces:
                for corner in face:
                    a, b = self.find((cells[0], corner)), self.find((cells[1], corner))
                    self.parent[max(a, b)] = min(a, b)
        return len({self.find(key) for key in self.parent})


def compare(data, case, results):
    """Raises Wrong unless the run of the mesh scene `case` shows what the file means."""
    truth = Truth(data)
    summary = results.summary
    wanted = defaultdict(int)
    for e in truth.cells:
        wanted[SHAPE[e.kind]] += 1
    demand(summary["elements"] == dict(wanted), f"elements {summary['elements']} instead of {dict(wanted)}")
    inner = set()
    if case.get("interface"):
        tag = truth.tag(2, case["interface"])
        demand(tag is not None, f"an interface on the surface {case['interface']}, which is not in the file")
        inner = {face for face in truth.groups[2, tag] if len(truth.face_cells[face]) == 2}
    demand(summary["interfaces"] == len(inner), f"{summary['interfaces']} interface faces instead of {len(inner)}")
    nodes = truth.n_nodes(inner)
    demand(summary["nodes"] == nodes, f"{summary['nodes']} nodes instead of {nodes}")
    frame = results.frame()
    n = [len(e.corners) for e in truth.cells]
    demand(len(frame.offsets) == len(n) + 1, "the frame has another number of cells")
    regions = sorted({tag for d, tag in truth.groups if d == 3})
    shown = sorted((int(frame.region[i]), frame.points[frame.cell(i)].tolist()) for i in range(len(n)))
    meant = sorted((regions.index(e.groups[0]) if e.groups else 0, [list(truth.x[c]) for c in e.corners])
                   for e in truth.cells)
    demand(shown == meant, "cells of the frame have other corners or regions than those of the file")
    name = case["boundary"]
    tags = [(dim, truth.tag(dim, name)) for dim in (0, 1, 2) if truth.tag(dim, name) is not None]
    demand(len(tags) == 1, f"a boundary on {name}, which is not in the file once")
    held = {truth.x[c] for corners in truth.groups[tags[0]] for c in corners}
    moved = np.all(np.abs(frame.velocity - case["velocity"]) <= 1e-9 * np.abs(case["velocity"]), axis=1)
    shown = {tuple(x) for x in frame.points[moved].tolist()}
    used = {truth.x[c] for e in truth.cells for c in e.corners}
    demand(shown == held & used, f"boundary {name} moves {len(shown)} places instead of {len(held & used)}")
