# SPDX-License-Identifier: Apache-2.0
"""How fast a silo runs out through a slot, and how that grows with the slot."""
import math

from . import frames
from .rows import HOW, Row, by_seed, with_settings
from .runs import Job

TITLE = "C3 slot"
SLOTS = (6, 8, 10)
DEPTH, SETTLED, TICK = 4, 30, 1 / math.sqrt(9.81)
BEGIN, WINDOW = 4, 4       # ticks after the flap goes; from when, and for how long the rate is measured
EMPTY_ANNULUS = 1.4        # k


def jobs(seeds):
    for how in HOW:
        for slot in SLOTS:
            for seed in range(1, seeds + 1):
                yield Job("slot", "impulse", how, seed, (("slot", slot), ("flowing", BEGIN + 2 * WINDOW + 1)))


def measure(folder, summary, settings):
    """Rates are volumes per tick and diameter of depth, in two windows; also the solid fraction of the fill."""
    passed, solid = [], 0
    for step, path in frames.paths(folder):
        ticks = step * summary["dt"] / TICK - SETTLED
        if ticks < BEGIN - 0.1:
            continue
        spheres = frames.read(path)
        solid = solid or fill_fraction(spheres)
        passed.append((ticks, sum(s.volume for s in spheres if s.z < -1) / DEPTH))
    early = [p for p in passed if BEGIN <= p[0] <= BEGIN + WINDOW + 0.1]
    late = [p for p in passed if BEGIN + WINDOW <= p[0] + 0.1 and p[0] <= BEGIN + 2 * WINDOW + 0.1]
    return {"early": frames.line(early)[0], "late": frames.line(late)[0], "solid": solid}


def fill_fraction(spheres, low=3, high=15):
    """Of a part of the fill beside the slot."""
    inside = [s for s in spheres if low <= s.z <= high and s.x < 12]
    return sum(s.volume for s in inside) / (12 * DEPTH * (high - low))


def mean_rate(result):
    return 0.5 * (result["early"] + result["late"])


def rows(results):
    rates = {slot: by_seed(with_settings(results, slot=slot), mean_rate) for slot in SLOTS}
    solids = {slot: by_seed(with_settings(results, slot=slot), lambda r: r["solid"]) for slot in SLOTS}
    row = Row("exponent of the rate against slot - 1.4 d", "3/2: Beverloo et al. (1961), Choi et al. (2005)", "± 0.25")
    factor = Row("C of C phi sqrt(g) (slot - 1.4 d)^(3/2)", "1.03: Nedderman (1992)", "")
    for key in rates[SLOTS[0]]:
        fits = [frames.line([(math.log(s - EMPTY_ANNULUS), math.log(rates[s][key][n])) for s in SLOTS])[0]
                for n in range(len(rates[SLOTS[0]][key]))]
        row.add(key, fits, 1.25, 1.75)
        factor.add(key, [sum(rates[s][key][n] / solids[s][key][n] / (s - EMPTY_ANNULUS) ** 1.5 for s in SLOTS) / len(SLOTS)
                         for n in range(len(fits))], 0, 9)
    yield row
    yield factor
    steady = Row("what passes later / earlier, all slots together", "1: not the fill decides", "± 0.03")
    late, early = (by_slots(results, window) for window in ("late", "early"))
    for key in late:
        steady.add(key, [a / b for a, b in zip(late[key], early[key])], 0.97, 1.03)
    yield steady


def by_slots(results, window):
    """Rates of all slots added up, by seed."""
    own = [by_seed(with_settings(results, slot=slot), lambda r: r[window]) for slot in SLOTS]
    return {key: [sum(each) for each in zip(*(o[key] for o in own))] for key in own[0]}


CAUSES = []
