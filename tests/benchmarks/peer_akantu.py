"""Runs a problem of outside.py in Akantu: peer_akantu.py FOLDER STEPS, in a Python that has akantu and numpy.

FOLDER/problem.npz holds the problem; FOLDER/displacement.npy gets the displacement at the end. The last line printed is
JSON: seconds and CPU seconds of the loop of steps."""
import json
import sys
import time
from pathlib import Path

import akantu as aka
import numpy as np


def model_of(problem, folder):
    (folder / "material.dat").write_text(f"material elastic [\n name = rock\n rho = {problem['density']}\n E = {problem['young']}\n"
                                         f" nu = {problem['poisson']}\n]\n")
    aka.parseInput(str(folder / "material.dat"))
    mesh = aka.Mesh(3)
    access = aka.MeshAccessor(mesh)
    access.resizeNodes(len(problem["points"]))
    mesh.getNodes()[:] = problem["points"]
    mesh.addConnectivityType(aka._hexahedron_8)
    access.resizeConnectivity(len(problem["cells"]), aka._hexahedron_8)
    mesh.getConnectivity(aka._hexahedron_8)[:] = problem["cells"]
    access.makeReady()
    model = aka.SolidMechanicsModel(mesh)
    model.initFull(aka._explicit_lumped_mass)
    return mesh, model  # the model does not keep the mesh alive


def main():
    folder, steps = Path(sys.argv[1]), int(sys.argv[2])
    problem = dict(np.load(folder / "problem.npz"))
    mesh, model = model_of(problem, folder)
    dt, free = float(problem["dt"]), problem["free"]
    model.setTimeStep(dt)
    model.assembleMassLumped()
    mass, force = model.getMass(), model.getExternalForce()
    force[:] = problem["force"] if "force" in problem else mass * np.array([0.0, 0.0, -float(problem["gravity"])])
    model.getBlockedDOFs()[:] = ~free
    model.getAcceleration()[:] = np.where(free, force / mass, 0.0)  # it would start from zero
    u, v = model.getDisplacement(), model.getVelocity()
    drive, driven = problem.get("drive"), np.unravel_index(problem.get("driven", np.zeros(0, int)), free.shape)
    keep = 1 - float(problem.get("alpha", 0.0)) * dt  # damping by mass, as its own examples do it
    start, cpu = time.perf_counter(), time.process_time()
    for step in range(steps):
        if drive is not None:
            u[driven] = drive[step + 1]
        model.solveStep()
        if keep < 1:
            v *= keep
    solve, cpu = time.perf_counter() - start, time.process_time() - cpu
    np.save(folder / "displacement.npy", u)
    print(json.dumps({"solve": solve, "solve_cpu": cpu}))


main()
