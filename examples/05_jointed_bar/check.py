"""Transmission and reflection of the joint at three frequencies, by spectral ratios."""
import os
import sys

import numpy as np

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
import checks

YOUNG, POISSON, DENSITY, KN = 5.0e10, 0.25, 2500.0, 1.92382e9
SPLIT = 0.1115    # s; the incident pulse has passed x = 200 m, the reflected one has not come yet


def impedance():
    modulus = YOUNG * (1 - POISSON) / ((1 + POISSON) * (1 - 2 * POISSON))
    return np.sqrt(modulus * DENSITY)


def spectrum(t, v, w):
    """Fourier integral of v at the angular frequencies w (trapezia; the pulses start and end at zero)."""
    return np.array([np.trapezoid(v * np.exp(-1j * x * t), t) if hasattr(np, "trapezoid")
                     else np.trapz(v * np.exp(-1j * x * t), t) for x in np.atleast_1d(w)])


def ratios(h, w):
    """|transmitted|/|incident| and |reflected|/|incident| at w."""
    t, first = h["time"], h["time"] < SPLIT
    incident = spectrum(t[first], h["before"][first], w)
    reflected = spectrum(t[~first], h["before"][~first], w)
    transmitted = spectrum(t, h["after"], w)
    return abs(transmitted / incident), abs(reflected / incident)


def main():
    h = checks.histories(checks.folder())
    x = np.array([0.5, 1.0, 2.0])
    transmitted, reflected = ratios(h, 2 * KN * x / impedance())
    rows = []
    for k, xk in enumerate(x):
        rows.append((f"transmission, X = {xk:g}", 1 / np.hypot(1, xk), transmitted[k], 5e-3))
        rows.append((f"reflection, X = {xk:g}", xk / np.hypot(1, xk), reflected[k], 5e-3))
    checks.report(rows)


if __name__ == "__main__":
    main()
