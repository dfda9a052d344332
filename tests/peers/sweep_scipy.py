"""The sweep of Figure 10 by SciPy, as a user would write it: lumped in closed form, coverage by brentq, field by solve_ivp and brentq.

Prints `model,microseconds_per_point,coverage,strain` for some points of the sweep.
"""
import sys
import time

import numpy as np
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

C1, C2, C3 = 178426.0, -6023.0, 4234.0
EPSILON = 8.8541878128e-12 * 2.8
PRESTRETCH, VOLTAGE, THICKNESS = 1.2, 4500.0, 100e-6
M = EPSILON * (VOLTAGE / THICKNESS) ** 2


def stress(stretch):
    j = 2 * stretch**2 + stretch**-4 - 3
    return 2 * (stretch**2 - stretch**-4) * (C1 + 2 * C2 * j + 3 * C3 * j**2)


def modulus(stretch):
    j = 2 * stretch**2 + stretch**-4 - 3
    w = C1 + 2 * C2 * j + 3 * C3 * j**2
    dj = 4 * (stretch - stretch**-5)
    return 2 * (2 * stretch + 4 * stretch**-5) * w + 2 * (stretch**2 - stretch**-4) * (2 * C2 + 6 * C3 * j) * dj


def lumped(b):
    return (1 - b) * M * PRESTRETCH**4 / modulus(PRESTRETCH)


def coverage(b):
    def imbalance(s):
        active = PRESTRETCH * (1 + s)
        passive = PRESTRETCH * (1 - b * (1 + s)) / (1 - b)
        return stress(active) - M * active**4 - stress(passive)

    return brentq(imbalance, 0, 0.2 * min(1, (1 - b) / b), xtol=1e-15, rtol=1e-14)


def moduli(l1, l2):
    j = l1**2 + l2**2 + (l1 * l2) ** -2 - 3
    w = C1 + 2 * C2 * j + 3 * C3 * j**2
    q = 2 * C2 + 6 * C3 * j
    a1 = 2 * (l1 - l1**-3 * l2**-2)
    a2 = 2 * (l2 - l2**-3 * l1**-2)
    return w * a1, w * a2, w * (2 + 6 * l1**-4 * l2**-2) + q * a1**2, 4 * w * (l1 * l2) ** -3 + q * a1 * a2


def slopes(x, y):
    l1, l2 = y
    s1, s2, s11, s12 = moduli(l1, l2)
    return [(s2 - s1 - s12 * (l1 - l2)) / s11, l1 - l2]


def field(b):
    def miss(s):
        active = PRESTRETCH * (1 + s)
        pull = moduli(active, active)[0] - M * active**3
        l1 = brentq(lambda l: moduli(l, active)[0] - pull, 0.3 * active, active, xtol=1e-14)
        return solve_ivp(slopes, [0, -np.log(b)], [l1, active], rtol=1e-10, atol=1e-12, method="DOP853").y[1, -1] - PRESTRETCH

    return brentq(miss, 1e-6, 0.2 * min(1, (1 - b) / b), xtol=1e-13, rtol=1e-12)


def sweep(name, model, points):
    grid = np.linspace(0.1, 0.9, points)
    start = time.perf_counter()
    strains = [model(b) for b in grid]
    microseconds = 1e6 * (time.perf_counter() - start) / points
    for i in range(0, points, (points - 1) // 4):
        print(f"{name},{microseconds:.6g},{grid[i]:.17g},{strains[i]:.17g}")


if __name__ == "__main__":
    scale = int(sys.argv[1]) if len(sys.argv) > 1 else 1
    sweep("lumped", lumped, 400 * scale + 1)
    sweep("coverage", coverage, 400 * scale + 1)
    sweep("field", field, 5)
