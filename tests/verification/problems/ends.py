"""A pulse at a free and at a fixed end. By images both are exact in the discrete column too: against a column twice as
long, the free end moves twice the incident pulse, and below a fixed end the reflection is the pulse reversed."""
import numpy as np

import columns
from problem import Row, problem

LENGTH, PLACE, H, WAVELENGTH = 40.0, 30.0, 0.5, 10.0


def history(lab, kind, length, places, fixed=False):
    frequency, dt = columns.SPEED[kind] / WAVELENGTH, 0.5 * H / columns.SPEED["P"]
    more = ("zmin", "zmax") if fixed else ("zmin",)
    options = {**columns.box(round(length / H), H), **columns.rock(), **columns.sides(kind, more),
               **columns.ricker_base(kind, frequency), **columns.histories(kind, places),
               "ts_dt": dt, "ts_max_steps": round(10.5 / frequency / dt)}
    if fixed:
        options["boundary_zmax_fix"] = "xyz"
    found = lab.run(options).histories()
    return [found[f"h{i}"] for i in range(len(places))]


def factor(name, formula, exact, reflected, incident, mesh):
    """The share of incident in reflected, and what is left of the difference, relative to exact times the peak."""
    computed = reflected @ incident / (incident @ incident)
    error = np.max(np.abs(reflected - exact * incident)) / np.max(np.abs(exact * incident))
    return Row(name, formula + "; error: of the whole history", exact, float(computed), float(error), 1e-10, mesh)


def both_ends(lab, kind):
    mesh = f"1x1x{round(LENGTH / H)} hexahedra, 20 a wavelength"
    at_end, passing, returning = history(lab, kind, 2 * LENGTH, (LENGTH, PLACE, 2 * LENGTH - PLACE))
    (free,) = history(lab, kind, LENGTH, (LENGTH,))
    (fixed,) = history(lab, kind, LENGTH, (PLACE,), fixed=True)
    return [factor(f"{kind} wave, free end / incident", "2", 2.0, free, at_end, mesh),
            factor(f"{kind} wave, reflected from a fixed end / incident", "-1", -1.0, fixed - passing, returning, mesh)]


@problem("P wave at a free and at a fixed end")
def p_ends(lab):
    return both_ends(lab, "P")


@problem("S wave at a free and at a fixed end")
def s_ends(lab):
    return both_ends(lab, "S")
