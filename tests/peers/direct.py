"""Transients of the linear network by matrix exponentials in 80 digits, as an independent reference for engine `direct`.

usage: direct.py

m u'' + r u' + K u + sum k_i (u - z_i) = f U^2, z_i' = (u - z_i)/tau_i for a dot of model `lumped` (Eqs. 19-23) with the modulus
given. The state and the force with its two derivatives are one vector, moved over each linear segment of the voltage by expm.
Prints for every case of CASES rows `time, displacement, velocity` as C initialisers.
"""
from mpmath import mp, mpf, expm, matrix, pi, log, nstr

mp.dps = 80
EPSILON_0 = mpf("8.8541878128e-12")


def film(case):
    """m, r, K, f and the branches of a dot: frame 30 mm, coverage 0.5, 100 um, pre-stretch 1.2."""
    stretch, frame, coverage, thickness = mpf(1.2), mpf(0.03), mpf(0.5), mpf(1e-4)
    radius = coverage * frame
    section = 2 * pi * radius * thickness / stretch**2
    stiffness = mpf(1e6) * section * (1 / radius + 1 / (frame - radius))
    force = EPSILON_0 * mpf(2.8) * stretch**4 / thickness**2 * section
    a, b = radius / stretch, frame / stretch
    shape = b**4 * log(b / a) - b**2 * (b**2 - a**2) + (b**4 - a**4) / 4
    area = pi * a**2 / 2 + 2 * pi * a**2 / (b**2 - a**2) ** 2 * shape
    mass = mpf(case.get("density", 0)) * thickness * area
    rest = 1 - sum(mpf(g) for g, _ in case["prony"])
    branches = [(stiffness * mpf(g) / rest, mpf(tau)) for g, tau in case["prony"]]
    return mass, mpf(case.get("retardation", 0)) * stiffness, stiffness, force, branches


def system(case):
    """Matrix of the vector (states, F, F', F''), and the rows that give u and v of it."""
    mass, damping, stiffness, _, branches = film(case)
    inertial, damped, n = mass > 0, damping > 0, len(branches)
    first = 2 if inertial else 1 if damped else 0
    size = first + n + 3
    held = stiffness + sum(k for k, _ in branches)
    u, balance = matrix(1, size), matrix(1, size)  # balance: F - K u - sum k (u - z)
    if first:
        u[0] = 1
        balance[0] = -held
    balance[first + n] = 1
    for i, (k, _) in enumerate(branches):
        balance[first + i] = k
    if not first:
        u = balance / held
    a = matrix(size, size)
    if inertial:
        a[0, 1] = 1
        for j in range(size):
            a[1, j] = balance[j] / mass
        a[1, 1] -= damping / mass
    elif damped:
        for j in range(size):
            a[0, j] = balance[j] / damping
    for i, (_, tau) in enumerate(branches):
        for j in range(size):
            a[first + i, j] += u[j] / tau
        a[first + i, first + i] -= 1 / tau
    a[first + n, first + n + 1] = 1
    a[first + n + 1, first + n + 2] = 1
    return a, u, u * a, first + n


def solve(case):
    a, u, v, place = system(case)
    force = film(case)[3]
    state = matrix(a.rows, 1)
    points = [(mpf(t), mpf(voltage)) for t, voltage in case["points"]]
    rows = []
    times = [mpf(t) for t in case["times"]]
    for (start, low), (end, high) in zip(points, points[1:]):
        rise = (high - low) / (end - start)
        state[place], state[place + 1], state[place + 2] = force * low**2, 2 * force * low * rise, 2 * force * rise**2
        for t in times:
            if start < t <= end:
                there = expm(a * (t - start)) * state
                rows.append((t, (u * there)[0], (v * there)[0]))
        state = expm(a * (end - start)) * state
    return rows


WIDE = [(0.1, 1e-6), (0.15, 1e-3), (0.2, 1.0), (0.1, 1e3), (0.05, 1e6)]
STEP = [(0.0, 0.0), (0.5, 0.0), (0.5 + 1e-6, 2000.0), (10.0, 2000.0)]
CASES = {
    "wide_with_mass": {"density": 1080.0, "prony": WIDE, "points": STEP, "times": [0.5, 1.0, 2.0, 4.5, 10.0]},
    "wide_without_mass": {"prony": WIDE, "points": STEP, "times": [0.5, 1.0, 2.0, 4.5, 10.0]},
    "wide_with_damper": {"retardation": 1e-3, "prony": WIDE, "points": STEP, "times": [0.5, 1.0, 2.0, 4.5, 10.0]},
    "wide_with_both": {"density": 1080.0, "retardation": 1e-3, "prony": WIDE, "points": STEP, "times": [0.5, 1.0, 2.0, 4.5, 10.0]},
    "ringing": {"density": 1080.0, "prony": WIDE, "points": [(0.0, 2000.0), (0.01, 2000.0)], "times": [0.0005, 0.001, 0.0015, 0.002, 0.01]},
    "triangle": {"density": 1080.0, "retardation": 1e-5, "prony": WIDE,
                 "points": [(0.0, 0.0), (0.25, 3000.0), (0.75, -1000.0), (1.0, 500.0)],
                 "times": [0.125, 0.25, 0.5, 0.75, 1.0]},
    "huddle": {"density": 1080.0, "prony": [(0.8888, 5.045e-05)],
               "points": [(0.0, 2000.0), (2e-3, 2000.0)], "times": [1e-4, 2e-4, 3e-4, 5e-4, 2e-3]},
    "instant": {"density": 1080.0, "retardation": 1.65e-5, "prony": [(0.9, 5e-11)],
                "points": [(0.0, 2000.0), (5e-3, 1000.0)], "times": [1e-3, 2e-3, 3e-3, 4e-3, 5e-3]},
    "late": {"density": 1080.0, "retardation": 1e-5, "prony": WIDE,
             "points": [(0.0, 0.0), (1e6, 2000.0), (2e6, 2000.0)], "times": [4e5, 8e5, 1.2e6, 1.6e6, 2e6]},
}

if __name__ == "__main__":
    for name, case in CASES.items():
        print("static const double %s[][3] = {" % name)
        for row in solve(case):
            print("    {%s}," % ", ".join(nstr(x, 17, min_fixed=0, max_fixed=0) for x in row))
        print("};")
