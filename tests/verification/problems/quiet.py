"""Quiet ends of columns at normal incidence: what comes back, and a wave that comes in.

A column of lumped masses with a centred dashpot rho c A at its end reflects, exactly,

    R = (a - b)/(a + b)        a = (c/h) sin(k h),  b = sin(w dt)/dt,  sin(w dt/2) = (c dt/h) sin(k h/2)

of the velocity at angular frequency w, about -(k h)^2/16 (1 - (c dt/h)^2), and a wave v_in that comes in through the
dashpot moves the column by (1 - R) v_in. The shortest wave is that of 2.5 times the pulse's frequency, where a Ricker
pulse has 3 % of its largest amplitude; it has 20 cells."""
import numpy as np

import columns
from problem import Row, problem, relative

SHORTEST, CELLS, SHARE, LENGTH, LOW, HIGH = 10.0, 20, 2.5, 60.0, 8.0, 52.0  # LOW and HIGH keep up and down apart
H = SHORTEST / CELLS
WHERE = f"1x1x{round(LENGTH / H)} hexahedra, 20 a shortest wavelength"


def clock(kind):
    """Pulse frequency, dt, and the steps in which a wave passes a length [m] after the pulse has ended."""
    frequency, dt = columns.SPEED[kind] / SHORTEST / SHARE, 0.5 * H / columns.SPEED["P"]
    return frequency, dt, lambda length: round((4 / frequency + length / columns.SPEED[kind]) / dt)


def reflection(kind, frequency, dt):
    k = columns.discrete_wavenumber(columns.SPEED[kind], H, dt, frequency)
    a, b = columns.SPEED[kind] / H * np.sin(k * H), np.sin(2 * np.pi * frequency * dt) / dt
    return (a - b) / (a + b)


def absorbed(lab, kind):
    """The pulse of a moved base at a quiet top: the same pulse in a column twice as long is what would pass."""
    frequency, dt, steps = clock(kind)
    found = []
    for length, quiet in ((2 * LENGTH, False), (LENGTH, True)):
        options = {**columns.box(round(length / H), H), **columns.rock(), **columns.sides(kind, ("zmin", "zmax")[:1 + quiet]),
                   **columns.ricker_base(kind, frequency), **columns.histories(kind, (HIGH, 2 * LENGTH - HIGH)[:2 - quiet]),
                   "ts_dt": dt, "ts_max_steps": steps(2 * LENGTH - HIGH)}
        if quiet:
            options["boundary_zmax_quiet"] = True
        found.append(lab.run(options).histories())
    passing, back = found[0], found[1]["h0"] - found[0]["h0"]
    time, shortest = passing["time"], SHARE * frequency
    exact = reflection(kind, shortest, dt)
    spectral = columns.spectrum(back, time, shortest) / columns.spectrum(passing["h1"], time, shortest)
    peak = np.max(np.abs(back)) / np.max(np.abs(passing["h0"]))
    return [Row(f"{kind} wave at a quiet end: largest reflected / largest incident", "0; error: the plain difference", 0.0, peak,
                peak, 1e-2, WHERE),
            Row(f"{kind} wave at a quiet end: reflection of the shortest wave", "0; error: the plain difference", 0.0,
                abs(spectral), abs(spectral), 1e-2, WHERE),
            Row(f"{kind} wave at a quiet end: the same, discrete", "R = (a - b)/(a + b)", exact, spectral.real,
                abs(spectral / exact - 1), 1e-6, WHERE)]


def ricker(time, frequency):
    a = np.pi * frequency * (time - 2 / frequency)
    return (1 - 2 * a**2) * np.exp(-a**2)


def incoming(lab, kind):
    """A wave that comes in through a quiet base, meets the free top and leaves."""
    frequency, dt, steps = clock(kind)
    vector = {"z": (0.0, 0.0, 0.1), "x": (0.1, 0.0, 0.0)}[columns.AXIS[kind]]
    options = {**columns.box(round(LENGTH / H), H), **columns.rock(), **columns.sides(kind, ("zmin",)),
               "boundary_zmin_quiet": True, "boundary_zmin_velocity": vector, "boundary_zmin_components": columns.AXIS[kind],
               "boundary_zmin_table": "pulse", "tables": "pulse", "table_pulse_type": "ricker",
               "table_pulse_frequency": frequency, "table_pulse_delay": 2 / frequency,
               **columns.histories(kind, (LOW, LENGTH)), "ts_dt": dt, "ts_max_steps": steps(2.2 * LENGTH)}
    for i in range(2):
        options[f"history_h{i}_of"] = "velocity_" + columns.AXIS[kind]
    found = lab.run(options).histories()
    speed, shortest = columns.SPEED[kind], SHARE * frequency
    time, passed = found["time"], 4 / frequency  # the pulse is over at its source
    upward = time < passed + LOW / speed
    inside, top, left = found["h0"][upward], found["h1"], found["h0"][time > passed + (2 * LENGTH - LOW) / speed]
    expected = 0.1 * ricker(time - LOW / speed, frequency)[upward]
    into = columns.spectrum(inside, time[upward], shortest) / columns.spectrum(0.1 * ricker(time, frequency), time, shortest)
    return [
        relative(f"{kind} wave from below: largest velocity inside, m/s", "v_in", 0.1, np.max(inside), 1e-2, WHERE),
        relative(f"{kind} wave from below: least velocity inside, m/s", "-2 exp(-3/2) v_in", -0.2 * np.exp(-1.5),
                 np.min(inside), 1e-2, WHERE),
        Row(f"{kind} wave from below: history inside", "v_in(t - z/c); error: L2", 0.1, np.max(inside),
            np.linalg.norm(inside - expected) / np.linalg.norm(expected), 1e-2, WHERE),
        relative(f"{kind} wave from below: largest velocity of the free top, m/s", "2 v_in", 0.2, np.max(top), 1e-2, WHERE),
        Row(f"{kind} wave from below: largest velocity once it has left, m/s", "0; error: over v_in", 0.0,
            np.max(np.abs(left)), np.max(np.abs(left)) / 0.1, 1e-2, WHERE),
        relative(f"{kind} wave from below: shortest wave inside / v_in, discrete", "1 - R",
                 1 - reflection(kind, shortest, dt), abs(into), 1e-6, WHERE),
    ]


@problem("P wave at a quiet end")
def p_quiet(lab):
    return absorbed(lab, "P")


@problem("S wave at a quiet end")
def s_quiet(lab):
    return absorbed(lab, "S")


@problem("P wave that comes in through a quiet base")
def p_incoming(lab):
    return incoming(lab, "P")


@problem("S wave that comes in through a quiet base")
def s_incoming(lab):
    return incoming(lab, "S")
