"""What an undamped run keeps: momentum without boundaries, and the energy form of the scheme with them."""
import numpy as np

import meshes
from problem import Row, problem


@problem("Momentum without boundaries")
def momentum(lab):
    """Two distorted bodies of different velocity tear a brittle mesh apart; nothing outside acts."""
    mesh, steps = lab.path("bodies.msh"), 2000
    meshes.hexahedra(mesh, range(5), range(4), range(4), lambda centre: "left" if centre[0] < 2 else "right",
                     lambda name, centre: None, lambda points: meshes.jitter(points, 0.15, 1))
    results = lab.run({
        "mesh": mesh, "block_law": "elastic", "block_young": 1e9, "block_poisson": 0.25, "block_density": 2000.0,
        "interfaces": "joints", "interface_joints_on": "all", "interface_joints_law": "brittle",
        "interface_joints_tension": 2e4, "interface_joints_cohesion": 5e4, "interface_joints_friction": 30.0,
        "velocity_left": (0.1, 0.02, -0.03), "velocity_right": (-0.05, 0.04, 0.2), "ts_max_steps": steps,
        "monitor_energy": "ascii:energy.txt", "monitor_energy_interval": 10})
    energy = results.monitor("energy.txt")
    path = np.array([energy[f"momentum_{axis}"] for axis in "xyz"])
    scale = np.linalg.norm(path[:, 0])
    drift = np.max(np.abs(path - path[:, :1]), axis=1)
    at, where = int(np.argmax(drift)), "36 distorted hexahedra, all faces brittle"
    last = path[at, np.argmax(np.abs(path[at] - path[at, 0]))]
    broken = results.summary["broken_springs"]
    return [Row(f"momentum {'xyz'[at]} over {steps} steps ({broken} springs broken), kg m/s", "that of step 0",
                path[at, 0], last, drift[at] / scale, 1e-12, where)]


def supported_body(lab, steps):
    results = lab.run({
        "mesh": "box", "mesh_box_cells": (2, 2, 2), "mesh_box_size": (2, 2, 2), "mesh_box_jitter": 0.1,
        "block_law": "elastic", "block_young": 1e9, "block_poisson": 0.25, "block_density": 2000.0,
        "interfaces": "joints", "interface_joints_on": "all", "interface_joints_law": "elastic",
        "boundaries": "zmin", "boundary_zmin_fix": "xyz", "velocity": (0.1, -0.05, 0.2), "ts_max_steps": steps,
        "monitor_energy": "ascii:energy.txt", "monitor_energy_interval": steps // 200})
    form = results.monitor("energy.txt")["form"]
    at = int(np.argmax(np.abs(form - form[0])))
    ratio = results.summary["dt"] / results.summary["dt_critical"]
    return [Row(f"energy form over {steps} steps at {ratio:.2g} of the critical step, J",
                "v(n-1/2).M v(n+1/2)/2 + u.K u/2 of step 0", form[0], form[at], abs(form[at] / form[0] - 1), 1e-12,
                "8 distorted hexahedra, all faces elastic springs, base held")]


@problem("Energy form over 100,000 steps")
def energy_form(lab):
    return supported_body(lab, 100000)


@problem("Energy form over 1,000,000 steps", long=True)
def energy_form_long(lab):
    return supported_body(lab, 1000000)
