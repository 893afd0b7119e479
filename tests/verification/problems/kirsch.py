"""A circular hole dug into stressed rock: stress from the start, removal of the hole's region, relaxation (Kirsch)."""
import numpy as np

import harness
import meshes
from problem import Row, order, problem, worst

BULK, SHEAR, RADIUS, OUTER = 500e6, 300e6, 0.1, 0.4
POISSON = (3 * BULK - 2 * SHEAR) / (2 * (3 * BULK + SHEAR))
SX, SY, PRESSURE = 11.25e6, 9e6, 2e6  # compression positive; along x, along y, and later on the wall
MEAN, DEVIATOR = (SX + SY) / 2, (SX - SY) / 2


def displacement(x, y):
    """Displacement that digging the hole makes, plane strain."""
    r, t = np.hypot(x, y), np.arctan2(y, x)
    q = (RADIUS / r) ** 2
    inward = r * q / (2 * SHEAR) * (MEAN - PRESSURE + DEVIATOR * (4 * (1 - POISSON) - q) * np.cos(2 * t))
    around = r * q / (2 * SHEAR) * DEVIATOR * (2 * (1 - 2 * POISSON) + q) * np.sin(2 * t)
    return np.array([-inward * np.cos(t) - around * np.sin(t), -inward * np.sin(t) + around * np.cos(t)])


def stress(r, t):
    """Radial, hoop and shear stress round the hole, tension positive."""
    q, c, s = (RADIUS / r) ** 2, np.cos(2 * t), np.sin(2 * t)
    return -np.array([MEAN * (1 - q) + DEVIATOR * (1 - 4 * q + 3 * q * q) * c + PRESSURE * q,
                      MEAN * (1 + q) - DEVIATOR * (1 + 3 * q * q) * c - PRESSURE * q,
                      -DEVIATOR * (1 + 2 * q - 3 * q * q) * s])


def scene(mesh, n):
    outside = [f"o{i}" for i in range(2 * n + 1)]
    options = {
        "mesh": mesh, "block_law": "elastic", "block_young": 9 * BULK * SHEAR / (3 * BULK + SHEAR), "block_poisson": POISSON,
        "block_density": 2500.0, "block_stress": (-SX, -SY, -POISSON * (SX + SY), 0, 0, 0),
        "boundaries": ["west", "south", "faces", *outside], "boundary_west_fix": "x", "boundary_south_fix": "y",
        "boundary_faces_fix": "z",
        "solve": "relax", "stages": ("insitu", "dig"), "stage_dig_remove": "core",
        "stage_dig_boundaries": ["west", "south", "faces", *outside, "wall"], "stage_dig_boundary_wall_pressure": PRESSURE}
    for i, name in enumerate(outside):
        t = i * np.pi / 4 / n
        options[f"boundary_{name}_displacement"] = (0.0, 0.0, 0.0)
        options[f"stage_dig_boundary_{name}_displacement"] = (*displacement(OUTER * np.cos(t), OUTER * np.sin(t)), 0.0)
    return options


def polar_stress(frame):
    """Places (radius, angle) of the centres of the rock's cells, and their radial, hoop and shear stress."""
    rock = frame.cell_data["region"] == 0
    centre, (xx, yy, _, xy, _, _) = frame.centres()[rock], frame.cell_data["stress"][rock].T
    t = np.arctan2(centre[:, 1], centre[:, 0])
    c, s = np.cos(t), np.sin(t)
    return np.hypot(centre[:, 0], centre[:, 1]), t, np.array([
        xx * c * c + yy * s * s + 2 * xy * s * c, xx * s * s + yy * c * c - 2 * xy * s * c,
        (yy - xx) * s * c + xy * (c * c - s * s)])


def hoop_at_wall(r, t, hoop, n):
    """Angles of the 2n cells round the wall, and the hoop stress there: a parabola through the three innermost cells."""
    sector, found = np.floor(t / (np.pi / 4 / n)), []
    for k in range(2 * n):
        three = np.flatnonzero(sector == k)[np.argsort(r[sector == k])[:3]]
        found.append(np.polyval(np.polyfit(r[three] - RADIUS, hoop[three], 2), 0.0))
    return (np.arange(2 * n) + 0.5) * np.pi / 4 / n, np.array(found)


@problem("Circular hole dug into stressed rock (Kirsch)")
def kirsch(lab):
    sizes, rows, still, fields, walls = (8, 16, 32), [], 0.0, [], []
    for n in sizes:
        path = lab.path(f"kirsch_{n}.msh")
        meshes.from_geo(path, harness.ROOT / "meshes" / "kirsch.geo", n=n)
        frames = [frame for _, frame in lab.run(scene(path, n)).frames()]
        still = max(still, np.abs(frames[-2].point_data["displacement"]).max())
        r, t, computed = polar_stress(frames[-1])
        mesh = f"quarter to 4 radii, {2 * n} hexahedra round the wall"
        fields.append(np.sqrt(np.mean((computed - stress(r, t)) ** 2)) / SX)
        angles, hoop = hoop_at_wall(r, t, computed[1], n)
        rows.append(worst("Kirsch, hoop stress at the worst place of the wall, Pa",
                          "-(sx + sy - 2 (sx - sy) cos 2t - p)", stress(RADIUS, angles)[1], hoop, 0.01, mesh))
        points, u = frames[-1].points, frames[-1].point_data["displacement"]
        wall = np.abs(np.hypot(points[:, 0], points[:, 1]) / RADIUS - 1) < 1e-6
        x, y = points[wall, :2].T
        inward = -(u[wall, 0] * x + u[wall, 1] * y) / RADIUS
        exact = -(displacement(x, y) * (x, y)).sum(axis=0) / RADIUS
        rows.append(worst("Kirsch, closure at the worst node of the wall, m",
                          "a/2G ((sx + sy)/2 - p + (sx - sy)/2 (3 - 4 nu) cos 2t)", exact, inward, 0.005, mesh))
        walls.append(rows[-1].error)
    rows.insert(0, Row("Kirsch, movement before the hole is dug, m", "0; error: relative to the largest closure", 0.0, still,
                       still / np.max(exact), 1e-12, "all three"))
    what = ("Kirsch, order in h of the stress (root mean square over the cells)", "Kirsch, order in h of the closure")
    return rows + [order(quantity, [1 / n for n in sizes], errors, 2.0, 0.1, "16, 32, 64 hexahedra round the wall")
                   for quantity, errors in zip(what, (fields, walls))]
