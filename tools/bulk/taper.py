# SPDX-License-Identifier: Apache-2.0
"""How steep a wedge is that grows before a wall."""
import math

from . import frames, shear
from .rows import Row, by_seed, with_settings
from .sweep import Sweep, each, jobs_of

TITLE = "C7 taper"
LENGTH, PUSHED, SETTLED, TICK = 260, 70, 20, 1 / math.sqrt(9.81)
BESIDE = ("shear",)     # the case that says which friction angle the grains have

SCATTERED = 0.3         # the base on which seeds differ most
jobs = jobs_of("taper", Sweep(("impulse",), each("base", *(base for base in shear.BASES if base != SCATTERED))),
               Sweep(("impulse",), each("base", SCATTERED), times=3))


def critical(inner, base):
    """Slope of a cohesionless wedge on a level base, friction angles in degrees: Dahlen (1984), eq. 9 and 17."""
    phi, phi_b = math.radians(inner), math.radians(min(base, inner))
    psi_b = 0.5 * math.asin(math.sin(phi_b) / math.sin(phi)) - 0.5 * phi_b
    low, high = 0.0, phi
    while high - low > 1e-9:
        a = 0.5 * (low + high)
        beyond = a + 0.5 * math.asin(math.sin(a) / math.sin(phi)) - 0.5 * a > psi_b
        low, high = (low, a) if beyond else (a, high)
    return math.degrees(low)


def measure(folder, summary, settings):
    """The wedge begins where the surface is a diameter above the layer for good."""
    wall, level = LENGTH - PUSHED, frames.tops(frames.at(folder, summary, SETTLED * TICK), 1)
    layer = sum(level[i] for i in range(5, LENGTH - 20)) / (LENGTH - 25)
    surface = frames.rising_surface(frames.last(folder), wall, layer + 1)
    return {"slope": frames.slope(surface), "length": wall - surface[0][0]}


def rows(results):
    own = {j: r for j, r in results.items() if j.case == "taper"}
    if not own:
        return
    inner = shear.grains({j: r for j, r in results.items() if j.case == "shear"})
    slopes = {base: by_seed(with_settings(own, base=base), lambda r: r["slope"]) for base in shear.BASES}
    for base, values_of in slopes.items():
        answer = critical(inner, math.degrees(math.atan(base)))
        row = Row(f"slope on a base of friction {base:g} [°]", f"{answer:.1f}: Dahlen (1984), inner friction as sheared", "± 3°")
        for key, values in values_of.items():
            row.add(key, values, answer - 3, answer + 3)
        yield row
    row = Row("rise of the slope with the base's friction, the lesser [°]", "rises: Dahlen (1984)", "> 0")
    for key in slopes[shear.BASES[0]]:
        means = [sum(values_of[key]) / len(values_of[key]) for values_of in slopes.values()]
        row.add(key, [min(b - a for a, b in zip(means, means[1:]))], 1e-9, 90)
    yield row


CAUSES = []
