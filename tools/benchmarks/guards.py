# SPDX-License-Identifier: Apache-2.0
"""What guards and the ledger take of a run, by samples of perf."""
import collections
import os
import shutil
import statistics
import subprocess
import sys
import tempfile

from .engines import SETTINGS
from .runs import common, run_into

HERTZ = 4999
ENGINES = ("bullet", "impulse")
OWN = ("SubModel::ledger", "SubModel::spin", "SubModel::extremes", "SubModel::bond_energy", "SubModel::stretch_energy",
       "SubModel::close_account", "SubModel::check_motions", "Accounts::", "GuardLog::", "Enclosure::")
BOUNDS = ("SubModel::update_bounds",)  # where ghosts may be needed, and in the same pass the sums of ledger and guards


def sampled(record):
    """Samples by function."""
    out = subprocess.run(["perf", "report", "--input", record, "--stdio", "--no-children", "--field-separator", "\t",
                          "--fields", "sample,symbol"], check=True, capture_output=True, text=True).stdout
    samples = collections.Counter()
    for line in out.splitlines():
        if "\t" in line and not line.startswith("#"):
            count, symbol = line.split("\t", 1)
            samples[symbol.strip()] += int(count)
    return samples


def share(samples, names, seconds):
    """Of the time of the loop [%]; `seconds` of a processor."""
    return 100 * sum(n for symbol, n in samples.items() if any("moraine::" + name in symbol for name in names)) / HERTZ / seconds


def sample(arguments, engine):
    options = ["--engine", engine, *SETTINGS[engine], "--threads", "1", "--sub-models", "1", *common(arguments, 10_000, 260)]
    with tempfile.TemporaryDirectory() as out:
        record = os.path.join(out, "perf.data")
        summary = run_into(out, arguments.moraine, "dam", options,
                           ["perf", "record", "--quiet", "--event", "cpu-clock", "--freq", str(HERTZ), "--output", record])
        samples, seconds = sampled(record), summary["loop_cpu_s"]
    return {"loop_cpu_s": seconds, "own": share(samples, OWN, seconds), "bounds": share(samples, BOUNDS, seconds),
            "state_hash": summary["state_hash"]}


def guards(arguments):
    """The dam in one world: there is nothing else to be done that would hide them."""
    if not shutil.which("perf"):
        sys.exit("tools/bench: guards needs perf, Debian package linux-perf")
    rows = []
    print(f"{'engine':10} {'loop s':>8} {'guards and ledger %':>20} {'bounds, with sums %':>20}  state hash")
    for engine in ENGINES:
        runs = []
        for repeat in range(arguments.repeats):
            print(f"  {engine}, run {repeat + 1} of {arguments.repeats} ...", file=sys.stderr)
            runs.append(sample(arguments, engine))
        row = {key: statistics.median(r[key] for r in runs) for key in ("loop_cpu_s", "own", "bounds")}
        row |= {"engine": engine, "state_hash": " ".join(sorted({r["state_hash"] for r in runs}))}
        rows.append(row)
        print(f"{engine:10} {row['loop_cpu_s']:8.3f} {row['own']:20.2f} {row['bounds']:20.2f}  {row['state_hash']}", flush=True)
    return rows
