# SPDX-License-Identifier: Apache-2.0
"""A silo that runs out through a round hole."""
from .discharge import Discharge
from .sweep import Sweep, jobs_of

TITLE = "C3 hole"
# The flow grows at first: through all openings together 54.9, 55.5 and 57.1 per tick pass from tick 4 to 12, to 20 and to 28 whole,
# 54.9, 57.0 and 57.1 cut (nine seeds, ± 0.5).
HOLE = Discharge("hole", (5, 6.5, 8), 5 / 2, settled=25, begin=12, window=8, depth=1, fill=((10, 18), (-18, 18), (3, 12)),
                 papers="Beverloo et al. (1961)", factor=("0.58: Beverloo et al. (1961)", "0.5 to 0.65", 0.5, 0.65))
jobs = jobs_of("hole", Sweep(("impulse",), HOLE.runs(), times=3))
measure, rows = HOLE.measure, HOLE.rows
CAUSES = [
    ("C of", "impulse", "", 0.025, "less friction, more flow: with 0.3 instead of 0.5 C is 0.526 (openings of 5 and 8 d, one seed each). Another code finds 0.49 with 0.5 and 0.548 with 0.3 "
     "(validation of the DEM module of MOOSE, k = 1.68 and 1.57)"),
]
