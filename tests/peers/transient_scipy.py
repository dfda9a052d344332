"""Transients and frequency responses of the moving edge by SciPy, from the equations alone: the model is integrated in double
precision by DOP853 as its text states it, region by region, and linearised by complex steps.

transient_scipy.py references   prints the reference values of the scenes below as the C header tests/unit/references.h
transient_scipy.py protocol METHOD RTOL [RTOL ...]
                                prints method,rtol,milliseconds,error of the switch-on/off protocol of 25 s (lumped, mass, three
                                branches, 2501 samples): time of the solve alone (median of three where it is short), error
                                relative to the peak
"""
import math
import cmath
import statistics
import sys
import time

import numpy as np
from scipy.integrate import solve_ivp
from scipy.linalg import expm

EPSILON_0 = 8.8541878128e-12
NONE = math.nan
STEP = 1e-30  # of complex-step derivatives


def given(value):
    return not math.isnan(value)


def scene(**changes):
    """A scene of the base film; what is not named keeps these values."""
    base = dict(kind="dot", model="lumped", r=0.03, b=0.5, thickness=1e-4, pre=1.2, electrode=0.0, yeoh=(178426.0, -6023.0, 4234.0),
                permittivity=2.8, slope=0.0, density=0.0, kelvin=0.0, prony=(), instantaneous=False, modulus=NONE, rs=NONE, rp=NONE,
                wave=None, bias=False, until=0.0, every=0.0, show=())
    assert set(changes) <= set(base)
    return dict(base, **changes)


# ---- material: equi-biaxial Cauchy stress, its slope, tangent moduli

class Material:
    def __init__(self, s):
        self.lost = sum(g for g, _ in s["prony"])
        share = 1.0 - self.lost if s["instantaneous"] else 1.0
        self.c = [share * c for c in s["yeoh"]]
        self.modulus = share * s["modulus"] if given(s["modulus"]) else self.dstress(s["pre"])
        self.epsilon = EPSILON_0 * (s["permittivity"] + s["slope"] * s["pre"])
        # relative to the long-term stress: sigma_0 = sigma_inf/(1 - sum g)
        self.branches = [(g / (1.0 - self.lost), tau) for g, tau in s["prony"]]

    def w(self, j):
        return self.c[0] + 2 * self.c[1] * j + 3 * self.c[2] * j * j

    def q(self, j):
        return 2 * self.c[1] + 6 * self.c[2] * j

    def stress(self, l):
        j = 2 * l**2 + l**-4 - 3
        return 2 * (l**2 - l**-4) * self.w(j)

    def dstress(self, l):
        j = 2 * l**2 + l**-4 - 3
        return 2 * (2 * l + 4 * l**-5) * self.w(j) + 2 * (l**2 - l**-4) * self.q(j) * (4 * l - 4 * l**-5)

    def tangent(self, l):
        j = 2 * l**2 + l**-4 - 3
        a = 2 * (l - l**-5)
        return self.w(j) * (2 + 6 * l**-6) + self.q(j) * a * a, 4 * self.w(j) * l**-6 + self.q(j) * a * a


# ---- models: regions (restoring stress T and its slope over u), area A, force per U^2, capacitance

class Lumped:
    def __init__(self, s, m):
        ra = s["b"] * s["r"]
        cross = 2 * math.pi * ra * s["thickness"] / s["pre"] ** 2
        na = ra / (m.modulus * cross)
        np_ = (s["r"] - ra) / (m.modulus * cross)
        self.stiffness = (1 / na, 1 / np_)
        self.sign = 1 if s["kind"] == "dot" else -1
        self.f = self.sign * m.epsilon * s["pre"] ** 4 / s["thickness"] ** 2 * cross
        self.c2 = 0.0
        area = ra**2 if s["kind"] == "dot" else s["r"] ** 2 - ra**2
        self.c0 = m.epsilon * math.pi * area * s["pre"] ** 2 / s["thickness"]

    def area(self, u):
        return 1.0

    def regions(self, u):
        return [(k * u, k) for k in self.stiffness]

    def force(self, u):
        return self.f + 0.5 * self.c2 * u

    def capacitance(self, u):
        return self.c0 + 2 * self.f * u + 0.5 * self.c2 * u * u


class Lame(Lumped):
    def __init__(self, s, m):
        super().__init__(s, m)
        h, b, l, e = s["thickness"], s["b"], s["pre"], m.epsilon
        w11, w12 = m.tangent(l)
        self.stiffness = (2 * math.pi * h * (w11 + w12), 2 * math.pi * h * (w11 * (1 + b * b) / (1 - b * b) - w12))
        self.f = self.sign * 2 * math.pi * h * e / h**2 * l**3 * b * s["r"] / l
        # what the voltage terms -M l^2, -2 M l^2 add to the electroded region's stiffness, per U^2
        soft = e / h**2 * l * l
        if s["kind"] == "dot":
            added = 2 * math.pi * h * (-soft - 2 * soft)
        else:
            added = 2 * math.pi * h * (-soft * (1 + b * b) / (1 - b * b) + 2 * soft)
        self.c2 = -2 * added


class Coverage:
    def __init__(self, s, m):
        self.s, self.m = s, m
        self.ra = s["b"] * s["r"]
        self.rest = m.stress(s["pre"])
        area = self.ra**2 if s["kind"] == "dot" else s["r"] ** 2 - self.ra**2
        self.c0 = m.epsilon * math.pi * area * s["pre"] ** 2 / s["thickness"]

    def stretches(self, u):
        """of disc and annulus, and their slopes over u"""
        pre, b = self.s["pre"], self.s["b"]
        x = 1 + u / self.ra
        return pre * x, pre * (1 - b * x) / (1 - b), pre / self.ra, -pre * b / (1 - b) / self.ra

    def area(self, u):
        return 2 * math.pi * self.ra * self.s["thickness"] / (self.s["pre"] ** 2 * (1 + u / self.ra))

    def regions(self, u):
        disc, annulus, ddisc, dannulus = self.stretches(u)
        m = self.m
        return [(m.stress(disc) - self.rest, m.dstress(disc) * ddisc),
                (self.rest - m.stress(annulus), -m.dstress(annulus) * dannulus)]

    def force(self, u):
        disc, annulus, _, _ = self.stretches(u)
        h = self.s["thickness"]
        if self.s["kind"] == "dot":
            return self.area(u) * self.m.epsilon * disc**4 / h**2
        return -self.area(u) * self.m.epsilon * annulus**4 / h**2

    def capacitance(self, u):
        x = 1 + u / self.ra
        if self.s["kind"] == "dot":
            return self.c0 * x**4
        b, h, pre = self.s["b"], self.s["thickness"], self.s["pre"]
        if x.real <= 0:
            return math.nan  # a trial step too long is taken back
        log = cmath.log(x) if isinstance(x, complex) else math.log(x)

        def primitive(y, logarithm):  # of (1 - b y)^4/y
            return logarithm - 4 * b * y + 3 * b**2 * y**2 - 4 * b**3 * y**3 / 3 + b**4 * y**4 / 4

        factor = -4 * math.pi * self.ra**2 * self.m.epsilon * pre**2 / (h * (1 - b) ** 4)
        return self.c0 + factor * (primitive(x, log) - primitive(1.0, 0.0))


MODELS = {"lumped": Lumped, "lame": Lame, "coverage": Coverage}


def mass_of(s):
    def shape(a, f):
        bracket = f**4 * math.log(f / a) - f**2 * (f**2 - a**2) + (f**4 - a**4) / 4
        return 0.5 * math.pi * a * a, 2 * math.pi * a * a / (f * f - a * a) ** 2 * bracket

    ra = s["b"] * s["r"]
    film = s["density"] * s["thickness"] * sum(shape(ra / s["pre"], s["r"] / s["pre"]))
    disc, annulus = shape(ra, s["r"])
    return film + s["electrode"] * (disc if s["kind"] == "dot" else annulus)


# ---- waveform: segments (from, to, voltage(t), slope(t))

def line(t0, t1, u0, u1):
    rate = (u1 - u0) / (t1 - t0)
    return t0, t1, lambda t: u0 + rate * (t - t0), lambda t: rate


def points(pairs, until, period=NONE):
    """Straight lines, held before the first and after the last point; with a period its end is where they begin again."""
    length = period if given(period) else until
    corners, begin = [], 0.0
    while begin < until:
        one = [(0.0, pairs[0][1])] + list(pairs) + [(length, pairs[-1][1])]
        corners += [(begin + t, u) for t, u in one]
        begin += length
    segments = []
    for a, b in zip(corners, corners[1:]):
        if b[0] > a[0] and a[0] < until:
            whole = line(a[0], b[0], a[1], b[1])
            segments.append((whole[0], min(whole[1], until), whole[2], whole[3]))
    return segments


def step(on, off, voltage, rise, until):
    corners = [(0.0, 0.0), (on, 0.0), (on + rise, voltage)] + ([(off, voltage), (off + rise, 0.0)] if given(off) else [])
    corners.append((until, corners[-1][1]))
    return [line(a[0], b[0], a[1], b[1]) for a, b in zip(corners, corners[1:]) if b[0] > a[0]]


def sine(offset, amplitude, frequency, phase, delay, until):
    w = 2 * math.pi * frequency
    held = offset + amplitude * math.sin(phase)
    wave = (delay, until, lambda t: offset + amplitude * math.sin(w * (t - delay) + phase),
            lambda t: amplitude * w * math.cos(w * (t - delay) + phase))
    return ([line(0.0, delay, held, held)] if delay > 0 else []) + [wave]


# ---- the moving edge

class Edge:
    """State: p of each region and branch (the branch stress is share*T + p), then u, v, charge where they are states."""

    def __init__(self, s):
        self.s = s
        self.material = Material(s)
        self.model = MODELS[s["model"]](s, self.material)
        self.mass = mass_of(s)
        self.kelvin = s["kelvin"]
        self.branches = self.material.branches
        self.count = 2 * len(self.branches)
        self.series = given(s["rs"]) and s["rs"] > 0
        self.leak = 1 / s["rp"] if given(s["rp"]) else 0.0
        self.u_is_state = self.mass > 0 or self.kelvin > 0
        self.guess = 0.0

    def restoring(self, u, p):
        """Elastic and branch stresses times the area, dampers left out."""
        total = 0.0
        for k, (t, _) in enumerate(self.model.regions(u)):
            total += t
            for i, (share, _) in enumerate(self.branches):
                total += share * t + p[k * len(self.branches) + i]
        return self.model.area(u) * total

    def damping(self, u):
        return self.model.area(u) * self.kelvin * sum(slope for _, slope in self.model.regions(u))

    def film_voltage(self, u, source, charge):
        return charge / self.model.capacitance(u) if self.series else source

    def imbalance(self, u, p, source, charge):
        voltage = self.film_voltage(u, source, charge)
        return self.restoring(u, p) - self.model.force(u) * voltage * voltage

    def solve(self, f, u):
        last = math.inf
        for _ in range(50):
            change = f(u) / (f(u + 1j * STEP).imag / STEP)
            u -= change
            if abs(change) <= 1e-15 * abs(u) + 1e-15 * self.s["r"] or last <= 1e-12 * abs(u):  # the last step only polishes
                return u
            last = abs(change)
        raise RuntimeError("no equilibrium")

    def unpack(self, x, source):
        p = x[: self.count]
        rest = list(x[self.count :])
        charge = rest.pop() if self.series else None
        if self.u_is_state:
            u = rest[0]
        else:
            u = self.guess = self.solve(lambda a: self.imbalance(a, p, source, charge), self.guess)
        return p, u, rest[1] if self.mass > 0 else None, charge

    def p_slopes(self, u, p):
        slopes = []
        for k, (t, _) in enumerate(self.model.regions(u)):
            for i, (share, tau) in enumerate(self.branches):
                slopes.append(-(share * t + p[k * len(self.branches) + i]) / tau)
        return slopes

    def current(self, u, v, source, slope, charge):
        if self.series:
            return (source - self.film_voltage(u, source, charge)) / self.s["rs"]
        return self.model.capacitance(u) * slope + 2 * self.model.force(u) * v * source + self.leak * source

    def velocity(self, u, p, dp, source, slope, charge, dcharge):
        if self.kelvin > 0:
            return -self.imbalance(u, p, source, charge) / self.damping(u)
        h = 1j * STEP
        along = self.imbalance(u, [a + h * b for a, b in zip(p, dp)], source + h * slope, charge + h * dcharge if self.series else None)
        return -along.imag / self.imbalance(u + h, p, source, charge).imag

    def all(self, x, source, slope):
        """u, v, charge, current and the state's slope"""
        p, u, v, charge = self.unpack(x, source)
        dp = self.p_slopes(u, p)
        voltage = self.film_voltage(u, source, charge)
        dcharge = (source - voltage) / self.s["rs"] - voltage * self.leak if self.series else 0.0
        if self.mass > 0:
            acceleration = -(self.imbalance(u, p, source, charge) + self.damping(u) * v) / self.mass
            dx = dp + [v, acceleration]
        else:
            v = self.velocity(u, p, dp, source, slope, charge, dcharge)
            dx = dp + ([v] if self.u_is_state else [])
        q = charge if self.series else self.model.capacitance(u) * source
        return u, v, q, self.current(u, v, source, slope, charge), dx + ([dcharge] if self.series else [])

    def start(self):
        source = self.s["wave"][0][2](0.0)
        if not self.s["bias"]:
            return [0.0] * (self.count + (2 if self.mass > 0 else 1 if self.kelvin > 0 else 0) + self.series)
        return self.relaxed(source)

    def relaxed(self, source):
        voltage = source / (1 + self.s["rs"] * self.leak) if self.series else source
        long_term = lambda u: self.model.area(u) * sum(t for t, _ in self.model.regions(u)) - self.model.force(u) * voltage**2
        u = self.guess = self.solve(long_term, 0.0)
        p = [-share * t for t, _ in self.model.regions(u) for share, _ in self.branches]
        x = p + ([u, 0.0] if self.mass > 0 else [u] if self.kelvin > 0 else [])
        return x + ([self.model.capacitance(u) * voltage] if self.series else [])


def run(s, rtol, method="DOP853"):
    """Rows (time, u, v, charge, current) at the shown samples, largest |u|, |v|, |charge|, |current| over all samples, work."""
    edge = Edge(s)
    scales = tolerance_scales(edge)
    times = sorted({round(i) * s["every"] for i in s["show"]})
    x, work, rows, peak = list(edge.start()), 0.0, [], np.zeros(4)
    count = round(s["until"] / s["every"])
    grid = s["until"] * np.arange(count + 1) / count
    for t0, t1, voltage, slope in s["wave"]:
        cuts = [t0] + [t for t in times if t0 * (1 + 1e-12) < t < t1 * (1 - 1e-12)] + [t1]
        for a, b in zip(cuts, cuts[1:]):
            def slopes(t, y):
                u, v, q, i, dx = edge.all(y[:-1], voltage(t), slope(t))
                return dx + [voltage(t) * i]

            inside = grid[(grid > a * (1 + 1e-12)) & (grid <= b * (1 + 1e-12))]
            done = solve_ivp(slopes, (a, b), x + [work], method=method, rtol=rtol, atol=rtol * scales, dense_output=len(inside) > 0)
            assert done.success, done.message
            for t in inside:
                here = edge.all(list(done.sol(min(t, b))[:-1]), voltage(t), slope(t))
                peak = np.maximum(peak, np.abs(here[:4]))
            x, work = list(done.y[:-1, -1]), done.y[-1, -1]
            if any(abs(b - t) <= 1e-12 * t for t in times):  # what holds before an edge at this very time
                rows.append((b,) + edge.all(x, voltage(b), slope(b))[:4])
    return np.array(rows), peak, work


def tolerance_scales(edge):
    s = edge.s
    largest = max(abs(f(t)) for a, b, f, _ in s["wave"] for t in np.linspace(a, b, 50))
    model = edge.model
    k = model.area(0.0) * sum(slope for _, slope in model.regions(0.0))
    u = 0.1 * abs(model.force(0.0)) * largest**2 / k
    p = [abs(slope) * u * share for _, slope in model.regions(0.0) for share, _ in edge.branches]
    c = model.capacitance(0.0)
    scales = p + ([u, u * math.sqrt(k / edge.mass)] if edge.mass > 0 else [u] if edge.kelvin > 0 else [])
    return np.array(scales + ([0.1 * c * largest] if edge.series else []) + [c * largest**2])


# ---- frequency response: complex-step Jacobians of the implicit equations F(x, x', source) = 0

def response(s, bias, frequency):
    """Complex displacement per volt and input impedance about the relaxed equilibrium."""
    edge = Edge(s)
    x = edge.relaxed(bias)
    p = x[: edge.count]
    u = edge.guess if not edge.u_is_state else x[edge.count]
    voltage = bias / (1 + s["rs"] * edge.leak) if edge.series else bias
    n = edge.count + 2  # p, u, film voltage

    def residual(y, dy, d2u, source):
        q, a, film = list(y[: edge.count]), y[-2], y[-1]
        res = [dy[i] - e for i, e in enumerate(edge.p_slopes(a, q))]
        force = edge.mass * d2u + edge.restoring(a, q) + edge.damping(a) * dy[-2] - edge.model.force(a) * film * film
        displacement_current = edge.model.capacitance(a) * dy[-1] + 2 * edge.model.force(a) * dy[-2] * film
        current = displacement_current + edge.leak * film
        loop = source - film - (s["rs"] * current if edge.series else 0.0)
        return np.array(res + [force, loop, current])

    y0 = np.array(p + [u, voltage], dtype=complex)
    zero = np.zeros(n, dtype=complex)
    jw = 2j * math.pi * frequency
    matrix = np.zeros((n + 1, n), dtype=complex)
    for k in range(n):
        bump = zero.copy()
        bump[k] = 1j * STEP
        matrix[:, k] = residual(y0 + bump, zero, 0.0, bias).imag / STEP + jw * residual(y0, bump, 0.0, bias).imag / STEP
    matrix[edge.count, n - 2] += jw**2 * edge.mass
    right = residual(y0, zero, 0.0, bias + 1j * STEP).imag / STEP
    scale = np.abs(matrix[:n]).max(axis=1)  # rows of very different size
    answer = np.linalg.solve(matrix[:n] / scale[:, None], -right[:n] / scale)
    return answer[n - 2], 1.0 / (matrix[n] @ answer)


# ---- the scenes, the same ones as in tests/unit/test_references.c

PRONY = ((0.1, 0.03), (0.1, 0.3), (0.05, 3.0))
PROTOCOL = ((0.1, 0.001), (0.1, 0.3), (0.05, 3.0))  # the first ends the ring in some 100 ms


def scenes():
    ms = 1e-3
    shared = dict(
        lumped_dot_ringing=scene(density=1080.0, kelvin=2e-5, wave=step(1 * ms, 11 * ms, 4500.0, 1e-6, 0.02), until=0.02, every=1e-4,
                                 show=(11, 15, 40, 110, 113, 160, 200)),
        lumped_dot_protocol=scene(prony=PRONY, wave=step(5.0, 15.0, 4500.0, 1e-6, 25.0), until=25.0, every=0.01,
                                  show=(501, 502, 600, 800, 1500, 1501, 1600, 2500)),
        lumped_dot_jump=scene(kelvin=0.05, rp=1e10, wave=step(0.3, 0.7, 3000.0, 0.0, 1.0), until=1.0, every=0.1,
                              show=(3, 4, 7, 8, 10)),
        lumped_lens_quasistatic=scene(kind="lens", b=0.4, pre=1.1, slope=-0.28, permittivity=2.76, modulus=1.2e6,
                                      wave=sine(2000.0, 1500.0, 2.0, 0.5, 0.1, 1.0), until=1.0, every=0.01, show=(5, 15, 33, 57, 100)),
        lame_dot_instantaneous=scene(model="lame", b=0.25, pre=1.1, density=1080.0, electrode=0.025, kelvin=5e-5, instantaneous=True,
                                     prony=((0.2, 0.002), (0.1, 0.05)), wave=step(1 * ms, 21 * ms, 3500.0, 1e-4, 0.04), until=0.04,
                                     every=1e-4, show=(12, 15, 20, 60, 210, 213, 300, 400)),
        lame_lens_points=scene(model="lame", kind="lens", b=0.4, density=1000.0, electrode=0.02, prony=((0.3, 0.004),),
                               wave=points(((2 * ms, 0.0), (5 * ms, 4000.0), (12 * ms, 2000.0), (12.5 * ms, 3000.0)), 0.025),
                               until=0.025, every=1e-4, show=(30, 50, 80, 122, 160, 250)),
        coverage_dot_sine=scene(model="coverage", b=0.6, density=1080.0, kelvin=3e-5, prony=((0.2, 0.01),),
                                wave=sine(2500.0, 1500.0, 310.0, 0.0, 1 * ms, 0.02), bias=True, until=0.02, every=1e-4,
                                show=(10, 16, 40, 90, 155, 200)),
        coverage_lens_ringing=scene(model="coverage", kind="lens", pre=1.3, density=1000.0, electrode=0.025, kelvin=2e-5,
                                    prony=((0.1, 0.003), (0.2, 0.1)), wave=step(1 * ms, NONE, 4500.0, 1e-6, 0.02), until=0.02,
                                    every=1e-4, show=(11, 15, 30, 80, 200)),
        lumped_dot_port=scene(density=1080.0, kelvin=2e-5, rs=1e6, rp=1e11, wave=step(1 * ms, 11 * ms, 4500.0, 1e-6, 0.02),
                              until=0.02, every=1e-4, show=(11, 15, 40, 110, 113, 160, 200)),
        lame_lens_leaky=scene(model="lame", kind="lens", b=0.7, kelvin=2 * ms, rs=2e6, rp=1e8,
                              wave=step(0.0, 20 * ms, 4000.0, 1 * ms, 0.04), until=0.04, every=1e-4,
                              show=(1, 5, 30, 200, 205, 260, 400)),
        coverage_dot_creeping_port=scene(model="coverage", b=0.3, prony=((0.2, 0.05), (0.15, 0.5)), rs=5e7, rp=2e9,
                                         wave=sine(2000.0, 1500.0, 10.0, 0.3, 0.05, 0.5), bias=True, until=0.5, every=1e-3,
                                         show=(50, 70, 113, 260, 500)),
        coverage_lens_port=scene(model="coverage", kind="lens", b=0.5, pre=1.1, density=1080.0, electrode=0.025, kelvin=1e-4, rs=1e6,
                                 prony=((0.15, 0.02),), wave=step(1 * ms, 11 * ms, 4000.0, 1e-5, 0.02), until=0.02, every=1e-4,
                                 show=(11, 15, 40, 110, 113, 160, 200)),
        coverage_dot_leakage=scene(model="coverage", b=0.5, pre=1.3, density=1080.0, kelvin=5e-5, rp=1e9,
                                   wave=sine(1500.0, 1000.0, 120.0, 0.0, 0.0, 0.03), bias=True, until=0.03, every=1e-4,
                                   show=(7, 31, 100, 205, 300)),
        coverage_dot_pulses=scene(model="coverage", b=0.75, pre=1.2, kelvin=0.02, prony=((0.25, 0.2),),
                                  wave=points(((0.0, 0.0), (0.05, 4000.0), (0.2, 4000.0), (0.21, 0.0)), 1.0, 0.4),
                                  until=1.0, every=0.01, show=(3, 20, 21, 40, 45, 61, 85, 100)),
        lame_dot_port=scene(model="lame", b=0.6, density=1080.0, prony=PRONY, kelvin=1e-5, rs=3e5,
                            wave=points(((0.0, 3000.0), (5 * ms, 3000.0), (5.5 * ms, 4200.0)), 0.02), bias=True, until=0.02,
                            every=1e-4, show=(20, 52, 60, 100, 200)),
        lame_dot_from_rest=scene(model="lame", b=0.4, pre=1.3, density=1080.0, kelvin=5e-5, rs=4e5, rp=1e10,
                                 wave=sine(3000.0, 800.0, 150.0, 0.7, 0.0, 0.02), until=0.02, every=1e-4,
                                 show=(1, 4, 12, 70, 200)),
        coverage_lens_from_rest=scene(model="coverage", kind="lens", b=0.6, prony=((0.3, 0.02), (0.1, 0.2)), rp=1e9,
                                      wave=points(((0.1, 3500.0), (0.2, 1000.0)), 0.4), until=0.4, every=1e-3,
                                      show=(1, 30, 100, 150, 200, 400)),
    )
    return shared


FREQUENCIES = (1.0, 10.0, 100.0, 1000.0, 10000.0)
BIAS = 3000.0


def c_row(values):
    return "{" + ", ".join(f"{v:.17g}" for v in values) + "}"


def references():
    print("/* Reference values of the scenes of test_references.c; made by tests/peers/transient_scipy.py references. */")
    print("#ifndef DEA_TEST_REFERENCES_H\n#define DEA_TEST_REFERENCES_H\n")
    print("enum { REFERENCE_ROWS = 8, REFERENCE_FREQUENCIES = 5 };\n")
    print("/* u [m], v [m/s], charge [C], current [A] at a sample; peaks over all samples; error: of the values, relative to the peaks;")
    print(" * work: of the source over the run [J]. */")
    print("typedef struct known_row {\n    size_t sample;\n    double values[4];\n} known_row;\n")
    print("typedef struct known_run {\n    const char *name;\n    double peak[4];\n    double error;\n    double work;")
    print("    size_t count;\n    known_row rows[REFERENCE_ROWS];\n} known_run;\n")
    print("static const known_run references[] = {")
    for name, s in scenes().items():
        rows, peak, work = run(s, 1e-13)
        coarse, _, _ = run(s, 1e-11)
        error = np.max(np.abs(rows - coarse)[:, 1:] / peak)
        sys.stderr.write(f"{name}: mass {mass_of(s):.6g}, change from rtol 1e-11 {error:.1e}\n")
        print(f'    {{"{name}", {c_row(peak)}, {error + 1e-14:.1e}, {work:.17g}, {len(s["show"])}, {{')
        for sample, row in zip(s["show"], rows):
            print(f"        {{{sample}, {c_row(row[1:])}}},")
        print("    }},")
    print("};\n")
    print("/* Complex displacement per volt [m/V] and input impedance [Ohm] under a bias of 3000 V. */")
    print("typedef struct known_response {\n    const char *name;\n    double rows[REFERENCE_FREQUENCIES][4];\n} known_response;\n")
    print("static const known_response reference_responses[] = {")
    for name, s in scenes().items():
        print(f'    {{"{name}", {{')
        for f in FREQUENCIES:
            a, z = response(s, BIAS, f)
            print(f"        {c_row((a.real, a.imag, z.real, z.imag))},")
        print("    }},")
    print("};\n\n#endif")


# ---- the protocol of 25 s for the benchmark, as a user of SciPy writes it

def protocol_matrix():
    edge = Edge(scene(density=1080.0, prony=PROTOCOL))
    k = sum(edge.model.stiffness)
    a = np.zeros((5, 5))  # u, v, branch forces
    a[0, 1] = 1.0
    a[1] = [-k / edge.mass, 0.0] + [-1.0 / edge.mass] * 3
    for i, (share, tau) in enumerate(edge.branches):
        a[2 + i, 1], a[2 + i, 2 + i] = share * k, -1.0 / tau
    return a, np.array([0.0, edge.model.f / edge.mass, 0.0, 0.0, 0.0]), k


def protocol_exact(a, b):
    """u at the 2501 samples: matrix exponentials of the intervals, force (U0 + c t)^2 b by three states more."""
    n = len(a)

    def flow(duration, u0, rate):
        big = np.zeros((n + 3, n + 3))
        big[:n, :n] = a
        big[:n, n:] = np.outer(b, [1.0, 0.0, 0.0])
        big[n, n + 1], big[n + 1, n + 2] = 1.0, 2.0  # f' = g, g' = 2 h for f = U^2
        whole = expm(big * duration)
        return whole[:n, :n], whole[:n, n:] @ np.array([u0 * u0, 2 * u0 * rate, rate * rate])

    rise, every, volts = 1e-6, 0.01, 4500.0
    free, hold = flow(every, 0.0, 0.0), flow(every, volts, 0.0)
    up = [flow(rise, 0.0, volts / rise), flow(every - rise, volts, 0.0)]
    down = [flow(rise, volts, -volts / rise), flow(every - rise, 0.0, 0.0)]
    x, samples = np.zeros(n), [0.0]
    for i in range(2500):
        for matrix, push in up if i == 500 else down if i == 1500 else [hold] if 500 < i < 1500 else [free]:
            x = matrix @ x + push
        samples.append(x[0])
    return np.array(samples)


def protocol(method, tolerances):
    a, b, k = protocol_matrix()
    exact = protocol_exact(a, b)
    peak = np.max(np.abs(exact))
    grid = np.linspace(0.0, 25.0, 2501)
    corners = [0.0, 5.0, 5.000001, 15.0, 15.000001, 25.0]
    levels = [0.0, 0.0, 4500.0, 4500.0, 0.0, 0.0]
    scale = np.array([peak, peak * math.sqrt(k / 1e-4)] + [k * peak * c for c, _ in Edge(scene(prony=PROTOCOL)).branches])
    for rtol in tolerances:
        spent = []
        while len(spent) < 3 and sum(spent) < 3:  # what takes seconds is timed once
            begin = time.perf_counter()
            x, got = np.zeros(5), [0.0]
            for t0, t1, u0, u1 in zip(corners, corners[1:], levels, levels[1:]):
                inside = grid[(grid > t0) & (grid <= t1)]
                rate = (u1 - u0) / (t1 - t0)
                options = dict(jac=lambda t, y: a) if method in ("Radau", "BDF", "LSODA") else {}
                done = solve_ivp(lambda t, y: a @ y + b * (u0 + rate * (t - t0)) ** 2, (t0, t1), x, method=method, rtol=rtol,
                                 atol=rtol * scale, t_eval=np.union1d(inside, [t1]), **options)
                x = done.y[:, -1]
                got += list(done.y[0, : len(inside)])
            spent.append(time.perf_counter() - begin)
        error = np.max(np.abs(np.array(got) - exact)) / peak
        print(f"{method},{rtol:g},{1e3 * statistics.median(spent):.6g},{error:.3g}", flush=True)


if __name__ == "__main__":
    if sys.argv[1:2] == ["references"]:
        references()
    elif sys.argv[1:2] == ["protocol"] and len(sys.argv) > 3:
        protocol(sys.argv[2], [float(text) for text in sys.argv[3:]])
    else:
        sys.exit(__doc__)
