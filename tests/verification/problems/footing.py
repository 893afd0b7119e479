"""Bearing capacity of a rigid rough strip footing on weightless Tresca soil, in plane strain (Prandtl).

Drucker-Prager with friction 0 on the inscribed cone has k = s3 c cos(0)/sqrt(3 + sin^2(0)) = c. In plane strain without
volume change the flow ends with a deviator of pure shear, sqrt(J2) = (s1 - s3)/2: so k = c is Tresca's criterion. (Outer and
middle cone have k = 2 c/s3 at friction 0, 15 % more.)

Half of the footing, 1 m, stands on the left end of a slab of soil one element thick. Its nodes sink at a rate that falls to
nothing at the end, so that neither inertia nor damping is left in its load. That load is got without reactions: with the
virtual velocity z (z = 0 at the base) the work of the stresses is the sum of stress_zz V, and the only force that works is
that of the footing, on z = H. It holds for every element form, since the gradient of z is uniform."""
import numpy as np

import meshes
from problem import order, problem, relative

SHEAR, POISSON, DENSITY, COHESION = 3e9, 0.3, 2000.0, 100e3
LENGTH, DEPTH = 5.0, 2.5   # m, of the soil; Prandtl's mechanism reaches to 3 and 1.41
SETTLEMENT, PASSAGES = 6e-4, 40  # m, small: the limit load does not depend on stiffness; the time in passages of a shear wave from top to base
EXACT = (2 + np.pi) * COHESION
FORMULA = "(2 + pi) c"


def lines(cells, end):
    """From 0 to end: so many equal cells to 1, beyond it growing ones; twice the cells halve all of them."""
    out, h, ratio = list(np.linspace(0, 1, cells + 1)), 1 / cells, 1.15**(8 / cells)
    while out[-1] < end:
        h *= ratio
        out.append(end if end - out[-1] < 1.6 * h else out[-1] + h)
    return out


def write_mesh(path, cells, tetrahedra):
    def side(name, centre):
        if name == "zmax":
            return "footing" if centre[0] < 1 else None
        return {"ymin": "faces", "ymax": "faces", "xmin": "ends", "xmax": "ends", "zmin": "base"}[name]
    z = DEPTH - np.array(lines(cells, DEPTH))[::-1]
    meshes.hexahedra(path, lines(cells, LENGTH), [0, 1 / cells], z, lambda centre: "soil", side, tetrahedra=tetrahedra)


def scene(folder, mesh):
    speed = np.sqrt(SHEAR / DENSITY)
    time = PASSAGES * DEPTH / speed
    t = np.linspace(0, 1, 51)  # settlement S (1 - (1 - t/T)^3), after a short ramp
    rate = 3 * SETTLEMENT / time * (1 - t)**2 * np.minimum(1, t / 0.02)
    (folder / "rate.txt").write_text("".join(f"{a * time:.17g} {b:.17g}\n" for a, b in zip(t, rate)))
    return {
        "mesh": mesh, "block_law": "drucker_prager", "block_cone": "inscribed", "block_young": 2 * SHEAR * (1 + POISSON),
        "block_poisson": POISSON, "block_density": DENSITY, "block_cohesion": COHESION, "block_friction": 0.0,
        "boundaries": ["faces", "ends", "base", "footing"], "boundary_faces_fix": "y", "boundary_ends_fix": "x",
        "boundary_base_fix": "xyz", "boundary_footing_velocity": (0.0, 0.0, -1.0), "boundary_footing_table": "rate",
        "tables": ["rate"], "table_rate_type": "file", "table_rate_file": folder / "rate.txt",
        "damping_alpha": speed / DEPTH, "ts_max_time": time, "output_fields": ("displacement", "stress")}


def volume(points):
    """Of a tetrahedron, or of a brick along the axes."""
    return abs(np.linalg.det(points[1:] - points[0])) / 6 if len(points) == 4 else np.prod(np.ptp(points, axis=0))


def bearing(lab, cells, shape, element):
    """Mean pressure under the footing at the end, Pa."""
    mesh = lab.path(f"{shape}{cells}.msh")
    if not mesh.exists():
        write_mesh(mesh, cells, shape == "tetrahedra")
    frame = lab.run({**scene(lab.folder, mesh), "block_element": element}).last_frame()
    volumes = np.array([volume(frame.points[frame.nodes(c)]) for c in range(len(frame.offsets) - 1)])
    return -(volumes @ frame.cell_data["stress"][:, 2]) / (DEPTH * np.ptp(frame.points[:, 1]))


def rows(lab, shape, counts, bar, best):
    """Pressures of bbar on meshes with such counts of cells under the half footing, their order and their limit."""
    loads = [bearing(lab, n, shape, "bbar") for n in counts]
    out = [relative(f"strip footing, {shape}, bbar, {n} cells: pressure, Pa", FORMULA, EXACT, q, b,
                    f"slab of {shape}, 2 x {n} under the footing") for n, q, b in zip(counts, loads, bar)]
    mesh = " and ".join(str(n) for n in counts[-2:]) + " cells"
    above = [q - EXACT if q > EXACT else np.nan for q in loads]  # a load from below misses its bar
    out.append(order(f"strip footing, {shape}, bbar: order in h, from above", [1 / n for n in counts], above, 1, 0.2, mesh))
    out.append(relative(f"strip footing, {shape}, bbar: pressure extrapolated to h = 0, Pa", FORMULA, EXACT,
                        2 * loads[-1] - loads[-2], best, mesh))
    return out


@problem("Prandtl's strip footing: hexahedra and tetrahedra, bbar")
def footing(lab):
    out = rows(lab, "hexahedra", (4, 8, 16), (0.15, 0.075, 0.04), 0.005)
    out += rows(lab, "tetrahedra", (8, 16), (0.08, 0.04), 0.005)
    for shape, bar in (("hexahedra", 0.16), ("tetrahedra", 0.11)):
        out.append(relative(f"strip footing, {shape}, full, 16 cells, for comparison: it locks", FORMULA, EXACT,
                            bearing(lab, 16, shape, "full"), bar, f"slab of {shape}, 2 x 16 under the footing"))
    return out


@problem("Prandtl's strip footing on fine meshes", long=True)
def footing_fine(lab):
    return (rows(lab, "hexahedra", (16, 32), (0.04, 0.02), 0.002) +
            rows(lab, "tetrahedra", (16, 32), (0.04, 0.02), 0.002))
