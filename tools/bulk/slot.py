# SPDX-License-Identifier: Apache-2.0
"""A silo that runs out through a slot."""
from .discharge import Discharge
from .sweep import Sweep, jobs_of

TITLE = "C3 slot"
SLOT = Discharge("slot", (6, 8, 10), 3 / 2, settled=30, begin=4, window=4, depth=4, fill=((0, 12), (0, 4), (3, 15)),
                 papers="Beverloo et al. (1961), Choi et al. (2005)", factor=("1.03: Nedderman (1992)", "", 0, 9))
jobs = jobs_of("slot", Sweep(("impulse", "bullet", "bullet64"), SLOT.runs()), Sweep(("soft_sphere", "ode"), SLOT.runs(), seeds=1))
measure, rows = SLOT.measure, SLOT.rows
CAUSES = []
