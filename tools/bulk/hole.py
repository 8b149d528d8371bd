# SPDX-License-Identifier: Apache-2.0
"""A silo that runs out through a round hole."""
from .discharge import Discharge

TITLE = "C3 hole"
HOLE = Discharge("hole", (5, 6.5, 8), 5 / 2, settled=25, begin=4, window=8, depth=1, fill=((10, 18), (-18, 18), (3, 12)),
                 papers="Beverloo et al. (1961)", factor=("0.58: Beverloo et al. (1961)", "0.5 to 0.65", 0.5, 0.65))
jobs, measure, rows = HOLE.jobs, HOLE.measure, HOLE.rows
CAUSES = [
    ("C of", "impulse", "", "C and the empty annulus of a fit depend on each other, and 1.4 d is that of real grains: with 1.2 d C is 0.44, with 1.6 d 0.54"),
    ("what passes", "impulse", "cut", "3.5 % more from tick 12 to 20 than from tick 4 to 12: the flow is still growing; whole it is 1.5 %, and three seeds differ by 3 %"),
]
