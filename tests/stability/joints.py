"""Scenes whose joints open, slide and break: energy and closed forms."""
import numpy as np

from suite import Row, call, case, meshes

ROCK = {"block_law": "elastic", "block_young": 1e9, "block_poisson": 0.25, "block_density": 2000.0}
LOOSE = {"interface_joint_law": "brittle", "interface_joint_tension": 0.0, "interface_joint_cohesion": 0.0,
         "interface_joint_friction": 30.0}
GRAVITY = 9.81


def pile(lab, move=lambda p: p):
    """One cube under another, all nodes of the upper one held; down is up here, so that histories at the joint, which take
    the lowest-numbered cell, are those of the free block."""
    path = lab.path("pile.msh")
    meshes.hexahedra(path, (0, 1), (0, 1), (-1, 0, 1), lambda c: "block" if c[2] < 0 else "ground",
                     lambda name, c: "held" if c[2] > 0 else None, move)
    return {**ROCK, **LOOSE, "mesh": path, "interfaces": "joint", "interface_joint_on": "between:block:ground",
            "boundaries": "held", "boundary_held_fix": "xyz"}


@case("A joint that opens and shuts")
def bounces(lab):
    """A block hops under gravity, undamped: nothing takes its energy away, and nothing may bring any."""
    hops = 2000 if lab.quick else 100000
    scene = {**pile(lab), "block_poisson": 0.0, "interface_joint_kn": 2e7, "interface_joint_ks": 1e7,
             "gravity": (0, 0, GRAVITY), "velocity_block": (0, 0, -0.05), "ts_central_safety": 0.5,
             "ts_max_steps": 100 * hops, "histories": ("foot", "head"), "history_foot_at": (0, 0, 0),
             "history_head_at": (0, 0, -1), "history_foot_of": "displacement_z", "history_head_of": "displacement_z",
             "history_interval": 10, "monitor_energy": "ascii:energy.txt", "monitor_energy_interval": 10}
    results = lab.run(scene, timeout=3000)
    rows, energy = results.histories(), results.monitor("energy.txt")
    height = -(rows["foot"] + rows["head"]) / 2
    total = energy["kinetic"] + energy["strain"] + energy["spring"] + ROCK["block_density"] * GRAVITY * height
    found = int(np.sum((rows["foot"][1:] < 0) & (rows["foot"][:-1] >= 0)))
    tenth = len(total) // 10
    run = f"a block hops {found:,} times under gravity, {100 * hops:,} steps at 0.5, undamped"
    return [Row(run, f"hops short of {hops:,}", max(0, hops - found), 0),
            Row(run, "total energy: largest change over its value (it swings by a share of (w dt)^2)",
                np.max(np.abs(total / total[0] - 1)), 0.02),
            Row(run, "mean total energy of the last tenth against the first",
                abs(total[-tenth:].mean() / total[:tenth].mean() - 1), 2e-3)]


@case("At the angle of friction")
def friction_angle(lab):
    """A flat block on a slope of exactly its angle of friction: every spring ends at its cap, and no force is left."""
    bounce, rows = np.sqrt(1e9 / ROCK["block_density"]), []
    for angle in (29.999, 30.0, 30.001):
        a, end = np.radians(angle), (500 if lab.quick else 5000) / bounce
        scene = {**pile(lab, lambda p: p * (3, 3, 1)), "interface_joint_kn": 1e9, "interface_joint_ks": 5e8,
                 "gravity": (GRAVITY * np.sin(a), 0, GRAVITY * np.cos(a)), "damping_beta": 2 / bounce, "ts_max_time": end,
                 "monitor_energy": "ascii:energy.txt", "monitor_energy_interval": 100}
        energy = lab.run(scene, timeout=3000).monitor("energy.txt")
        late = np.argmax(energy["time"] > 0.75 * end)
        velocity = energy["momentum_x"] / (9 * ROCK["block_density"])
        found = (velocity[-1] - velocity[late]) / (energy["time"][-1] - energy["time"][late])
        slides = velocity[-1] > 1e-9
        exact = GRAVITY * (np.sin(a) - np.cos(a) * np.tan(np.radians(30))) if slides else 0.0
        run = f"flat block on a slope of {angle:g} degrees, phi = 30, sudden gravity, {int(energy['step'][-1]):,} steps"
        rows.append(Row(run, "acceleration against that of its sliding, over g", abs(found - exact) / GRAVITY, 1e-10,
                        f"exact {exact:.3g} m/s^2; velocity at the end {velocity[-1]:.2g} m/s"))
    return rows


@case("All faces break at once")
def burst(lab):
    """Stress from the start, tension beyond the strength of the springs: all of them break in the first step."""
    tension, steps = 1e6, 20000 if lab.quick else 200000
    scene = {**ROCK, "mesh": "box", "mesh_box_cells": (3, 3, 3), "mesh_box_size": (3, 3, 3), "mesh_box_jitter": 0.2,
             "block_stress": (tension, tension, tension, 0, 0, 0), **LOOSE, "interfaces": "joint",
             "interface_joint_on": "all", "interface_joint_tension": 0.5 * tension, "interface_joint_cohesion": tension,
             "ts_central_safety": 0.2, "ts_max_steps": steps, "monitor_energy": "ascii:energy.txt",
             "monitor_energy_interval": steps // 2000}
    first = lab.run({**scene, "ts_max_steps": 1}).summary
    energy = lab.run(scene, timeout=3000).monitor("energy.txt")
    total = energy["kinetic"] + energy["strain"] + energy["spring"]
    stored = 27 * tension**2 / (2 * 1e9 / (3 * (1 - 2 * 0.25)))
    momentum = np.abs([energy[f"momentum_{axis}"] for axis in "xyz"]).max()
    run = "27 distorted blocks, every face a spring, isotropic tension of twice their strength"
    return [Row(run, "springs not broken by the first step", first["springs"] - first["broken_springs"], 0,
                f"of {first['springs']}"),
            Row(run, "strain energy at the start against V s^2/(2 K)", abs(energy["strain"][0] / stored - 1), 1e-10),
            Row(f"{run}, {steps:,} steps at 0.2",
                "kinetic + strain + spring energy, largest, over the strain energy at the start", np.max(total[1:]) / stored,
                1.05, f"{total[-1] / stored:.3f} at the end"),
            Row(run, "momentum, largest, over that of all the energy moving one way",
                momentum / np.sqrt(2 * 27 * ROCK["block_density"] * stored), 1e-12)]


@case("An excavation that leaves a block hanging")
def hanging(lab):
    """Three cubes, one on another: the upper one is held, the lower one is dug out, the one between hangs from a joint."""
    path, weight, kn = lab.path("hanging.msh"), ROCK["block_density"] * GRAVITY, 2e9
    meshes.hexahedra(path, (0, 1), (0, 1), range(4), lambda c: ("support", "block", "roof")[int(c[2])],
                     lambda name, c: "held" if c[2] > 2 else "base" if name == "zmin" else None)
    scene = {**ROCK, "block_poisson": 0.0, "mesh": path, **LOOSE, "interfaces": "joint",
             "interface_joint_on": "between:block:roof", "interface_joint_cohesion": 1e6, "interface_joint_kn": kn,
             "interface_joint_ks": kn, "boundaries": ("held", "base"), "boundary_held_fix": "xyz",
             "boundary_base_fix": "xyz", "gravity": (0, 0, -GRAVITY), "solve": "relax", "relax_max_steps": 20000,
             "stages": ("insitu", "dig"), "stage_insitu_intact": None, "stage_dig_remove": "support"}
    results = lab.run({**scene, "interface_joint_tension": 2.5 * weight})
    joint = results.last_frame("interfaces").cell_data
    holds, falls = "a joint of 2.5 times the weight, relaxed", "a joint of 0.9 times the weight"
    rows = [Row(holds, "stress of the joint against rho g h", abs(joint["normal_stress"].ravel()[0] / weight - 1), 1e-5),
            Row(holds, "opening of the joint against rho g h/k_n", abs(joint["opening"].ravel()[0] / (weight / kn) - 1),
                1e-5)]
    code, text, _ = call(lab, {**scene, "interface_joint_tension": 0.9 * weight})
    rows.append(Row(f"{falls}, relaxed", "0: the run ends with an error that names stage and place; else 1",
                    float(code == 0 or "stage 'dig' is not in balance" not in text or "N at (" not in text), 0))
    results = lab.run({**scene, "interface_joint_tension": 0.9 * weight, "stage_dig_solve": "dynamic",
                       "stage_dig_ts_max_time": 0.5, "monitor_energy": "ascii:energy.txt"})
    energy = results.monitor("energy.txt")
    late = (energy["step"] > results.summary["stages"][0]["steps"]) & (energy["time"] > 0.05)
    rate = np.polyfit(energy["time"][late], energy["momentum_z"][late], 1)[0] / ROCK["block_density"]
    rows.append(Row(f"{falls}, in motion for 0.5 s", "its fall against g", abs(rate / -GRAVITY - 1), 1e-10))
    return rows
