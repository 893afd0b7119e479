"""A block on an incline of 21 angles, friction 20 degrees, from sudden gravity.

One hexahedron on a held one, the joint tilted by A. The beta damping (critical for the bounce on the springs, alpha = 0)
takes the transients away; then the four springs carry m g cos A together and slide, and the rate of the momentum along
the slope is exact: what is left after t = 100/w decays like exp(-w t/2). Below the friction angle the block comes to rest,
and its rocking on the sticking springs, which is slower, needs t = 500/w."""
import numpy as np

import meshes
from problem import problem, relative, worst

GRAVITY, FRICTION, DENSITY, NORMAL = 9.81, 20.0, 2000.0, 1e9


def acceleration(lab, angle):
    """Rate of the momentum along the slope over the last quarter of the run, by the block's mass."""
    mesh = lab.path(f"incline{angle}.msh")
    meshes.hexahedra(mesh, (0, 1), (0, 1), (-1, 0, 1), lambda centre: "ground" if centre[2] < 0 else "block",
                     lambda name, centre: "held" if centre[2] < 0 else None, meshes.rotation(angle))
    bounce = np.sqrt(NORMAL / DENSITY)
    end = (100 if angle > FRICTION else 500) / bounce
    results = lab.run({
        "mesh": mesh, "block_law": "elastic", "block_young": 1e9, "block_poisson": 0.25, "block_density": DENSITY,
        "interfaces": "joint", "interface_joint_on": "between:ground:block", "interface_joint_law": "brittle",
        "interface_joint_kn": NORMAL, "interface_joint_ks": NORMAL / 2, "interface_joint_tension": 0.0,
        "interface_joint_cohesion": 0.0, "interface_joint_friction": FRICTION,
        "boundaries": "held", "boundary_held_fix": "xyz", "gravity": (0, 0, -GRAVITY), "damping_beta": 2 / bounce,
        "ts_max_time": end, "monitor_energy": "ascii:energy.txt", "monitor_energy_interval": 100})
    energy = results.monitor("energy.txt")
    a = np.radians(angle)
    momentum = energy["momentum_x"] * np.cos(a) - energy["momentum_z"] * np.sin(a)
    late = np.argmax(energy["time"] > 0.75 * end)
    return (momentum[-1] - momentum[late]) / (energy["time"][-1] - energy["time"][late]) / DENSITY


@problem("Block on an incline, 21 angles")
def incline(lab):
    angles = np.arange(10.0, 51.0, 2.0) + 1.0
    a = np.radians(angles)
    exact = np.where(angles > FRICTION, GRAVITY * (np.sin(a) - np.cos(a) * np.tan(np.radians(FRICTION))), 0.0)
    found = np.array([acceleration(lab, angle) for angle in angles])
    slides = exact > 0
    thirty = np.radians(30)
    formula, mesh = "g (sin A - cos A tan(phi))", "two hexahedra, phi = 20 degrees"
    return [
        relative("incline of 30 degrees, m/s^2", formula,
                 GRAVITY * (np.sin(thirty) - np.cos(thirty) * np.tan(np.radians(FRICTION))), acceleration(lab, 30.0),
                 1e-10, mesh),
        worst("incline, worst of 16 angles that slide (21 to 51 degrees), m/s^2", formula, exact[slides], found[slides],
              1e-10, mesh, np.min(exact[slides])),
        worst("incline, worst of 5 angles at rest (11 to 19 degrees), m/s^2", "0; error: relative to g", 0.0,
              found[~slides], 1e-10, mesh, GRAVITY),
    ]
