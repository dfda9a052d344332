"""Prony branches of a relaxation test by SciPy, as an independent reference for `deaspice fit --relaxation`.

usage: relaxation.py FILE RAMP_SECONDS [MOST_BRANCHES]

The stress after a ramp of duration T is a + sum a_i exp(-t/tau_i) (1 - exp(-T/tau_i)) tau_i/T. For each number of branches the
shares come from scipy.optimize.nnls and the times from least_squares, from many random starts with a fixed seed. Prints
`branches,rms_percent,p,long_term_share,tau_1,g_1,...`; p is that of the F test against one branch less.
"""
import csv
import sys

import numpy as np
from scipy.optimize import least_squares, nnls
from scipy.stats import f as f_distribution


def read(path):
    with open(path) as file:
        rows = list(csv.reader(line for line in file if not line.startswith("#")))
    factor = {"stress_Pa": 1.0, "stress_kPa": 1e3, "stress_MPa": 1e6}[rows[0][1]]
    values = np.array(rows[1:], dtype=float)
    return values[:, 0], values[:, 1] * factor


def basis(times, ramp, taus):
    columns = [np.ones_like(times)]
    for tau in taus:
        rise = -np.expm1(-ramp / tau) * tau / ramp if ramp > 0 else 1.0
        columns.append(np.exp(-times / tau) * rise)
    return np.column_stack(columns)


def residuals(logs, times, stress, ramp):
    matrix = basis(times, ramp, np.exp(logs))
    shares, _ = nnls(matrix, stress)
    return matrix @ shares - stress


def best(times, stress, ramp, branches, random):
    if branches == 0:
        return np.array([])
    gap, window = np.min(np.diff(times)), times[-1] - times[0]
    low, high = np.log(max(gap / 4, ramp / 40)), np.log(4 * window)
    found = None
    for _ in range(60):
        start = np.sort(random.uniform(low, high, branches))
        fit = least_squares(residuals, start, args=(times, stress, ramp), bounds=(low, high), xtol=1e-14, ftol=1e-14, gtol=1e-14)
        if found is None or fit.cost < found.cost:
            found = fit
    return np.sort(np.exp(found.x))


def main():
    times, stress = read(sys.argv[1])
    ramp = float(sys.argv[2])
    most = int(sys.argv[3]) if len(sys.argv) > 3 else (len(times) - 2) // 2
    scale = stress.max()
    stress = stress / scale
    random = np.random.default_rng(1)
    before = None
    print("branches,rms_percent,p,long_term_share,tau_and_g")
    for branches in range(most + 1):
        taus = best(times, stress, ramp, branches, random)
        matrix = basis(times, ramp, taus)
        shares, norm = nnls(matrix, stress)
        squares, freedom = norm**2, len(times) - 2 * branches - 1
        p = float("nan")
        if before is not None and freedom > 0:
            p = f_distribution.sf((before - squares) / 2 / (squares / freedom), 2, freedom)
        relative = shares / shares.sum()
        pairs = ["%.8g,%.8g" % pair for pair in zip(taus, relative[1:])]
        print(",".join(["%d,%.8g,%.4g,%.8g" % (branches, 100 * norm / np.linalg.norm(stress), p, relative[0])] + pairs))
        before = squares


if __name__ == "__main__":
    main()
