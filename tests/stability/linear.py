"""Linear scenes without damping: the energy form is conserved at any step, and below the limit it bounds the motion.

Of a mode of frequency w, with sin(theta/2) = w dt/2, the form is A^2 w^2 cos^2(theta/2)/2, which is the largest kinetic
energy that the velocity of a whole step ever has. So kinetic <= form, always, if dt is below the limit; above it, the
energy grows like exp(2 n mu), cosh(mu/2) = dt/dt_c, while the form stays."""
import numpy as np

import dense
from suite import Row, call, case, meshes

ROCK = {"block_law": "elastic", "block_young": 1e9, "block_poisson": 0.25, "block_density": 2000.0}
BOX = {**ROCK, "mesh": "box", "mesh_box_cells": (2, 2, 2), "mesh_box_size": (2, 2, 2), "mesh_box_jitter": 0.1,
       "boundaries": "base", "boundary_base_on": "zmin", "boundary_base_fix": "xyz", "velocity": (0.1, -0.05, 0.2)}
SPRINGS = {"interfaces": "joints", "interface_joints_on": "all", "interface_joints_law": "brittle",
           "interface_joints_tension": 1e15, "interface_joints_cohesion": 1e15, "interface_joints_friction": 30.0}


def held(x):
    return x[:, 2] > 1e-9


def exact_step(lab, scene, **keywords):
    """From dense eigenvalues; and the program's own, sharp, over it."""
    results = lab.run({**scene, "ts_max_steps": 0})
    exact = dense.critical_step(results.last_frame(), keywords.pop("young", 1e9), scene["block_poisson"], 2000.0,
                                held, **keywords)
    return exact, results.summary["dt_critical"] / exact


def energies(lab, scene, steps):
    """The monitor's columns of a run: a row every 200th of it."""
    return lab.run({**scene, "ts_max_steps": steps, "monitor_energy": "ascii:energy.txt",
                    "monitor_energy_interval": max(1, steps // 1000)}, timeout=3000).monitor("energy.txt")


def critical(run, ratio):
    """Row: the program's critical step lies below the exact one, and near it."""
    return Row(run, "critical step: how far below the exact one; 1: above it", 1 - ratio if ratio <= 1 else 1.0, 0.02)


def kept(run, energy, bound=1e-12):
    """Rows: the form stays, and bounds the kinetic energy."""
    form, kinetic = energy["form"], energy["kinetic"]
    return [Row(run, "energy form: largest change over its value", np.max(np.abs(form / form[0] - 1)), bound),
            Row(run, "kinetic energy, largest after the start, over the energy form", np.max(kinetic[1:]) / form[0],
                1 + 1e-9)]


@case("At the limit: 0.999 and 1.001 of the exact critical step")
def limit(lab):
    """8 distorted blocks on intact springs; the exact step is that of the dense matrix of tests/stability/dense.py."""
    scene = {**BOX, **SPRINGS}
    exact, _ = exact_step(lab, scene, factor=20.0)
    steps = 1000000  # seconds
    body = "8 distorted blocks on intact springs, undamped"
    rows = kept(f"{body}, {steps:,} steps at 0.999",
                energies(lab, {**scene, "ts_dt": 0.999 * exact, "ts_central_check": "off"}, steps))
    ratio = 1.001  # with springs of the law elastic: brittle ones would break in the end, which lowers the frequency
    scene = {key: value for key, value in scene.items() if key.split("_")[-1] not in ("tension", "cohesion", "friction")}
    code, text, results = call(lab, {**scene, "interface_joints_law": "elastic", "ts_dt": ratio * exact,
                                     "ts_central_check": "off", "ts_max_steps": steps, "monitor_energy": "ascii:energy.txt",
                                     "monitor_energy_interval": 1})
    energy = results.monitor("energy.txt")
    stored = energy["strain"] + energy["spring"]  # with the kinetic energy of the balance it is constant at any step
    late = stored > 20 * energy["kinetic"][0]
    rate = np.polyfit(energy["step"][late], np.log(stored[late]), 1)[0] if late.sum() > 10 else np.nan
    run = f"the same at {ratio}"
    said = next((line for line in text.splitlines() if "error" in line), "no error")
    rows += [Row(run, "growth of the energy a step, against 4 acosh(dt/dt_c)",
                 abs(rate / (4 * np.arccosh(ratio)) - 1), 0.03),
             Row(run, "0: the run ends itself with an error; else 1", float(code == 0), 0,
                 f"observed last at step {int(energy['step'][-1]):,}: {said.split('error: ')[-1].split(' (time')[0]}")]
    return rows


@case("Slivers")
def slivers(lab):
    """Flat elements. The program's own step, 0.9 of its critical one."""
    steps, rows = 10000 if lab.quick else 200000, []
    flat = {**BOX, "mesh_box_cells": (3, 3, 3), "mesh_box_jitter": 0.0}
    thin = np.tan(np.radians(1))
    for name, more in (("27 hexahedra 1000 times as wide as high, joined", {"mesh_box_size": (3, 3, 3e-3)}),
                       ("27 hexahedra 1000 times as wide as high, on springs", {"mesh_box_size": (3, 3, 3e-3), **SPRINGS}),
                       ("162 tetrahedra of dihedral angles down to 1 degree",
                        {"mesh_box_size": (3, 3, 3 * thin), "mesh_box_shape": "tet"})):
        scene = {**flat, **more}
        _, ratio = exact_step(lab, scene, factor=20.0 if "interfaces" in more else None)
        rows += [critical(name, ratio)] + kept(f"{name}, {steps:,} steps at 0.9", energies(lab, scene, steps))
    return rows


@case("Stiffness contrast of a million")
def contrast(lab):
    """Stiff cubes on soft ones; in motion, and at rest under a pressure."""
    steps, path = 20000 if lab.quick else 500000, lab.path("contrast.msh")
    stiff, soft = 1e11, 1e5
    meshes.hexahedra(path, range(3), range(3), range(5), lambda c: "soft" if c[2] < 2 else "stiff")
    scene = {"mesh": path, "block_law": "elastic", "block_poisson": 0.25, "block_density": 2000.0,
             "block_stiff_young": stiff, "block_soft_young": soft, "boundaries": "base", "boundary_base_on": "zmin",
             "boundary_base_fix": "xyz", "velocity": (0.1, -0.05, 0.2)}
    rows = []
    for name, more in (("joined", {}), ("on springs", SPRINGS)):
        frame = lab.run({**scene, **more, "ts_max_steps": 0}).last_frame()
        young = np.where(frame.centres()[:, 2] < 2, soft, stiff)
        _, ratio = exact_step(lab, {**scene, **more}, young=young, factor=20.0 if more else None)
        run = f"16 cubes, E = {stiff:g} on {soft:g} Pa, {name}"
        rows += [critical(run, ratio)] + kept(f"{run}, {steps:,} steps at 0.9", energies(lab, {**scene, **more}, steps))
    pressure = 10.0
    column = {**scene, "velocity": (0, 0, 0), "block_poisson": 0.0, "boundaries": ("base", "top"), "boundary_top_on": "zmax",
              "boundary_top_pressure": pressure, "solve": "relax", "histories": "top", "history_top_at": (1, 1, 4),
              "history_top_of": "displacement_z"}
    top = lab.run(column).histories()["top"][-1]
    rows.append(Row("16 cubes, joined, relaxed under a pressure", "settlement of the top against p (h1/E1 + h2/E2)",
                    abs(top / (-pressure * (2 / stiff + 2 / soft)) - 1), 1e-5))
    return rows


@case("Stiffness factor of springs from 1 to 1000")
def factors(lab):
    """Springs from as stiff as the blocks to a thousand times as stiff."""
    steps, rows = 10000 if lab.quick else 200000, []
    for b in (1.0, 10.0, 100.0, 1000.0):
        scene = {**BOX, **SPRINGS, "interface_joints_stiffness_factor": b}
        _, ratio = exact_step(lab, scene, factor=b)
        run = f"8 distorted blocks on springs, b = {b:g}"
        rows += [critical(run, ratio)] + kept(f"{run}, {steps:,} steps at 0.9", energies(lab, scene, steps))
    return rows


@case("Poisson's ratio 0.499")
def incompressible(lab):
    """Blocks that hardly change their volume: the P-wave modulus is 500 times the shear modulus."""
    steps, rows = 20000 if lab.quick else 500000, []
    for name, more, keywords in (("full", {}, {}), ("bbar", {"block_element": "bbar"}, {"mean_dilatation": True}),
                                 ("full, on springs", SPRINGS, {"factor": 20.0})):
        scene = {**BOX, "block_poisson": 0.499, **more}
        _, ratio = exact_step(lab, scene, **keywords)
        run = f"8 distorted hexahedra, {name}"
        rows += [critical(run, ratio)] + kept(f"{run}, {steps:,} steps at 0.9", energies(lab, scene, steps))
    return rows


@case("Sudden loads")
def sudden(lab):
    """A load that is there from the first step on: form - F.u is conserved, and no mode goes beyond twice its static part;
    those of the stack come near it together."""
    cells, pressure, steps = 20, 1e6, 50000 if lab.quick else 500000
    scene = {**ROCK, "block_poisson": 0.0, "mesh": "box", "mesh_box_cells": (1, 1, cells),
             "mesh_box_size": (1, 1, cells), **SPRINGS, "boundaries": ("base", "top"), "boundary_base_on": "zmin",
             "boundary_base_fix": "xyz", "boundary_top_on": "zmax", "boundary_top_pressure": pressure, "histories": "top",
             "history_top_at": (0, 0, cells), "history_top_of": "displacement_z", "history_interval": 50,
             "monitor_energy": "ascii:energy.txt", "monitor_energy_interval": 50, "ts_max_steps": steps}
    results = lab.run(scene)
    top, form = results.histories()["top"], results.monitor("energy.txt")["form"]
    static = -pressure * (cells + (cells - 1) / 20) / 1e9
    work, run = -pressure * top, f"stack of {cells} blocks on intact springs, sudden pressure, {steps:,} steps at 0.9"
    return [Row(run, "form - F.u: largest change over the largest work", np.ptp((form - work)[1:]) / np.max(work), 1e-12),
            Row(run, "settlement of the top, largest, over twice the static one", np.max(top / (2 * static)), 1 + 1e-9),
            Row(run, "the same, how far below 1", 1 - np.max(top / (2 * static)), 0.05)]
