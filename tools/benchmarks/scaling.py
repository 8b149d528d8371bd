# SPDX-License-Identifier: Apache-2.0
"""One world against many, threads, schedulers, a million elements."""
from .runs import SCHEDULERS, common, measure, table


def cut(arguments):
    count = arguments.count or 100_000
    base = common(arguments, count, 40) + ["--threads", "1"]
    sizes = [s for s in (100_000, 50_000, 20_000, 10_000, 5_000, 2_000, 1_000, 500) if s <= count]
    cases = [(f"{s} per sub-model", base + ["--sub-models", str(max(1, count // s))]) for s in sizes]
    cases.append(("auto", base))
    return table(measure(arguments, "dam", cases), cases[0][0])


def threads(arguments):
    base = common(arguments, 100_000, 40)
    cases = [("1 thread", base + ["--threads", "1"]), ("2 threads", base + ["--threads", "2"])]
    return table(measure(arguments, "dam", cases), "1 thread")


def schedulers(arguments):
    rows = []
    for parts in (3, 7):
        base = common(arguments, 21_000, 64) + ["--sub-models", str(parts), "--split", "slabs", "--threads", "2"]
        cases = [(f"{parts} sub-models, {s}", base + ["--scheduler", s]) for s in SCHEDULERS]
        rows += table(measure(arguments, "dam", cases), cases[0][0])
    return rows


def memory(arguments):
    cases = [("1,000,000 spheres", common(arguments, 1_000_000, 10))]
    rows = table(measure(arguments, "dam", cases), cases[0][0])
    print(f"{rows[0]['peak_mib'] * 2**20 / (arguments.count or 1_000_000):.0f} bytes per element at the peak")
    return rows
