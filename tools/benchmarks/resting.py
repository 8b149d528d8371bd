# SPDX-License-Identifier: Apache-2.0
"""What skipping rest saves, and what it changes."""
import os
import statistics
import sys
import tempfile

from .runs import run_into

DT, SUBSTEPS = 1 / 120, 4                                # of the scene
SETTLED, UNTIL = round(16 / DT), round(24 / DT)          # steps; the bed has settled by the first
SAVED = SETTLED + 100                                    # by then there is a checkpoint of a settled bed
THRESHOLDS = ("0", "0.02")


def bed(arguments, folder, threshold, *options):
    return run_into(folder, arguments.moraine, "pushed_bed", [
        "--threads", "1", "--skip-threshold", threshold, "--set", "sections=40", "--dt", repr(DT), "--substeps", str(SUBSTEPS), *options])


def settled(arguments, folder, threshold):
    print(f"  threshold {threshold}: until it has settled ...", file=sys.stderr)
    return bed(arguments, folder, threshold, "--steps", str(SAVED), "--checkpoint-every", str(SETTLED))


def rest(arguments):
    """A bed of 40 sections that is pushed at one end: cost after it has settled, with and without skipping. Runs go on from a
    checkpoint of that time."""
    with tempfile.TemporaryDirectory() as out:
        folders = {t: os.path.join(out, t) for t in THRESHOLDS}
        before = {t: settled(arguments, folder, t) for t, folder in folders.items()}
        runs = {t: [] for t in THRESHOLDS}
        for repeat in range(arguments.repeats):
            for t, folder in folders.items():
                print(f"  threshold {t}, run {repeat + 1} of {arguments.repeats} ...", file=sys.stderr)
                runs[t].append(bed(arguments, folder, t, "--steps", str(UNTIL), "--restart", "latest"))
    return table_of(before, runs)


def row_of(threshold, before, runs):
    last = runs[-1]
    return {"threshold": threshold, "rested": (last["rested"] * UNTIL - before["rested"] * SAVED) / (UNTIL - SAVED),
            "us_per_element_step": statistics.median(1e6 / r["element_steps_per_s"] for r in runs), "com": last["center_of_mass"],
            "z95": last["quantiles"]["95"][2], "momentum_residual": last["momentum_residual"]["linear"],
            "state_hash": " ".join(sorted({r["state_hash"] for r in runs}))}


def table_of(before, runs):
    rows = [row_of(t, before[t], own) for t, own in runs.items()]
    print(f"{'threshold':>9} {'rested':>7} {'us/el-step':>10} {'ratio':>6} {'com x':>9} {'com z':>8} {'z95':>8} {'lost momentum':>14}"
          "  state hash")
    for row in rows:
        row["ratio"] = row["us_per_element_step"] / rows[0]["us_per_element_step"]
        print(f"{row['threshold']:>9} {row['rested']:7.3f} {row['us_per_element_step']:10.4f} {row['ratio']:6.3f} {row['com'][0]:9.4f} "
              f"{row['com'][2]:8.4f} {row['z95']:8.4f} {row['momentum_residual']:14.1e}  {row['state_hash']}")
    return rows
