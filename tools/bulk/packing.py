# SPDX-License-Identifier: Apache-2.0
"""How dense spheres lie that have settled, and how many others each touches."""
import math

from . import frames
from .rows import Row, by_seed, row_of, with_settings
from .sweep import SOFT_STEP, Sweep, jobs_of

TITLE = "C8 packing"
WIDTH = 15      # of the box, diameters
MARGIN = 3      # to walls, floor and surface that is left out, diameters
TOUCH = 3e-4    # gap of a contact, at most, diameters
TICKS = {0: 80, 0.5: 40, 10: 40}  # by friction: smooth spheres take longer to settle
COARSE = (("step", 0.01),)  # twice the scene's: small ones, for small overlaps, take long
RUNS = tuple((("friction", mu), ("ticks", ticks)) for mu, ticks in TICKS.items())
jobs = jobs_of("packing", Sweep(("impulse",), RUNS), Sweep(("bullet",), RUNS[1:2]), Sweep(("bullet",), RUNS[:1], seeds=1),
               Sweep(("soft_sphere",), RUNS[:2]), Sweep(("bullet64", "ode"), RUNS[1:2], seeds=1),
               steps={"bullet": COARSE, "bullet64": COARSE, "ode": COARSE, **SOFT_STEP})


def inner(spheres):
    """The box that counts: lower and upper corner."""
    surface = sorted(s.z for s in spheres)[int(0.98 * len(spheres))]
    return (MARGIN, MARGIN, MARGIN), (WIDTH - MARGIN, WIDTH - MARGIN, surface - MARGIN)


def solid_fraction(spheres, low, high, pitch=0.08):
    """Share of a box inside the union of the spheres: along upright lines, so overlaps count once."""
    chords = {}
    for s in spheres:
        for i in range(math.ceil((s.x - s.radius) / pitch), math.floor((s.x + s.radius) / pitch) + 1):
            reach = math.sqrt(max(s.radius**2 - (i * pitch - s.x) ** 2, 0))
            for j in range(math.ceil((s.y - reach) / pitch), math.floor((s.y + reach) / pitch) + 1):
                half = math.sqrt(max(reach**2 - (j * pitch - s.y) ** 2, 0))
                chords.setdefault((i, j), []).append((s.z - half, s.z + half))
    shares = [covered(sorted(own), low[2], high[2]) for (i, j), own in chords.items()
              if low[0] <= i * pitch <= high[0] and low[1] <= j * pitch <= high[1]]
    return sum(shares) / len(shares)


def covered(intervals, low, high):
    """Share of [low, high] that is in some interval; they are in order."""
    at, sum_ = low, 0.0
    for begin, end in intervals:
        begin, end = max(begin, at), min(end, high)
        if end > begin:
            sum_ += end - begin
            at = end
    return sum_ / (high - low)


def neighbours(spheres, touch):
    """For each sphere, by its place in the list, those that it touches."""
    cells = {}
    for n, s in enumerate(spheres):
        cells.setdefault((math.floor(s.x / 1.15), math.floor(s.y / 1.15), math.floor(s.z / 1.15)), []).append(n)
    out = [set() for _ in spheres]
    for (i, j, k), own in cells.items():
        near = [m for a in (-1, 0, 1) for b in (-1, 0, 1) for c in (-1, 0, 1) for m in cells.get((i + a, j + b, k + c), ())]
        for n in own:
            p = spheres[n]
            out[n].update(m for m in near if m != n and reaches(p, spheres[m], touch))
    return out


def reaches(p, q, touch):
    return (p.x - q.x) ** 2 + (p.y - q.y) ** 2 + (p.z - q.z) ** 2 <= (p.radius + q.radius + touch) ** 2


def without_rattlers(touching, walled, least):
    """Drops, again and again, spheres that fewer than `least` others hold; a wall counts as enough."""
    loose = [n for n, own in enumerate(touching) if len(own) < least and not walled[n]]
    gone = set()
    while loose:
        n = loose.pop()
        if n in gone:
            continue
        gone.add(n)
        for m in touching[n]:
            touching[m].discard(n)
            if m not in gone and len(touching[m]) < least and not walled[m]:
                loose.append(m)
    return gone


def contacts_each(spheres, low, high, touch, least):
    """Mean of the inner spheres that are held."""
    touching = neighbours(spheres, touch)
    walled = [min(s.x, s.y, WIDTH - s.x, WIDTH - s.y, s.z) < s.radius + touch for s in spheres]
    gone = without_rattlers(touching, walled, least)
    inside = [n for n, s in enumerate(spheres) if n not in gone and
              all(a <= v <= b for a, v, b in zip(low, (s.x, s.y, s.z), high))]
    return sum(len(touching[n]) for n in inside) / len(inside)


def measure(folder, summary, settings):
    spheres = frames.last(folder)
    low, high = inner(spheres)
    least = 4 if settings["friction"] == 0 else 2
    return {"solid": solid_fraction(spheres, low, high), "contacts": contacts_each(spheres, low, high, TOUCH, least),
            "overlap": summary["overlap"]["mean"]}


ANSWERS = {
    0: ("0.639: O'Hern et al. (2003), Agnolin & Roux (2007)", 0.639, 0.639, "6: isostatic", 6, 6),
    0.5: ("0.58 to 0.61 poured", 0.58, 0.61, "4 to 6", 4, 6),
    10: ("0.55 to 0.60: Silbert (2010)", 0.55, 0.60, "4: isostatic", 4, 4),
}


def rows(results):
    for friction, (solid, s_low, s_high, contacts, c_low, c_high) in ANSWERS.items():
        own = with_settings(results, friction=friction)
        row = Row(f"solid fraction, mu = {friction:g}", solid, "± 0.02, springs 0.01")
        for key, values in by_seed(own, lambda r: r["solid"]).items():
            slack = 0.01 if key[0] == "soft_sphere" else 0.02
            row.add(key, values, s_low - slack, s_high + slack)
        yield row
        yield row_of(f"contacts per sphere, mu = {friction:g}", contacts, "± 0.3", own, lambda r: r["contacts"], c_low - 0.3,
                     c_high + 0.3)


CAUSES = [("contacts per sphere, mu = 10", "", "", 0.18, "4 is the least that can carry; poured packings with friction keep more, Silbert et al. (2002), "
           "Phys. Rev. E 65, 031304")]
