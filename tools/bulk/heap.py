# SPDX-License-Identifier: Apache-2.0
"""How steep a heap is, on both sides, and whether it stays so."""
from . import frames
from .rows import Row, by_seed, row_of, with_settings
from .sweep import Sweep, jobs_of

TITLE = "C4 heap"
D = 0.01
ZHOU = "Zhou et al. (2002), glass beads: 27.4°"


WATCHED = (("friction", 0.4), ("rest", 10))
RESTS = (("friction", 0.4), ("rest", 0))  # ends as soon as it rests: the angle alone
ROLLS = (("friction", 0.4), ("rolling", 0.05), ("rest", 0))
FRICTIONS = tuple((("friction", mu), ("rest", 0)) for mu in (0, 0.2, 0.8))
jobs = jobs_of("heap", Sweep(("impulse",), (WATCHED, *FRICTIONS)), Sweep(("bullet",), (WATCHED, FRICTIONS[0])), Sweep(("bullet64",), (RESTS,)),
               Sweep(("soft_sphere",), (RESTS, ROLLS)), Sweep(("ode",), (WATCHED,)))


def slopes(spheres):
    """Of both flanks, from 3 diameters beside the middle to 2 before the edges of the plate [degrees]."""
    top = frames.tops([s for s in spheres if s.z > 0], D)
    sides = ([(i + 0.5, top.get(i, 0) / D) for i in range(-13, -3)], [(i + 0.5, top.get(i, 0) / D) for i in range(3, 13)])
    left, right = (frames.slope(points) for points in sides)
    return left, -right


def measure(folder, summary, settings):
    left, right = slopes(frames.last(folder))
    before = sum(slopes(frames.at(folder, summary, summary["time"] - settings["rest"]))) / 2
    return {"angle": (left + right) / 2, "sides": abs(left - right), "lost": before - (left + right) / 2}


def angle(result):
    return result["angle"]


def rising(results):
    """Least rise of the mean angle from one friction to the next."""
    row = Row("rise from mu = 0.2 to 0.4, and to 0.8, the lesser [°]", "rises with friction", "> 0")
    of = [by_seed(with_settings(results, friction=f, rolling=0), angle) for f in (0.2, 0.4, 0.8)]
    for key in of[0].keys() & of[2].keys():
        means = [sum(o[key]) / len(o[key]) for o in of]
        row.add(key, [min(b - a for a, b in zip(means, means[1:]))], 1e-9, 90)
    return row


def rows(results):
    rolling, plain = (with_settings(results, friction=0.4, rolling=r) for r in (0.05, 0))
    yield row_of("angle, mu = 0.4, rolling friction 0.05 [°]", ZHOU, "± 4°", rolling, angle, 23.4, 31.4)
    yield row_of("angle, mu = 0.4, none [°]", ZHOU, "± 4°", plain, angle, 23.4, 31.4)
    for friction in (0, 0.2, 0.8):
        ends = (-1, 1) if friction == 0 else (0, 90)
        answer, tolerance = ("0", "± 1°") if friction == 0 else ("", "")
        own = with_settings(results, friction=friction, rolling=0)
        yield row_of(f"angle, mu = {friction:g} [°]", answer, tolerance, own, angle, *ends)
    yield rising(results)
    watched = {j: r for j, r in plain.items() if dict(j.settings)["rest"]}
    yield row_of("sides apart, mu = 0.4 [°]", "a heap is even", "4°", plain, lambda r: r["sides"], -90, 4)
    yield row_of("lost in 10 s at rest [°]", "a heap rests", "3°", watched, lambda r: r["lost"], -90, 3)


CREEPS = ("its solver starts every step from nothing, so what 10 iterations do not reach slips: with 40 the heap has 20.4° and loses 5.8°, with 4 substeps of 10 19.9° and 3.6° "
          "(whole, one seed)")
CAUSES = [
    ("angle, mu = 0.4, none", "ode", "", 12, CREEPS),
    ("lost in", "ode", "", 7.5, CREEPS),
    ("angle, mu = 0 ", "bullet", "whole", 0.9, "level but for a quarter of a sphere over the ten diameters of a flank: its highest spheres make the angle"),
]
