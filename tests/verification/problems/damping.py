"""Rayleigh damping. One hexahedron on a held base that moves along z only is an oscillator of mass rho h^3/2 and stiffness
M h. Its history obeys u(n+1) = p u(n) - q u(n-1) exactly; the roots of that, found by least squares, give decay and damped
frequency, whose error falls like dt^2 (alpha, centred) and dt (beta, lagged by half a step)."""
import numpy as np

import columns
from problem import Row, order, problem, worst

CASES = {"alpha": (0.2, 0.0), "beta": (0.0, 0.2), "alpha and beta": (0.1, 0.2)}  # alpha/w, beta w
MODULUS = columns.MODULUS["P"]
OMEGA = np.sqrt(2 * MODULUS / columns.DENSITY)  # h = 1 m


def recurrence(alpha, beta, omega, dt):
    """p and q of the scheme for one mode."""
    kept = (1 - alpha * dt / 2 - beta * omega**2 * dt) / (1 + alpha * dt / 2)
    return np.array([1 + kept - dt**2 * omega**2 / (1 + alpha * dt / 2), kept])


def oscillation(lab, alpha, beta, parts):
    """p and q of the computed history at parts steps a period."""
    dt = 2 * np.pi / OMEGA / parts
    options = {**columns.box(1, 1.0), **columns.rock(), **columns.sides("P", ("zmin",)), "boundary_zmin_fix": "xyz",
               "velocity": (0, 0, 1.0), **columns.histories("P", (1.0,)), "damping_alpha": alpha, "damping_beta": beta,
               "ts_dt": dt, "ts_max_steps": 3 * parts}
    u = lab.run(options).histories()["h0"]
    p, q = np.linalg.lstsq(np.array([u[1:-1], -u[:-2]]).T, u[2:], rcond=None)[0]
    return dt, np.array([p, q])


def rayleigh(lab, name, expected):
    alpha, beta = CASES[name][0] * OMEGA, CASES[name][1] / OMEGA
    decay = (alpha + beta * OMEGA**2) / 2
    frequency = np.sqrt(OMEGA**2 - decay**2)
    steps, decays, turns, worst_root = [], [], [], 0.0
    for parts in (80, 160, 320):
        dt, found = oscillation(lab, alpha, beta, parts)
        root = np.log(np.roots([1, -found[0], found[1]])[0].astype(complex)) / dt
        steps.append(dt)
        decays.append(-root.real)
        turns.append(abs(root.imag))
        exact = recurrence(alpha, beta, OMEGA, dt)
        worst_root = max(worst_root, np.max(np.abs(found - exact)))
    decays, turns = np.array(decays), np.array(turns)
    mesh, parts = "one hexahedron", "80, 160, 320 steps a period"
    return [
        Row(f"{name}: decay, 1/s", "(alpha + beta w^2)/2", decay, decays[-1], abs(decays[-1] / decay - 1), 1e-2, mesh),
        Row(f"{name}: damped frequency, rad/s", "sqrt(w^2 - decay^2)", frequency, turns[-1],
            abs(turns[-1] / frequency - 1), 1e-2, mesh),
        order(f"{name}: order in dt of the decay", steps, decays - decay, expected, 0.1, parts),
        order(f"{name}: order in dt of the damped frequency", steps, turns - frequency, expected, 0.1, parts),
        Row(f"{name}: recurrence of the scheme, worst coefficient", "u(n+1) = p u(n) - q u(n-1)", exact[0], found[0],
            worst_root, 1e-9, mesh),
    ]


@problem("Rayleigh damping, alpha")
def alpha_damping(lab):
    return rayleigh(lab, "alpha", 2)


@problem("Rayleigh damping, beta")
def beta_damping(lab):
    return rayleigh(lab, "beta", 1)


@problem("Rayleigh damping, alpha and beta")
def both_dampings(lab):
    return rayleigh(lab, "alpha and beta", 1)


@problem("Rayleigh damping with springs")
def spring_damping(lab):
    """Two blocks on a joint: every mode of the exact matrices obeys the scheme's recurrence."""
    kn, steps = 2e10, 400
    mass, stiffness = columns.stack_matrices(2, 1.0, 1.0, MODULUS, columns.DENSITY, kn)
    omega, modes = columns.frequencies(mass, stiffness)
    alpha, beta, dt = 0.1 * omega[0], 0.1 / omega[0], 0.2 / omega[-1]
    options = {**columns.box(2, 1.0), **columns.rock(), **columns.sides("P", ("zmin",)), "boundary_zmin_fix": "xyz",
               "interfaces": "joint", "interface_joint_on": "all", "interface_joint_law": "elastic",
               "interface_joint_kn": kn, "interface_joint_ks": kn, "velocity": (0, 0, 1.0),
               "damping_alpha": alpha, "damping_beta": beta, "ts_dt": dt, "ts_max_steps": steps, "output_interval": 1}
    path = []
    for _, frame in lab.run(options).frames():
        lower, upper = sorted((0, 1), key=lambda cell: frame.centres()[cell][2])
        def level(cell, top):
            nodes = frame.nodes(cell)
            z = frame.points[nodes, 2]
            return frame.point_data["displacement"][nodes[(z > z.mean()) == top], 2].mean()
        path.append([level(lower, True), level(upper, False), level(upper, True)])
    rows = []
    for i, modal in enumerate((np.array(path) @ (mass[:, None] * modes)).T):
        p, q = recurrence(alpha, beta, omega[i], dt)
        scale = np.max(np.abs(modal))
        rows.append(worst(f"two blocks on a joint, alpha and beta: mode {i + 1}, worst of {steps} steps",
                          "u(n+1) = p u(n) - q u(n-1); error: relative to the amplitude",
                          (p * modal[1:-1] - q * modal[:-2]) / scale, modal[2:] / scale, 1e-10, "two hexahedra", 1.0))
    return rows
