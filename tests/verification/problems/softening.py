"""Softening interfaces: what breaking takes, on three meshes, and the path of the law under displacements that are driven.

The bars are columns of one cell by one cell, pulled (or sheared) apart at their one interface so slowly that they stay in
balance. The area under stress over opening is G_I whatever the bar does meanwhile: unloading leads to the origin, and the
elastic part is given back."""
import numpy as np

import meshes
from columns import AXIS, MODULUS, YOUNG, rock, sides
from problem import Row, problem, relative, worst
from problems.joints import NORMAL, SHEAR, face, pair

TENSION, COHESION, FRICTION, GI, GII = 3e6, 3e6, 30.0, 60.0, 120.0
LENGTH, CELLS = 0.3, (6, 12, 24)  # m; l_ch = E G_I/sigma_t^2 = 0.333 m
SOFTENING = {"law": "softening", "tension": TENSION, "cohesion": COHESION, "friction": FRICTION, "gi": GI, "gii": GII}


def bar(lab, kind, cells):
    """Openings (slips) and stresses of the interface, and the stress of the cell that is pulled."""
    mesh = lab.path(f"bar{kind}{cells}.msh")
    h = LENGTH / cells
    meshes.hexahedra(mesh, (0, h), (0, h), np.linspace(0, LENGTH, cells + 1),
                     lambda centre: "lower" if centre[2] < LENGTH / 2 else "upper")
    end = 2 * (GI / TENSION if kind == "P" else GII / COHESION)  # opening (slip) at which nothing is left
    start, duration = 2e-3, 16e-3  # s; a wave crosses the bar in 6e-5 (1e-4)
    speed = 1.15 * (end + COHESION / MODULUS["S"] * LENGTH * (kind == "S")) / (duration - start / 2)
    axis = AXIS[kind]
    options = {**rock(), **sides(kind, ("zmin", "zmax")), "mesh": mesh, "boundary_zmin_fix": "xyz",
               "boundary_zmax_velocity": (speed, 0.0, 0.0) if axis == "x" else (0.0, 0.0, speed),
               "boundary_zmax_components": axis, "boundary_zmax_table": "start", "tables": "start",
               "table_start_type": "ramp", "table_start_delay": start, "damping_alpha": 3e3,
               "interfaces": "bond", "interface_bond_on": "between:lower:upper", "ts_max_time": duration,
               "output_interval_time": duration / 300,
               "output_fields": "stress,opening,slip,normal_stress,shear_stress"}
    options.update({f"interface_bond_{key}": value for key, value in SOFTENING.items()})
    results = lab.run(options)
    pulled = 2 if kind == "P" else 5  # zz, xz
    top = np.argmax(results.last_frame().centres()[:, 2])
    load = [frame.cell_data["stress"][top][pulled] for _, frame in results.frames()]
    if kind == "P":
        return face(results, "opening"), face(results, "normal_stress"), np.array(load)
    return face(results, "slip"), face(results, "shear_stress"), np.array(load)


def bars(lab, kind, strength, energy, words):
    found = [bar(lab, kind, cells) for cells in CELLS]
    areas = [np.sum(np.diff(gap) * (stress[1:] + stress[:-1]) / 2) for gap, stress, _ in found]
    peaks = [load.max() for _, _, load in found]
    mesh = "1x1x6, 1x1x12, 1x1x24 hexahedra, h = l_ch/6.7 and less"
    name, symbol, limit = words
    return [
        worst(f"softening bar in {name}, worst of three meshes: area, J/m^2", symbol, energy, areas, 1e-3, mesh),
        Row(f"softening bar in {name}: spread of the area over the meshes", "0; relative to " + symbol, 0.0,
            float(np.ptp(areas)), float(np.ptp(areas) / energy), 1e-3, mesh),
        worst(f"softening bar in {name}, worst of three meshes: peak load, Pa", limit, strength, peaks, 0.02, mesh),
        Row(f"softening bar in {name}: spread of the peak load over the meshes", "0; relative to " + limit, 0.0,
            float(np.ptp(peaks)), float(np.ptp(peaks) / strength), 0.02, mesh),
        worst(f"softening bar in {name}: stress left, Pa", "0; error: relative to " + limit, 0.0,
              [stress[-1] for _, stress, _ in found], 1e-10, mesh, strength)]


@problem("Softening bar pulled apart, three meshes")
def softening_tension(lab):
    assert LENGTH / CELLS[0] <= YOUNG * GI / TENSION**2 / 5
    return bars(lab, "P", TENSION, GI, ("tension", "G_I", "sigma_t"))


@problem("Softening bar sheared apart, three meshes")
def softening_shear(lab):
    return bars(lab, "S", COHESION, GII, ("shear", "G_II", "c"))


def softening_pair(lab, path):
    drive, options = pair(lab, path)
    options.update({f"interface_joint_{key}": value for key, value in SOFTENING.items()})
    options.update({"interface_joint_kn": 200 * NORMAL, "interface_joint_ks": 200 * SHEAR, "ts_dt": 2e-6,
                    "table_path_file": lab.path("fast.txt")})
    lab.path("fast.txt").write_text("".join(f"{leg * 100 * 2e-6!r} {float(value)!r}\n" for leg, value in path))
    return drive, options


@problem("A softening joint opened, closed, opened again")
def softening_cycle(lab):
    mesh, kn = "two hexahedra, every node driven", 200 * NORMAL
    first, end = TENSION / kn, 2 * GI / TENSION
    drive, options = softening_pair(lab, [(0, 0.0), (2, 0.503 * end), (3, -0.1 * end), (5, 1.107 * end), (6, 0.3 * end)])
    options.update({"boundaries": ("below", "pull"), "boundary_pull_on": "above",
                    "boundary_pull_displacement": (0.0, 0.0, 1.0), "boundary_pull_table": "path"})
    stress = face(lab.run(options), "normal_stress")
    exact, widest = [], 0.0
    for d in drive:
        widest = max(widest, d)
        damage = min(1.0, max(0.0, (widest - first) / (end - first)))
        exact.append(kn * d if d <= 0 or damage == 0 else (1 - damage) * TENSION * d / (first + damage * (end - first)))
    half, back = 0.503 * end, np.argmax(drive < 0)
    return [
        worst("softening joint in tension: stress at the worst of 600 steps, Pa", "path of the law", exact[1:], stress[1:],
              1e-10, mesh, TENSION),
        relative("softening joint in tension: secant of unloading, Pa/m", "(1 - D) sigma_t/delta_D",
                 TENSION * (end - half) / (end - first) / half,
                 (stress[back - 1] - stress[back - 9]) / (drive[back - 1] - drive[back - 9]), 1e-10, mesh),
        relative("softening joint in tension: slope closed, Pa/m", "k_n", kn,
                 (stress[300] - stress[298]) / (drive[300] - drive[298]), 1e-10, mesh)]


@problem("Direct shear of a softening joint")
def softening_direct_shear(lab):
    pressure, mesh, kn, ks = 1e6, "two hexahedra, every node driven", 200 * NORMAL, 200 * SHEAR
    rubbing, end = pressure * np.tan(np.radians(FRICTION)), 2 * GII / COHESION
    peak = (rubbing + COHESION) / ks
    # the shift at which the slip reaches its end and at which it goes on; corners on the grid, so that trapezoids are exact
    drive, options = softening_pair(lab, [(0, 0.0), (1, peak), (2, end + rubbing / ks), (3, 1.3 * end)])
    options.update({
        "boundaries": ("below", "push", "press"),
        "boundary_push_on": "above", "boundary_push_displacement": (0.6, 0.8, 0.0), "boundary_push_components": "xy",
        "boundary_push_table": "path",
        "boundary_press_on": "above", "boundary_press_displacement": (0.0, 0.0, -pressure / kn),
        "boundary_press_components": "z"})
    shear = face(lab.run(options), "shear_stress")
    slip = np.clip((drive - peak) / (1 - COHESION / (ks * end)), 0, None)
    slip = np.where(slip >= end, drive - rubbing / ks, slip)
    exact = ks * (drive - slip)
    moved = drive - shear / ks
    area = np.sum(np.diff(moved) * (shear[1:] + shear[:-1]) / 2) - rubbing * moved[-1]
    tan = "tan(phi)"
    return [
        relative("direct shear of a softening joint: peak, Pa", f"c + sigma_n {tan}", COHESION + rubbing, shear.max(), 1e-10,
                 mesh),
        relative("direct shear of a softening joint: residual, Pa", f"sigma_n {tan}", rubbing, shear[-1], 1e-10, mesh),
        relative("direct shear of a softening joint: area above friction, J/m^2", "G_II", GII, area, 1e-3, mesh),
        worst("direct shear of a softening joint: worst of 300 steps, Pa", "path of the law", exact[1:], shear[1:], 1e-10,
              mesh)]
