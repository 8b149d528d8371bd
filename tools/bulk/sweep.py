# SPDX-License-Identifier: Apache-2.0
"""Which engines run a case, with which settings and how many seeds."""
import dataclasses
import math

from .runs import SUB_MODELS, Job

UNCUT = ("soft_sphere",)  # cut they have the same bits
SOFT_STEP = {"soft_sphere": (("step", 0.8e-3),)}  # ticks, near its limit


@dataclasses.dataclass(frozen=True)
class Sweep:
    engines: tuple
    settings: tuple          # of each run: pairs of parameter and value
    seeds: float = math.inf  # at most: one where an engine is dear
    times: int = 1           # as many seeds as usual, where three differ by as much as the tolerance
    ways: tuple = tuple(SUB_MODELS)


def each(parameter, *values):
    """Settings of runs that differ by one parameter."""
    return tuple(((parameter, value),) for value in values)


def jobs_of(case, *sweeps, steps=SOFT_STEP):
    """A function from the number of seeds to the jobs; `steps` has settings that an engine needs in all of them."""
    def jobs(seeds):
        for sweep in sweeps:
            for engine in sweep.engines:
                for how in ("whole",) if engine in UNCUT else sweep.ways:
                    for settings in sweep.settings:
                        for seed in range(1, min(seeds * sweep.times, sweep.seeds) + 1):
                            yield Job(case, engine, how, seed, (*settings, *steps.get(engine, ())))
    return jobs
