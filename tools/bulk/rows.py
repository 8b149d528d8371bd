# SPDX-License-Identifier: Apache-2.0
"""Rows of the table: what should come out, and what did."""
import dataclasses
import statistics

from .runs import SUB_MODELS

ENGINES = ("impulse", "bullet", "bullet64", "soft_sphere", "ode")


def by_seed(results, value):
    """Values by engine and how, in order of seeds."""
    out = {}
    for job in sorted(results, key=lambda j: (j.seed, j.settings)):
        out.setdefault((job.engine, job.how), []).append(value(results[job]))
    return out


def with_settings(results, **wanted):
    """Results of the jobs that state these; what a job does not state is 0."""
    return {j: r for j, r in results.items() if all(dict(j.settings).get(k, 0) == v for k, v in wanted.items())}


def twins(results, name, early, late):
    """Jobs whose setting of that name is `late`, with the results of the one that is `early` otherwise alike, and of their own."""
    for job, after in results.items():
        if dict(job.settings)[name] == late:
            settings = tuple((k, early if k == name else v) for k, v in job.settings)
            yield job, results[dataclasses.replace(job, settings=settings)], after


def row_of(name, answer, tolerance, results, value, low, high):
    """A quantity that every run has, between the same bounds for all."""
    row = Row(name, answer, tolerance)
    for key, values in by_seed(results, value).items():
        row.add(key, values, low, high)
    return row


class Row:
    """One quantity of a case."""

    def __init__(self, name, answer, tolerance):
        self.name, self.answer, self.tolerance, self.values, self.bounds = name, answer, tolerance, {}, {}

    def add(self, key, values, low, high):
        self.values[key], self.bounds[key] = values, (low, high)

    def excess(self, key):
        """How far the mean is outside its bounds; not more than 0 if it is inside."""
        low, high = self.bounds[key]
        mean = statistics.mean(self.values[key])
        return max(low - mean, mean - high)

    def missed(self, key):
        return not self.excess(key) <= 0  # NaN is a miss

    def figure(self, key):
        mean = statistics.mean(self.values[key])
        text = number(mean)
        if len(self.values[key]) > 1:
            text += f" ± {number(statistics.stdev(self.values[key]), mean)}"
        return f"**{text}**" if self.missed(key) else text

    def cell(self, engine):
        return " / ".join(self.figure((engine, how)) for how in SUB_MODELS if (engine, how) in self.values)

    def misses(self):
        return [key for key in self.values if self.missed(key)]


def number(value, beside=None):
    """About three digits; a spread has as many decimals as the mean that it stands beside."""
    size = abs(value if beside is None else beside)
    if size < 1e-3 or size >= 1e4:
        return f"{value:.1e}" if value else "0"
    return f"{value:.{3 if size < 1 else 2 if size < 10 else 1}f}" if size >= 0.1 else f"{value:.4f}"
