"""Direct shear of a joint that dilates: between plates that do not part, and under a constant load."""
import numpy as np

import meshes
from problem import problem, relative, worst
from problems.joints import COHESION, FRICTION, NORMAL, SHEAR, face, pair

DILATION, TAN = 11.0, "tan(phi)"
TAN_PHI, TAN_PSI = np.tan(np.radians(FRICTION)), np.tan(np.radians(DILATION))


@problem("Direct shear of a dilating joint between fixed plates")
def dilation_fixed_plates(lab):
    pressure, limit, mesh = 1e6, 1e-3, "two hexahedra, every node driven"
    drive, options = pair(lab, [(0, 0.0), (3, 4e-3)])
    options.update({
        "interface_joint_dilation": DILATION, "interface_joint_dilation_slip": limit,
        "boundaries": ("below", "push", "press"),
        "boundary_push_on": "above", "boundary_push_displacement": (0.6, 0.8, 0.0), "boundary_push_components": "xy",
        "boundary_push_table": "path",
        "boundary_press_on": "above", "boundary_press_displacement": (0.0, 0.0, -pressure / NORMAL),
        "boundary_press_components": "z"})
    results = lab.run(options)
    shear, normal = face(results, "shear_stress"), -face(results, "normal_stress")
    # Where it slides, shear and pressure are those of the path length p: known without the law's own solution.
    stiff = NORMAL * TAN_PHI * TAN_PSI
    strength = pressure * TAN_PHI + COHESION
    breaks = np.argmax(SHEAR * drive > strength)
    path = np.where(np.arange(len(drive)) < breaks, 0.0, (SHEAR * drive - pressure * TAN_PHI) / (SHEAR + stiff))
    path[breaks] = (SHEAR * drive[breaks] - strength) / (SHEAR + stiff)  # the step that breaks it carries the cohesion
    path = np.where(path > limit, drive - (pressure * TAN_PHI + stiff * limit) / SHEAR, path)
    pressed = pressure + NORMAL * TAN_PSI * np.minimum(path, limit)
    exact = np.where(path > 0, pressed * TAN_PHI, SHEAR * drive)
    exact[breaks] += COHESION
    at = breaks + np.array([5, 40])
    return [
        relative("dilation, fixed plates: peak, Pa", f"c + sigma_n {TAN} of the step that breaks it", exact[breaks],
                 shear[breaks], 1e-10, mesh),
        relative("dilation, fixed plates: shear stress at the end, Pa", f"(sigma_n + k_n tan(psi) dilation_slip) {TAN}",
                 (pressure + NORMAL * TAN_PSI * limit) * TAN_PHI, shear[-1], 1e-10, mesh),
        relative("dilation, fixed plates: rise of the pressure with the slip, Pa/m", "k_n tan(psi)", NORMAL * TAN_PSI,
                 np.diff(normal[at])[0] / np.diff(drive[at] - shear[at] / SHEAR)[0], 1e-10, mesh),
        worst("dilation, fixed plates: shear stress at the worst of 300 steps, Pa", "path of the law", exact[1:], shear[1:],
              1e-10, mesh),
        worst("dilation, fixed plates: pressure at the worst of 300 steps, Pa", "path of the law", pressed[1:], normal[1:],
              1e-10, mesh)]


@problem("Direct shear of a dilating joint under a constant load")
def dilation_constant_load(lab):
    """The upper block is shifted at a constant speed and free to rise. Alpha damping takes the bounce of the breaking
    away; in the steady rise it presses by alpha m v_z, which the formulas hold."""
    pressure, limit, kn, ks, density, alpha = 1e6, 1.2e-3, 2e10, 1e10, 2000.0, 2000.0
    settle, end, shift, dt = 0.03, 0.15, 2e-3, 5e-5
    mesh, table = lab.path("free.msh"), lab.path("free.txt")
    meshes.hexahedra(mesh, (0, 1), (0, 1), (0, 1, 2), lambda centre: "lower" if centre[2] < 1 else "upper",
                     lambda name, centre: name if name[0] == "z" else "below" if centre[2] < 1 else "above")
    table.write_text(f"0 0\n{float(settle)!r} 0\n{float(end)!r} {float(shift)!r}\n")
    results = lab.run({
        "mesh": mesh, "block_law": "elastic", "block_young": 1e10, "block_poisson": 0.25, "block_density": density,
        "interfaces": "joint", "interface_joint_on": "between:lower:upper", "interface_joint_law": "brittle",
        "interface_joint_kn": kn, "interface_joint_ks": ks, "interface_joint_tension": 0.0,
        "interface_joint_cohesion": COHESION, "interface_joint_friction": FRICTION,
        "interface_joint_dilation": DILATION, "interface_joint_dilation_slip": limit,
        "boundaries": ("below", "above", "zmax"), "boundary_below_fix": "xyz",
        "boundary_above_displacement": (0.6, 0.8, 0.0), "boundary_above_components": "xy", "boundary_above_table": "path",
        "boundary_zmax_pressure": pressure, "tables": "path", "table_path_type": "file", "table_path_file": table,
        "damping_alpha": alpha, "ts_dt": dt, "ts_max_time": end, "output_interval": 10})
    time = np.array([t for t, _ in results.frames("interfaces")])
    shear, opening, slip = (face(results, name) for name in ("shear_stress", "opening", "slip"))
    speed = shift / (end - settle)
    carried = pressure + alpha * density * speed * TAN_PSI
    one, two = np.argmax(time > 0.075), np.argmax(time > 0.095)
    what = "two hexahedra, the upper one shifted and free to rise"
    return [
        relative("dilation, constant load: slope of the opening over the slip", "tan(psi)", TAN_PSI,
                 (opening[two] - opening[one]) / (slip[two] - slip[one]), 1e-10, what),
        relative("dilation, constant load: shear stress while it rises, Pa", f"(sigma_n + alpha rho h v_z) {TAN}",
                 carried * TAN_PHI, shear[two], 1e-10, what),
        relative("dilation, constant load: residual, Pa", f"sigma_n {TAN}", pressure * TAN_PHI, shear[-1], 1e-10, what),
        relative("dilation, constant load: opening in the end, m", "tan(psi) dilation_slip - sigma_n/k_n",
                 TAN_PSI * limit - pressure / kn, opening[-1], 1e-10, what)]
