# SPDX-License-Identifier: Apache-2.0
"""How wrong replays are, and what tracing costs."""
import json
import os
import statistics
import subprocess
import tempfile

from .runs import ROOT, SCHEDULERS, common, launcher, run_into

REPLAYED = [(1, 1), (1, 2), (2, 1), (3, 1), (4, 1), (2, 2)]  # ranks, threads


def traced(arguments, ranks, options, folder):
    """A traced dam in slabs; returns the trace."""
    trace = os.path.join(folder, "run.trace")
    run_into(folder, arguments.moraine, "dam", ["--split", "slabs", "--sub-models", "7", "--trace", trace, *common(arguments, 14_000, 64),
                                                *options], launcher(ranks))
    return trace


def replays(arguments):
    rows = []
    layouts = [(r, t) for r, t in REPLAYED if not arguments.layout or arguments.layout == f"{r}x{t}"]
    for ranks, threads in layouts:
        for scheduler in SCHEDULERS[1:]:
            errors, makespans = [], []
            for _ in range(arguments.repeats):
                with tempfile.TemporaryDirectory() as folder:
                    trace = traced(arguments, ranks, ["--threads", str(threads), "--scheduler", scheduler], folder)
                    out = subprocess.run([arguments.moraine, "replay", trace, "--json"], check=True, capture_output=True)
                    best = json.loads(out.stdout)["best"]
                    makespans.append(best["traced_makespan_s"])
                    errors.append(100 * (best["makespan_s"] / best["traced_makespan_s"] - 1))
            row = {"ranks": ranks, "threads": threads, "scheduler": scheduler, "error_percent": statistics.median(errors),
                   "errors": errors, "makespans_s": makespans}
            rows.append(row)
            print(f"{ranks} x {threads}  {scheduler:14} {row['error_percent']:+6.1f} %   of "
                  f"{statistics.median(makespans):.3f} s   ({', '.join(f'{e:+.1f}' for e in errors)})", flush=True)
    return rows


def instructions(command):
    """Of user code, by perf; none where perf may not count."""
    try:
        out = subprocess.run(["perf", "stat", "-x,", "-e", "instructions:u"] + command, check=True, capture_output=True,
                             text=True).stderr
        return float(out.strip().splitlines()[-1].split(",")[0])
    except (OSError, ValueError, subprocess.CalledProcessError):
        return None


def tracing(arguments):
    """Runs in turn, with and without."""
    rows = {"without": [], "traced": []}
    with tempfile.TemporaryDirectory() as folder:
        command = [arguments.moraine, "run", os.path.join(ROOT, "apps/scenes/dam.yaml"), "--out", folder, "--quiet",
                   "--output-every", "0", "--set", "output.pictures=false", "--threads", "2", "--sub-models", "16"] + \
            common(arguments, 14_000, 64)
        for _ in range(arguments.repeats):
            for name, more in (("without", []), ("traced", ["--trace", os.path.join(folder, "run.trace")])):
                count = instructions(command + more)
                if count is None:
                    subprocess.run(command + more, check=True)
                with open(os.path.join(folder, "summary.json")) as f:
                    summary = json.load(f)
                rows[name].append({"instructions": count, "loop_wall_s": summary["loop_wall_s"],
                                   "state_hash": summary["state_hash"]})
        size = os.path.getsize(os.path.join(folder, "run.trace"))
    for what in ("instructions", "loop_wall_s"):
        if rows["traced"][0][what] is None:
            continue
        without, with_trace = (statistics.median(r[what] for r in rows[name]) for name in ("without", "traced"))
        print(f"{what:14} {without:.6g} without, {with_trace:.6g} traced: {100 * (with_trace / without - 1):+.2f} %")
    print(f"trace of {size} bytes; state hash " + " ".join(sorted({r["state_hash"] for n in rows for r in rows[n]})))
    return rows
