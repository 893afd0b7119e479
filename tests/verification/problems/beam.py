"""Cantilever of 10 x 1 x 1 m, nu = 0: tip deflection under a Saint-Venant traction, and the first frequency.

With nu = 0 nothing depends on y, so one cell across is exact there. The wall holds every node of x = 0; how it and the
steps of the traction differ from Saint-Venant's end is felt within about one depth only (below 1e-4 of the tip)."""
import numpy as np
from scipy.optimize import brentq, least_squares

import meshes
from problem import order, problem, relative

LENGTH, DEPTH, YOUNG, DENSITY, LOAD = 10.0, 1.0, 10e9, 2500.0, 1e4
INERTIA, AREA, SHEAR, KAPPA = DEPTH**4 / 12, DEPTH**2, YOUNG / 2, 5 / 6


def tip_of_beam():
    return LOAD * LENGTH**3 / (3 * YOUNG * INERTIA) + LOAD * LENGTH / (KAPPA * SHEAR * AREA)


def first_frequency():
    """Angular frequency of Timoshenko's cantilever: deflection and rotation zero at the wall, no moment and no shear at
    the tip; the general solution is four exponentials, the determinant of the four conditions vanishes."""
    shear, bending, mass, rotary = KAPPA * SHEAR * AREA, YOUNG * INERTIA, DENSITY * AREA, DENSITY * INERTIA

    def determinant(w):
        a, b = w**2 * mass / shear, w**2 * rotary / bending
        # y'' - r' + a y = 0,  r'' + (shear/bending) (y' - r) + b r = 0;  y = e^(p x), r = e^(p x) (p^2 + a)/p
        p = np.sqrt(np.roots([1, a + b, a * (b - shear / bending)]).astype(complex))
        p = np.concatenate([p, -p])
        r, end = (p**2 + a) / p, np.exp(p * LENGTH)
        matrix = np.array([np.ones(4), r, p * r * end, (p - r) * end])
        # the determinant is real or imaginary, and divided by what would vanish where two roots p agree
        value = np.linalg.det(matrix) / np.prod([p[i] - p[j] for i in range(4) for j in range(i)])
        return value.real if abs(value.real) > abs(value.imag) else value.imag

    bernoulli = 1.8751040687**2 * np.sqrt(bending / mass) / LENGTH**2
    return brentq(determinant, 0.97 * bernoulli, bernoulli, xtol=1e-12)


def beam(lab, n):
    """A mesh of 10 n x 1 x n cells, whose tip is n strips tip0, tip1, ..."""
    path, h = lab.path(f"beam{n}.msh"), DEPTH / n
    def side(name, centre):
        if name == "xmax":
            return f"tip{int(centre[2] / h)}"
        return "wall" if name == "xmin" else None
    meshes.hexahedra(path, h * np.arange(10 * n + 1), (0, DEPTH), h * np.arange(n + 1), lambda centre: "beam", side)
    return {"mesh": path, "block_law": "elastic", "block_young": YOUNG, "block_poisson": 0.0, "block_density": DENSITY,
            "boundary_wall_fix": "xyz"}


def history_at(name, x):
    return {f"history_{name}_at": (x, 0, DEPTH / 2), f"history_{name}_of": "displacement_z"}


def tip_deflection(lab, n, block=()):
    """Results of the beam at rest under its tip load, n cells a depth, and the deflection; block: further options."""
    strips = [f"tip{i}" for i in range(n)]
    options = {**beam(lab, n), "boundaries": ["wall"] + strips, "histories": "tip", **history_at("tip", LENGTH),
               "damping_alpha": 2 * first_frequency(), "ts_max_time": 17 / first_frequency(),
               "history_interval": 100, **dict(block)}
    edge = np.linspace(-0.5, 0.5, n + 1)
    resultant = LOAD * (1.5 * edge - 2 * edge**3)  # of the parabola below each edge
    for name, share in zip(strips, np.diff(resultant)):
        options[f"boundary_{name}_traction"] = (0.0, 0.0, -share * n / DEPTH**2)
    results = lab.run(options)
    return results, -results.histories()["tip"][-1]


@problem("Cantilever, tip deflection")
def cantilever_tip(lab):
    sizes, exact = (2, 4, 8), tip_of_beam()
    errors = [tip_deflection(lab, n)[1] - exact for n in sizes]
    finest = exact + errors[-1]
    limit = finest + (errors[-1] - errors[-2]) / 3
    mesh = f"{10 * sizes[-1]}x1x{sizes[-1]} hexahedra"
    formula = "P L^3/(3 E I) + P L/(kappa G A)"
    return [relative("cantilever, tip deflection, m", formula, exact, finest, 1e-2, mesh),
            order("cantilever, order in h of the tip deflection", [1 / n for n in sizes], errors, 2, 0.1,
                  "2, 4, 8 cells a depth"),
            relative("cantilever, tip deflection extrapolated to h = 0, m", formula, exact, limit, 1e-3,
                     "4 and 8 cells a depth")]


STRENGTH = 1e20  # Pa: nothing breaks
FORMS = {"full": {}, "bbar": {"block_element": "bbar"}, "onepoint": {"block_element": "onepoint"},
         "spring": {"block_law": "spring", "block_tension": STRENGTH, "block_cohesion": STRENGTH, "block_friction": 0.0}}


@problem("Cantilever, tip deflection by the other element forms")
def cantilever_forms(lab):
    exact, rows = tip_of_beam(), []
    formula = "P L^3/(3 E I) + P L/(kappa G A)"
    # springs bend stiffly (docs/benchmarks/forms.md): two meshes do not tell their limit as closely
    for form, bar, limit_bar in (("bbar", 1e-2, 1e-3), ("onepoint", 1e-2, 1e-3), ("spring", 6e-2, 1.2e-2)):
        found = [tip_deflection(lab, n, FORMS[form])[1] for n in (4, 8)]
        rows += [relative(f"cantilever, {form}: tip deflection, m", formula, exact, found[1], bar, "80x1x8 hexahedra"),
                 relative(f"cantilever, {form}: tip deflection extrapolated to h = 0, m", formula, exact,
                          found[1] + (found[1] - found[0]) / 3, limit_bar, "4 and 8 cells a depth")]
    return rows


def measured_frequency(time, signal, guess):
    """The lowest of three undamped modes fitted to a free vibration."""
    def parts(ratios):
        return np.concatenate([[f(guess * r * time) for f in (np.cos, np.sin)] for r in ratios]).T
    def rest(ratios):
        basis = parts(ratios)
        return (basis @ np.linalg.lstsq(basis, signal, rcond=None)[0] - signal) / np.max(np.abs(signal))
    fitted = least_squares(rest, (1.0, 6.0, 16.0), x_scale=(0.01, 0.1, 0.3), xtol=1e-14, ftol=1e-14)
    return guess * fitted.x[0]


@problem("Cantilever, first frequency")
def cantilever_frequency(lab):
    exact, found = first_frequency() / (2 * np.pi), []
    for n in (4, 8):
        options = {**beam(lab, n), "boundaries": "wall", "velocity": (0, 0, 0.1), "histories": "tip",
                   **history_at("tip", LENGTH), "ts_max_time": 3 / exact, "history_interval": 5}
        histories = lab.run(options).histories()
        found.append(measured_frequency(histories["time"], histories["tip"], 2 * np.pi * exact) / (2 * np.pi))
    mesh = "80x1x8 hexahedra"
    formula = "Timoshenko's beam, kappa = 5/6 (Euler-Bernoulli is 0.8 % above)"
    return [relative("cantilever, first frequency, Hz", formula, exact, found[1], 1e-2, mesh),
            relative("cantilever, first frequency extrapolated to h = 0, Hz", formula, exact,
                     found[1] + (found[1] - found[0]) / 3, 1e-3, "4 and 8 cells a depth")]
