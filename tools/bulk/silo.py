# SPDX-License-Identifier: Apache-2.0
"""What the floor of a silo carries, and what the walls do."""
import math

from . import frames
from .rows import Row, row_of, twins
from .sweep import Sweep, jobs_of

TITLE = "C2 silo"
WIDTH, WALL_FRICTION = 10, 0.5
FILLS = (1, 2, 4)
BETWEEN = (0.25, 0.75)  # how far the floor has sunk, diameters

# Two runs each: what the floor does between two depths is the difference of its work.
RUNS = tuple((("fill", fill), ("sunk", sunk)) for fill in FILLS for sunk in BETWEEN)
# What walls carry leaks at the cuts of these engines: their default of 0.85 leaves 0.32 of a fill of 4 widths to the floor.
BULLETS = ("bullet", "bullet64")
HOLDING = tuple((*run, ("run.coupling_leak", 0.99)) for run in RUNS)
jobs = jobs_of("silo", Sweep(("impulse",), RUNS), Sweep(("soft_sphere", "ode"), RUNS, seeds=1),
               Sweep(BULLETS, RUNS, seeds=1, ways=("whole",)), Sweep(BULLETS, HOLDING, ways=("cut",)))


def measure(folder, summary, settings):
    spheres = frames.last(folder)
    weight = frames.weight(spheres)
    top = sum(sorted(s.z + s.radius for s in spheres)[-30:]) / 30
    return {"work": summary["energy"]["work_of_boundaries"], "weight": weight, "height": top + settings["sunk"],
            "carried": summary["boundary_force"][2] / weight}


def floors(results):
    """By engine, how and seed: height of the fill [diameters], share of its weight on the floor, its weight, per fill."""
    out = {}
    for job, early, late in twins(results, "sunk", *BETWEEN):
        force = (early["work"] - late["work"]) / (BETWEEN[1] - BETWEEN[0])
        share = (late["height"], force / late["weight"], late["weight"])
        out.setdefault((job.engine, job.how, job.seed), {})[dict(job.settings)["fill"]] = share
    return out


def janssen(height, length):
    """Share of the weight on the floor, by the length over which walls take the load."""
    return length / height * (1 - math.exp(-height / length))


def fitted_length(shares):
    """Least squares of the floor's force over all fills, by trying."""
    def error(length):
        return sum((h * (share - janssen(h, length))) ** 2 for h, share, _ in shares.values())
    return min((0.01 * n for n in range(200, 4000)), key=error)


def floor_row(name, answer, tolerance, own, value, low, high):
    row, values = Row(name, answer, tolerance), {}
    for (engine, how, _), shares in sorted(own.items()):
        values.setdefault((engine, how), []).append(value(shares))
    for key, each in values.items():
        row.add(key, each, low, high)
    return row


def rows(results):
    own = floors(results)
    for fill in FILLS:
        yield floor_row(f"floor's share of the weight, fill of {fill} widths", "", "", own, lambda s: s[fill][1], 0, 1)
    yield floor_row("pressure at 4 over that at 2 widths", "saturates: Janssen (1895)", "< 1.15", own,
                    lambda s: s[4][1] * s[4][2] / (s[2][1] * s[2][2]), 0, 1.15)
    yield floor_row("K = width / (4 mu L), L fitted to all fills", "0.4 to 0.8", "", own,
                    lambda s: WIDTH / (4 * WALL_FRICTION * fitted_length(s)), 0.4, 0.8)
    yield row_of("floor and walls / weight, less 1", "0", "± 0.03", results, lambda r: r["carried"] - 1, -0.03, 0.03)


CREEPS = "friction at the walls creeps as in the heap of C4, so they carry less"
CAUSES = [("pressure", "ode", "", 0.5, CREEPS), ("K =", "ode", "", 0.16, CREEPS)]
