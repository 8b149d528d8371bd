# SPDX-License-Identifier: Apache-2.0
"""Whether a wedge that is pushed keeps its slope."""
import math

from . import frames
from .rows import row_of, with_settings
from .sweep import Sweep, each, jobs_of

TITLE = "C7 wedge"
LENGTH, PUSHED, SETTLED, TICK = 80, 4, 40, 1 / math.sqrt(9.81)  # as in the scene: diameters; when the wall begins, in ticks

BASES = each("rough", 0, 1)
jobs = jobs_of("wedge", Sweep(("impulse", "soft_sphere"), BASES), Sweep(("bullet", "bullet64", "ode"), BASES, seeds=1))


def slope(spheres, wall):
    """Of the surface, from where it is two diameters high."""
    return frames.slope(frames.rising_surface(spheres, wall, 2))


def measure(folder, summary, settings):
    start, end = frames.at(folder, summary, SETTLED * TICK), frames.last(folder)
    moved = sum(s.x for s in start) / len(start) - sum(s.x for s in end) / len(end)
    return {"before": slope(start, LENGTH), "after": slope(end, LENGTH - PUSHED), "moved": moved}


def gained(result):
    return result["after"] - result["before"]


def rows(results):
    flat, rough = (with_settings(results, rough=n) for n in (0, 1))
    yield row_of("slope before [°]", "", "", flat, lambda r: r["before"], 0, 90)
    yield row_of(f"slope gained in {PUSHED} diameters [°]", "0: Buiter et al. (2016)", "± 1°", flat, gained, -1, 1)
    yield row_of("way of its middle / way of the wall", "1: it slides as a whole", "", flat, lambda r: r["moved"] / PUSHED, 0, 2)
    yield row_of("slope gained on a rough base [°]", "rises with the base's friction: Dahlen (1984)", "> 1°", rough, gained, 1, 90)


CAUSES = []
