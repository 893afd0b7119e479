"""Strength of blocks: a specimen of eight hexahedra between smooth platens, driven slowly by velocities."""
import numpy as np

from problem import problem, relative, worst

YOUNG, POISSON, DENSITY, COHESION, FRICTION, TENSION = 10e9, 0.25, 2500.0, 3e6, 40.0, 1e6
SIN, COS = np.sin(np.radians(FRICTION)), np.cos(np.radians(FRICTION))
N_PHI = (1 + SIN) / (1 - SIN)
SIGMA_C = 2 * COHESION * COS / (1 - SIN)
MESH = "2x2x2 hexahedra"
BAR = 1e-3


def specimen(law, strain, frames, confining=0.0, **numbers):
    """A cube of 2 m on three smooth planes; its top moves to this strain while its sides carry a pressure."""
    size, time = 2.0, 10.0  # m, s: so slow that inertia and damping carry 1e-4 of the strength
    alpha = 0.2 * np.pi / 2 * np.sqrt(YOUNG / DENSITY) / size  # a fifth of the lowest frequency
    settle = 40 / alpha
    top = {"boundary_zmax_velocity": (0.0, 0.0, strain * size / time), "boundary_zmax_components": "z",
           "boundary_zmax_table": "path"}
    options = {
        "mesh": "box", "mesh_box_cells": (2, 2, 2), "mesh_box_size": (size, size, size), "block_law": law,
        "block_young": YOUNG, "block_poisson": POISSON, "block_density": DENSITY, "block_cohesion": COHESION,
        "block_friction": FRICTION, **{f"block_{key}": value for key, value in numbers.items()},
        "boundaries": ["xmin", "ymin", "zmin", "zmax"], "boundary_xmin_fix": "x", "boundary_ymin_fix": "y",
        "boundary_zmin_fix": "z", **top, "tables": ["path"], "table_path_type": "ramp", "table_path_delay": settle,
        "damping_alpha": alpha, "ts_max_time": settle + time, "output_interval_time": (settle + time) / frames,
        "output_fields": ("stress", "broken") if law == "breakage" else ("displacement", "stress", "plastic_strain")}
    if confining:
        options["boundaries"] += ["xmax", "ymax"]
        for side in ("xmax", "ymax"):
            options.update({f"boundary_{side}_pressure": confining, f"boundary_{side}_table": "path"})
    return options


def axial(results):
    """History of the mean axial stress, over the frames."""
    return np.array([frame.cell_data["stress"][:, 2].mean() for _, frame in results.frames()])


def peak(lab, sign, law, strength, **numbers):
    """Largest axial stress in compression (sign -1) or tension of a specimen driven beyond its strength's strain.

    What breaks drops at once: there the frames must be close."""
    reach, frames = (1.4, 2000) if law == "breakage" else (2, 100)
    results = lab.run(specimen(law, sign * reach * abs(strength) / YOUNG, frames, **numbers))
    return sign * np.max(sign * axial(results)), results


@problem("Uniaxial and triaxial strength, Mohr-Coulomb")
def mohr_coulomb_strength(lab):
    rows = []
    for confining in (0.0, 2e6, 5e6):
        strength = SIGMA_C + N_PHI * confining
        found, _ = peak(lab, -1, "mohr_coulomb", strength, confining=confining, dilation=10.0)
        formula = "-2 c cos(phi)/(1 - sin(phi))" + (" - N s3" if confining else "")
        rows.append(relative(f"Mohr-Coulomb, strength at s3 = {confining / 1e6:g} MPa, Pa", formula, -strength, found, BAR,
                             MESH))
    return rows


@problem("Uniaxial and triaxial strength, Drucker-Prager")
def drucker_prager_strength(lab):
    rows, root3 = [], np.sqrt(3)
    below = {"outer": root3 * (3 - SIN) / 2, "middle": root3 * (3 + SIN) / 2, "inscribed": root3 * np.sqrt(3 + SIN**2)}
    for cone, divisor in below.items():
        a, k = SIN / divisor, 3 * COHESION * COS / divisor
        for confining in (0.0, 5e6):
            strength = (root3 * k + (1 + 2 * root3 * a) * confining) / (1 - root3 * a)
            found, results = peak(lab, -1, "drucker_prager", strength, confining=confining, cone=cone)
            formula = "-(s3 k + (1 + 2 s3 a) p)/(1 - s3 a), s3 = sqrt(3)" if confining else "-s3 k/(1 - s3 a), s3 = sqrt(3)"
            rows.append(relative(f"Drucker-Prager, {cone} cone, strength at p = {confining / 1e6:g} MPa, Pa", formula,
                                 -strength, found, BAR, MESH))
            if not confining:  # without dilation the axis takes 1/s3 of it
                last = results.last_frame()
                shortened = -last.point_data["displacement"][:, 2].min() / 2.0
                rows.append(worst(f"Drucker-Prager, {cone} cone, plastic shear strain in the end", "s3 (strain - sigma_c/E)",
                                  root3 * (shortened - strength / YOUNG), last.cell_data["plastic_strain"], BAR, MESH))
    return rows


@problem("Uniaxial tension")
def uniaxial_tension(lab):
    rows = []
    for law in ("mohr_coulomb", "drucker_prager", "breakage"):
        found, _ = peak(lab, 1, law, TENSION, tension=TENSION)
        rows.append(relative(f"{law}: uniaxial tensile strength, Pa", "sigma_t", TENSION, found, BAR, MESH))
    return rows


@problem("Breakage of a specimen: peak, residual strength, mode")
def breakage_strength(lab):
    residual, angle, confining = 1e6, 30.0, 5e6
    strength = SIGMA_C + N_PHI * confining
    found, results = peak(lab, -1, "breakage", strength, confining=confining, tension=TENSION, residual_cohesion=residual,
                          residual_friction=angle)
    s, c = np.sin(np.radians(angle)), np.cos(np.radians(angle))
    left = (2 * residual * c + (1 + s) * confining) / (1 - s)
    last = results.last_frame().cell_data
    return [
        relative("breakage: strength at s3 = 5 MPa, Pa", "-2 c cos(phi)/(1 - sin(phi)) - N s3", -strength, found, BAR, MESH),
        relative("breakage: residual strength at s3 = 5 MPa, Pa", "the same with the residual numbers", -left,
                 last["stress"][:, 2].mean(), BAR, MESH),
        worst("breakage: mode of all blocks", "2 (shear)", 2.0, last["broken"], 0.0, MESH),
        relative("breakage: share of broken blocks", "1", 1.0, results.summary["broken_blocks"], 0.0, MESH),
    ]
