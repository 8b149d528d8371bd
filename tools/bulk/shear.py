# SPDX-License-Identifier: Apache-2.0
"""How hard a bed of grains holds a base that moves away below it: friction angles of the assembly and of its base."""
import math
import statistics

from . import frames
from .rows import Row, twins
from .sweep import Sweep, jobs_of

TITLE = "C7 shear"
BASES = (0.1, 0.3, 0.6)   # frictions of flat bases
WAYS = (4, 12)            # of the base, diameters: what happens between them counts
LENGTHS = (16, 24)        # of the bed, diameters: what the longer has more counts, both have the same ends
GLASS = 20.9              # degrees, of slow flow
GRAINS = "grains"         # instead of a base's friction: grains over grains
# Four runs each: differences of work over the way are forces, differences of forces over the length have no ends.
RUNS = tuple((base, ("length", length), ("way", way)) for base in (("rough", 1), *(("base", mu) for mu in BASES))
             for length in LENGTHS for way in WAYS)
jobs = jobs_of("shear", Sweep(("impulse",), RUNS))


def measure(folder, summary, settings):
    return {"work": summary["energy"]["work_of_boundaries"], "weight": frames.weight(frames.last(folder))}


def angles(results):
    """Friction angles [degrees] by base and engine and how, a list of seeds each."""
    forces = {job: ((late["work"] - early["work"]) / (WAYS[1] - WAYS[0]), late["weight"]) for job, early, late in twins(results, "way", *WAYS)}
    out = {}
    for job, short, long in sorted(twins(forces, "length", *LENGTHS), key=lambda found: found[0].seed):
        angle = math.degrees(math.atan((long[0] - short[0]) / (long[1] - short[1])))
        out.setdefault(dict(job.settings).get("base", GRAINS), {}).setdefault((job.engine, job.how), []).append(angle)
    return out


def grains(results):
    """Mean friction angle of grains over grains, uncut [degrees]."""
    return statistics.mean(angles(results)[GRAINS]["impulse", "whole"])


def rows(results):
    for base, own in sorted(angles(results).items(), key=lambda found: (found[0] != GRAINS, found[0])):
        if base == GRAINS:
            row = Row("friction angle of grains over grains, mu = 0.5 [°]", f"{GLASS}: Jop et al. (2006), glass beads", "± 4°")
            low, high = GLASS - 4, GLASS + 4
        else:
            coulomb = math.degrees(math.atan(base))
            row = Row(f"friction angle of a base of friction {base:g} [°]", f"at most {coulomb:.1f}: Coulomb", "1°")
            low, high = 0, coulomb + 1
        for key, values in own.items():
            row.add(key, values, low, high)
        yield row


CAUSES = []
