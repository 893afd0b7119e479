"""A plane wave through one linear joint: transmission and reflection by spectral ratio, X = w z/(2 k) = 0.5, 1, 2.

One run holds all three: the joint has X = 1 at the pulse's frequency f, and the ratio is taken at f/2, f and 2 f. The
same column without the joint gives the incident pulse. In the discrete column the joint's X is exactly
(M/h) sin(k h)/(2 k_n) with the discrete wave number k."""
import numpy as np

import columns
import meshes
from problem import problem, relative

WAVELENGTH, CELLS, HEIGHT, JOINT, BELOW, ABOVE = 10.0, 80, 80.0, 40.0, 30.0, 50.0


def through_joint(lab, kind):
    h, speed = WAVELENGTH / CELLS, columns.SPEED[kind]
    frequency, dt = speed / WAVELENGTH, 0.5 * h / columns.SPEED["P"]
    stiffness = np.pi * frequency * columns.DENSITY * speed
    mesh = lab.path("column.msh")
    cells = round(HEIGHT / h)
    meshes.hexahedra(mesh, (0, h), (0, h), h * np.arange(cells + 1),
                     lambda centre: "lower" if centre[2] < JOINT else "upper")
    plain = {"mesh": mesh, **columns.rock(), **columns.sides(kind, ("zmin",)), **columns.ricker_base(kind, frequency),
             **columns.histories(kind, (BELOW, ABOVE)), "ts_dt": dt, "ts_max_steps": round(10.8 / frequency / dt)}
    normal, shear = (stiffness, 1e11) if kind == "P" else (1e11, stiffness)
    jointed = {**plain, "interfaces": "joint", "interface_joint_on": "between:lower:upper",
               "interface_joint_law": "elastic", "interface_joint_kn": normal, "interface_joint_ks": shear}
    incident, met = lab.run(plain).histories(), lab.run(jointed).histories()
    time, rows = incident["time"], []
    where = f"1x1x{cells} hexahedra, 80 a wavelength of X = 1"
    law = {"P": "k_n", "S": "k_s"}[kind]
    for x in (0.5, 1.0, 2.0):
        f = x * frequency
        below, above, passed, back = (columns.spectrum(history, time, f) for history in
                                      (incident["h0"], incident["h1"], met["h1"], met["h0"] - incident["h0"]))
        k = columns.discrete_wavenumber(speed, h, dt, f)
        discrete = columns.MODULUS[kind] / h * np.sin(k * h) / (2 * stiffness)
        through, reflected = abs(passed / above), abs(back / below)
        name = f"{kind} wave, joint {law}, X = {x:g}"
        rows += [relative(f"{name}: transmission", "1/sqrt(1 + X^2)", 1 / np.hypot(1, x), through, 1e-2, where),
                 relative(f"{name}: reflection", "X/sqrt(1 + X^2)", x / np.hypot(1, x), reflected, 1e-2, where),
                 relative(f"{name}: transmission, discrete", "X_h = (M/h) sin(k h)/(2 " + law + ")",
                          1 / np.hypot(1, discrete), through, 1e-6, where)]
    return rows


@problem("P wave through a joint")
def p_joint(lab):
    return through_joint(lab, "P")


@problem("S wave through a joint")
def s_joint(lab):
    return through_joint(lab, "S")
