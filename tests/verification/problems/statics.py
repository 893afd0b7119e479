"""Columns and stacks of blocks at rest, by a dynamic run with nearly critical alpha damping."""
import numpy as np

import columns
from problem import problem, relative, worst

GRAVITY = 9.81


@problem("Gravity column")
def gravity_column(lab):
    young, poisson, density, cells, h = 1e9, 0.25, 2000.0, 20, 1.0
    modulus = young * (1 - poisson) / ((1 + poisson) * (1 - 2 * poisson))
    height = cells * h
    lowest = 2 / h * np.sqrt(modulus / density) * np.sin(np.pi * h / (4 * height))
    options = {**columns.box(cells, h), "block_law": "elastic", "block_young": young, "block_poisson": poisson,
               "block_density": density, "gravity": (0, 0, -GRAVITY), **columns.sides("P", ("zmin",)),
               "boundary_zmin_fix": "xyz", **columns.to_rest(lowest)}
    frame = lab.run(options).last_frame()
    z, u, stress = frame.points[:, 2], frame.point_data["displacement"], frame.cell_data["stress"][:, 2]
    centre = frame.centres()[:, 2]
    two = np.argsort(centre)[:2]
    base = stress[two[0]] * 1.5 - stress[two[1]] * 0.5
    mesh = f"1x1x{cells} hexahedra"
    return [
        worst("gravity column, u_z at the worst node, m", "-rho g (H z - z^2/2)/(lambda + 2 G)",
              -density * GRAVITY * (height * z - z**2 / 2) / modulus, u[:, 2], 1e-10, mesh),
        worst("gravity column, stress_zz at the worst cell, Pa", "-rho g (H - z)",
              -density * GRAVITY * (height - centre), stress, 1e-10, mesh),
        relative("gravity column, stress at the base, Pa", "-rho g H", -density * GRAVITY * height, base, 1e-10, mesh),
    ]


@problem("Stack of blocks with joints k_n = b E/h")
def stack(lab):
    young, density, cells, h, pressure, rows = 1e9, 2000.0, 10, 1.0, 1e6, []
    for b in (1.0, 10.0, 50.0):
        kn = b * young / h
        lowest = columns.frequencies(*columns.stack_matrices(cells, h, h * h, young, density, kn))[0][0]
        options = {**columns.box(cells, h), "block_law": "elastic", "block_young": young, "block_poisson": 0.0,
                   "block_density": density, "interfaces": "joints", "interface_joints_on": "all",
                   "interface_joints_law": "elastic", "interface_joints_stiffness_factor": b,
                   "boundaries": ("zmin", "zmax"), "boundary_zmin_fix": "xyz", "boundary_zmax_pressure": pressure,
                   **columns.to_rest(lowest)}
        results = lab.run(options)
        frame, joints = results.last_frame(), results.last_frame("interfaces")
        top = frame.point_data["displacement"][frame.points[:, 2] > (cells - 0.25) * h, 2].mean()
        mesh = f"{cells} blocks of one hexahedron"
        rows += [relative(f"stack, b = {b:g}: E_eff, Pa", "E n b/(n b + n - 1)",
                          young * cells * b / (cells * b + cells - 1), -pressure * cells * h / top, 1e-10, mesh),
                 worst(f"stack, b = {b:g}: opening of the worst joint, m", "-p/k_n", -pressure / kn,
                       joints.cell_data["opening"], 1e-10, mesh)]
    return rows


@problem("Joint closure under weight")
def joint_closure(lab):
    young, density, cells, h, kn = 1e9, 2000.0, 5, 1.0, 5e8
    modulus = young * 0.75 / (1.25 * 0.5)
    lowest = columns.frequencies(*columns.stack_matrices(cells, h, h * h, modulus, density, kn))[0][0]
    options = {**columns.box(cells, h), "block_law": "elastic", "block_young": young, "block_poisson": 0.25,
               "block_density": density, "gravity": (0, 0, -GRAVITY), "interfaces": "joints",
               "interface_joints_on": "all", "interface_joints_law": "elastic", "interface_joints_kn": kn,
               "interface_joints_ks": kn, **columns.sides("P", ("zmin",)), "boundary_zmin_fix": "xyz",
               **columns.to_rest(lowest)}
    joints = lab.run(options).last_frame("interfaces")
    above = cells * h - joints.centres()[:, 2]
    closure, mesh = -joints.cell_data["opening"], f"{cells} blocks of one hexahedron"
    lowest_joint = np.argmax(above)
    return [relative("joint closure under weight, lowest joint, m", "rho g H/k_n",
                     density * GRAVITY * above[lowest_joint] / kn, closure[lowest_joint], 1e-10, mesh),
            worst("joint closure under weight, worst of all joints, m", "rho g H/k_n", density * GRAVITY * above / kn,
                  closure, 1e-10, mesh)]
