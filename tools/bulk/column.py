# SPDX-License-Identifier: Apache-2.0
"""A planar column between two walls."""
import math

from .collapse import ROLLING, Collapse
from .rows import ENGINES
from .sweep import Sweep, each, jobs_of

TITLE = "C5 column"
LENGTH, WIDTH = 20, 4


def lube(a):
    return 1.2 * a if a < 1.8 else 1.9 * a ** (2 / 3)


def lajeunesse(a):
    return 1.8 * a if a < 3 else 2.3 * a ** (2 / 3)


LOW, HIGH = each("aspect", 0.5, 1), each("aspect", 2, 4)
jobs = jobs_of("column", Sweep(ENGINES, LOW), Sweep(("impulse",), HIGH),
               Sweep(("bullet",), HIGH, seeds=1), Sweep(("soft_sphere",), HIGH[:1], seeds=1), steps={"soft_sphere": (("dt", 5e-4),)})
COLUMN = Collapse(LENGTH, (0.5, 1, 2, 4), distance=lambda s: s.x, area=lambda i: WIDTH,
                  settled=lambda a: 4 * math.sqrt(a * LENGTH / 9.81) + 4, laws=(lube, lajeunesse),
                  papers="Lube et al. (2005), Lajeunesse et al. (2005)", power=2 / 3)
measure, rows = COLUMN.measure, COLUMN.rows

CAUSES = [
    ("exponent", "", "", 0.28, "smooth walls make it a wide channel, for which Balmforth & Kerswell (2005) find 0.9 ± 0.1, and 0.65 ± 0.05 for a narrow one; "
     "with friction on the walls it is 0.67 (run-outs 1.85 and 2.95, one seed). The size matters less: 0.93 for a column 30 diameters long"),
    ("motion left", "ode", "", 0.008, "the slope creeps, as the heap of C4 does"),
    ROLLING,
]
