"""Brittle interfaces between two hexahedra whose every node is driven, so that the springs' path is known exactly."""
import numpy as np

import meshes
from problem import Row, problem, relative, worst

NORMAL, SHEAR, TENSION, COHESION, FRICTION = 2e9, 1e9, 5e4, 1e5, 30.0
STEP, LEG = 2e-5, 100  # s, steps


def pair(lab, path):
    """Two unit cubes: all nodes of the lower one fixed; path = [(leg, value)] becomes table `path`."""
    mesh, table = lab.path("pair.msh"), lab.path("path.txt")
    meshes.hexahedra(mesh, (0, 1), (0, 1), (0, 1, 2), lambda centre: "lower" if centre[2] < 1 else "upper",
                     lambda name, centre: None if name[0] == "z" else "below" if centre[2] < 1 else "above")
    table.write_text("".join(f"{leg * LEG * STEP!r} {float(value)!r}\n" for leg, value in path))
    steps = path[-1][0] * LEG
    drive = np.interp(np.arange(steps + 1) / LEG, *zip(*path))
    return drive, {
        "mesh": mesh, "block_law": "elastic", "block_young": 1e9, "block_poisson": 0.25, "block_density": 2000.0,
        "interfaces": "joint", "interface_joint_on": "between:lower:upper", "interface_joint_law": "brittle",
        "interface_joint_kn": NORMAL, "interface_joint_ks": SHEAR, "interface_joint_tension": TENSION,
        "interface_joint_cohesion": COHESION, "interface_joint_friction": FRICTION,
        "boundary_below_fix": "xyz", "tables": "path", "table_path_type": "file", "table_path_file": table,
        "ts_dt": STEP, "ts_max_steps": steps, "output_interval": 1}


def face(results, name):
    """History of a number of the one interface face."""
    return np.array([frame.cell_data[name].ravel()[0] for _, frame in results.frames("interfaces")])


@problem("Direct shear of a brittle joint, and back")
def direct_shear(lab):
    pressure, mesh = 1e6, "two hexahedra, every node driven"
    drive, options = pair(lab, [(0, 0.0), (1, 2e-3), (3, -2e-3)])
    options.update({
        "boundaries": ("below", "push", "press"),
        "boundary_push_on": "above", "boundary_push_displacement": (0.6, 0.8, 0.0), "boundary_push_components": "xy",
        "boundary_push_table": "path",
        "boundary_press_on": "above", "boundary_press_displacement": (0.0, 0.0, -pressure / NORMAL),
        "boundary_press_components": "z"})
    results = lab.run(options)
    shear, normal = face(results, "shear_stress"), face(results, "normal_stress")
    rubbing = pressure * np.tan(np.radians(FRICTION))
    peak = COHESION + rubbing
    # the law, step by step: elastic up to the cap, the excess becomes slip, and the cohesion is gone after the first
    exact, slip, cohesion = [], 0.0, COHESION
    for d in drive:
        force = SHEAR * (d - slip)
        if abs(force) > rubbing + cohesion:
            force = np.sign(force) * (rubbing + cohesion)
            slip, cohesion = d - force / SHEAR, 0.0
        exact.append(abs(force))
    tan = "tan(phi)"
    return [
        relative("direct shear: slope before the peak, Pa/m", "k_s", SHEAR, (shear[30] - shear[10]) / (drive[30] - drive[10]),
                 1e-10, mesh),
        relative("direct shear: peak, Pa", f"c + sigma_n {tan}", peak, shear.max(), 1e-10, mesh),
        relative("direct shear: after the peak, Pa", f"sigma_n {tan}", rubbing, shear[LEG], 1e-10, mesh),
        relative("direct shear: slope on reversal, Pa/m", "k_s", SHEAR,
                 (shear[LEG + 5] - shear[LEG + 10]) / (drive[LEG + 5] - drive[LEG + 10]), 1e-10, mesh),
        relative("direct shear: sliding back, Pa", f"sigma_n {tan}", rubbing, shear[-1], 1e-10, mesh),
        worst("direct shear: shear stress at the worst of 300 steps, Pa", "path of the law", exact[1:], shear[1:], 1e-10,
              mesh),
        worst("direct shear: normal stress at the worst of 300 steps, Pa", "-sigma_n", -pressure, normal[1:], 1e-10, mesh),
    ]


@problem("Tension of a bonded pair, and closing again")
def bonded_tension(lab):
    reach, mesh = TENSION / NORMAL, "two hexahedra, every node driven"
    drive, options = pair(lab, [(0, 0.0), (1, 1.503 * reach), (3, -1.507 * reach)])
    options.update({"boundaries": ("below", "pull"), "boundary_pull_on": "above",
                    "boundary_pull_displacement": (0.0, 0.0, 1.0), "boundary_pull_table": "path"})
    results = lab.run(options)
    stress, state = face(results, "normal_stress"), face(results, "state")
    peak, increment = stress.max(), NORMAL * (drive[1] - drive[0])
    missed = (TENSION - peak) / increment if peak <= TENSION else np.inf
    closed = drive < -1e-9 * reach
    opened = np.arange(len(drive)) > np.argmax(drive >= reach)
    return [
        Row("tension of a bonded pair: peak, Pa", "sigma_t; error: load increments below it", TENSION, float(peak),
            float(missed), 1.0, mesh),
        relative("tension of a bonded pair: slope, Pa/m", "k_n", NORMAL, (stress[50] - stress[10]) / (drive[50] - drive[10]),
                 1e-10, mesh),
        worst("tension of a bonded pair: stress while open, Pa", "0; error: relative to sigma_t", 0.0,
              stress[opened & ~closed], 1e-10, mesh, TENSION),
        worst("tension of a bonded pair: stress closed again, Pa", "k_n d_n", NORMAL * drive[closed], stress[closed], 1e-10,
              mesh),
        worst("tension of a bonded pair: share of broken springs", "1", 1.0, state[-1:], 0.0, mesh),
    ]
