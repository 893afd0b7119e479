"""Travelling Ricker pulses in columns: speed, order in h, and the discrete dispersion relation.

A column of one by one cells whose sides keep it one-dimensional; the base moves as a Ricker pulse of wavelength 10 m. The
histories at two heights hold the whole first passage, so their Fourier sums give the wave number at any frequency, and
for the discrete column that relation is exact whatever the pulse."""
import numpy as np

import columns
from problem import order, problem, relative

WAVELENGTH, HEIGHT, LOW, HIGH = 10.0, 60.0, 10.0, 30.0


def passage(lab, kind, h):
    """Histories at LOW and HIGH of the pulse's first passage; the reflection from the top comes after the end."""
    speed = columns.SPEED[kind]
    frequency, dt = speed / WAVELENGTH, 0.5 * h / columns.SPEED["P"]
    options = {**columns.box(round(HEIGHT / h), h), **columns.rock(), **columns.sides(kind, ("zmin",)),
               **columns.ricker_base(kind, frequency), **columns.histories(kind, (LOW, HIGH)),
               "ts_dt": dt, "ts_max_steps": round(8.5 / frequency / dt)}
    histories = lab.run(options).histories()
    return frequency, dt, histories["time"], histories["h0"], histories["h1"]


def wavenumber(time, low, high, frequency, guess):
    """k from the phase between the two heights; guess resolves the whole turns."""
    ratio = columns.spectrum(high, time, frequency) / columns.spectrum(low, time, frequency)
    return guess - np.angle(ratio * np.exp(1j * guess * (HIGH - LOW))) / (HIGH - LOW)


def pulse(time, frequency):
    a = np.pi * frequency * (time - 2 / frequency)
    return 1e-3 * (1 - 2 * a**2) * np.exp(-a**2)


def plane_wave(lab, kind):
    exact = columns.SPEED[kind]
    formula = {"P": "sqrt((lambda + 2 G)/rho)", "S": "sqrt(G/rho)"}[kind]
    sizes, slow, shape = [WAVELENGTH / n for n in (20, 40, 80)], [], []
    discrete, measured = [], []
    for h in sizes:
        frequency, dt, time, low, high = passage(lab, kind, h)
        k = columns.discrete_wavenumber(exact, h, dt, frequency)
        speed = 2 * np.pi * frequency / wavenumber(time, low, high, frequency, k)
        slow.append(speed - exact)
        expected = pulse(time - HIGH / exact, frequency)
        shape.append(np.linalg.norm(high - expected) / np.linalg.norm(expected))
        if h == sizes[0]:
            for f in frequency * np.array([0.5, 0.75, 1, 1.5, 2]):
                discrete.append(columns.discrete_wavenumber(exact, h, dt, f))
                measured.append(wavenumber(time, low, high, f, discrete[-1]))
    measured, discrete = np.array(measured), np.array(discrete)
    at = np.argmax(np.abs(measured / discrete - 1))
    finest = f"1x1x{round(HEIGHT / sizes[-1])} hexahedra, 80 a wavelength"
    return [
        relative(f"{kind} wave, phase speed, m/s", formula, exact, exact + slow[-1], 1e-3, finest),
        order(f"{kind} wave, order in h of the phase speed", sizes, slow, 2, 0.1, "20, 40, 80 cells a wavelength"),
        order(f"{kind} wave, order in h of the history (L2)", sizes, shape, 2, 0.1, "20, 40, 80 cells a wavelength"),
        relative(f"{kind} wave, wave number at fixed h, worst of 5 frequencies, 1/m",
                 "sin(w dt/2) = (c dt/h) sin(k h/2)", discrete[at], measured[at], 1e-6,
                 "20 cells a wavelength (10 at the highest)"),
    ]


@problem("Plane P wave, Ricker pulse in a column")
def p_wave(lab):
    return plane_wave(lab, "P")


@problem("Plane S wave, Ricker pulse in a column")
def s_wave(lab):
    return plane_wave(lab, "S")


@problem("Rod wave, free sides, nu = 0.25")
def rod_wave(lab):
    speed = np.sqrt(columns.YOUNG / columns.DENSITY)
    wavelength, cells = 50.0, 300
    frequency = speed / wavelength
    options = {**columns.box(cells, 1.0), **columns.rock(), "boundaries": "zmin",
               **columns.ricker_base("P", frequency), **columns.histories("P", (50.0, 150.0)),
               "ts_dt": 0.5 / columns.SPEED["P"], "ts_max_steps": round(8.5 / frequency * 2 * columns.SPEED["P"])}
    histories = lab.run(options).histories()
    ratio = np.divide(*(columns.spectrum(histories[name], histories["time"], frequency) for name in ("h1", "h0")))
    k = 2 * np.pi / wavelength - np.angle(ratio * np.exp(2j * np.pi * 100.0 / wavelength)) / 100.0
    return [relative("rod wave, phase speed at 50 widths a wavelength, m/s", "sqrt(E/rho)", speed,
                     2 * np.pi * frequency / k, 1e-3, f"1x1x{cells} hexahedra")]
