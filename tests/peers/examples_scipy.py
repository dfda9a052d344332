"""Reference numbers of the moving examples by transient_scipy.py, for tests/unit/test_moving_examples.c.

examples_scipy.py   prints example,case,quantity,value
"""
import math

import numpy as np
from scipy.optimize import brentq

from transient_scipy import NONE, response, run, scene, sine, step

SILICONE = dict(yeoh=(178426.0, -6023.0, 4234.0), permittivity=2.8)
SHARES = (26.06, 26.53, 10.83)
VHB_SUM = 15.36 + sum(SHARES)
VHB = dict(yeoh=(7680.0, 0.0, 0.0), permittivity=4.8,
           prony=tuple((g / VHB_SUM, tau) for g, tau in zip(SHARES, (0.6074, 6.56, 61.25))))


def tell(example, case, quantity, value):
    print(f"{example},{case},{quantity},{value:.12g}")


def mean(s, start, end):
    """Time average of the strain, by the trapezoidal rule over the samples as the program takes it."""
    radius = s["r"] * s["b"]
    first, last = round(start / s["every"]), round(end / s["every"])
    rows, _, _ = run(dict(s, show=list(range(first, last + 1))), 1e-11)
    return np.trapz(rows[:, 1], rows[:, 0]) / (end - start) / radius


def focal_length(at_rest, index, radius, strain):
    """Cap of the volume at rest over another aperture."""
    volume = lambda h, a: math.pi * h * (3 * a * a + h * h) / 6
    curvature = at_rest * (index - 1)
    rest = curvature - math.sqrt(curvature**2 - radius**2)
    a = radius * (1 + strain)
    h = brentq(lambda h: volume(h, a) - volume(rest, radius), 0.0, 10 * a, xtol=1e-18, rtol=1e-15)
    return (a * a + h * h) / (2 * h) / (index - 1)


def main():
    for b in (0.2, 0.5, 0.8):
        # the samples of the window see nothing of the ring: its Kelvin-Voigt damping ends it in 30 ms, so mass and damper are left out
        s = scene(b=b, prony=((0.08, 0.2), (0.05, 2.0), (0.03, 20.0)), wave=step(5.0, 15.0, 4500.0, 1e-6, 25.0), until=25.0, every=0.01,
                  **SILICONE)
        tell("protocol", f"{b}", "mean strain", mean(s, 6.0, 8.0))
    for model in ("lumped", "coverage"):
        s = scene(model=model, r=0.05, b=0.25, thickness=1e-3, pre=3.0, wave=step(0.0, NONE, 3000.0, 1e-6, 600.0), until=600.0,
                  every=0.5, show=(2, 20, 200, 1200), **VHB)
        rows, _, _ = run(s, 1e-11)
        for t, u in rows[:, :2]:
            tell("vhb-creep", f"{model} {t:g} s", "strain", u / 0.0125)
    s = scene(kind="lens", model="coverage", r=2.5e-3, b=0.4, thickness=3e-5, density=1080.0, kelvin=1.5e-5,
              wave=step(1e-4, NONE, 1560.0, 1e-6, 6e-4), until=6e-4, every=1e-6, show=(130, 160, 234, 600), **SILICONE)
    rows, _, _ = run(s, 1e-11)
    for t, u in rows[:, :2]:
        tell("fast-lens", f"{t * 1e6:g} us", "strain", u / 1e-3)
        tell("fast-lens", f"{t * 1e6:g} us", "focal length", focal_length(0.01, 1.4, 1e-3, u / 1e-3))
    s = scene(model="coverage", rs=1e7, prony=((0.1, 0.1),), wave=sine(1500.0, 1000.0, 20.0, 0.0, 0.0, 0.5), until=0.5, every=5e-4,
              show=(10, 100, 530, 1000), **SILICONE)
    rows, _, _ = run(s, 1e-11)
    for t, u, _, charge, current in rows:
        for quantity, value in (("strain", u / 0.015), ("charge", charge), ("current", current)):
            tell("sine-supply", f"{t * 1e3:g} ms", quantity, value)
    for volts in (1000.0, 2000.0, 3000.0):
        s = scene(kind="lens", r=0.012, b=5.0 / 12.0, thickness=5e-5, prony=((0.1, 0.05), (0.05, 0.5)),
                  wave=step(0.5, 1.5, volts, 1e-3, 3.0), until=3.0, every=5e-3, show=(300,), **SILICONE)
        rows, _, _ = run(s, 1e-11)
        strain = rows[0, 1] / 0.005
        tell("lens-optics", f"{volts:g} V", "mean strain", mean(s, 1.0, 1.5))
        tell("lens-optics", f"{volts:g} V", "focal length at 1.5 s", focal_length(0.022, 1.4, 0.005, strain))
    s = scene(model="lame", density=1080.0, kelvin=1e-5, prony=((0.05, 1e-3), (0.05, 0.05)), rs=1e5, **SILICONE)
    for k in (0, 200, 286, 400):
        frequency = 10.0 ** (k / 100.0)
        u, z = response(s, 3000.0, frequency)
        for quantity, value in (("displacement", u), ("impedance", z)):
            tell("resonance", f"row {k}", quantity, abs(value))
            tell("resonance", f"row {k}", quantity + " phase", math.degrees(math.atan2(value.imag, value.real)))


main()
