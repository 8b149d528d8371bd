# SPDX-License-Identifier: Apache-2.0
"""Runs of the command, several times in turn, and the table of what they took."""
import json
import os
import statistics
import subprocess
import sys
import tempfile

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
os.environ.update(OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1")
SCHEDULERS = ["serial", "barrier", "stealing", "critical_path", "hybrid"]


def launcher(ranks):
    """Words before the command."""
    return [] if ranks == 1 else ["mpirun", "-np", str(ranks), "--oversubscribe", "--bind-to", "none"]


def run_into(out, moraine, scene, options, before=()):
    """One run into a folder; returns its summary. `before`: words before the command."""
    command = [*before, moraine, "run", os.path.join(ROOT, "apps/scenes", scene + ".yaml"), "--out", out, "--quiet",
               "--output-every", "0", "--set", "output.pictures=false", "--set", "output.formats=[csv]"] + options
    subprocess.run(command, check=True)
    with open(os.path.join(out, "summary.json")) as f:
        return json.load(f)


def run(moraine, scene, options, ranks=1):
    """One run; returns its summary."""
    with tempfile.TemporaryDirectory() as out:
        return run_into(out, moraine, scene, options, launcher(ranks))


def measure(arguments, scene, cases):
    """Runs all cases (name, options, ranks if not 1) `repeats` times in turn; returns the summaries of each case."""
    results = {name: [] for name, *_ in cases}
    for repeat in range(arguments.repeats):
        for name, options, *ranks in cases:
            print(f"  {name}, run {repeat + 1} of {arguments.repeats} ...", file=sys.stderr)
            results[name].append(run(arguments.moraine, scene, options, *ranks))
    return results


def table(results, baseline):
    """Prints medians and ratios to the baseline case."""
    reference = statistics.median(s["loop_wall_s"] for s in results[baseline])
    print(f"{'case':28} {'loop s':>8} {'ratio':>7} {'us/el-step':>10} {'utilis.':>8} {'outside':>8} {'ghosts':>7} "
          f"{'MiB':>7}  state hash")
    rows = []
    for name, runs in results.items():
        hashes = {s["state_hash"] for s in runs}
        row = {
            "case": name,
            "loop_wall_s": statistics.median(s["loop_wall_s"] for s in runs),
            "us_per_element_step": statistics.median(1e6 / s["element_steps_per_s"] for s in runs),
            "utilisation": statistics.median(s["load"]["utilisation"] for s in runs),
            "outside_engine": statistics.median(1 - s["step_share"]["step"] for s in runs),
            "ghost_fraction": runs[0]["ghosts"]["fraction_mean"],
            "peak_mib": max(s["peak_rss_bytes"] for s in runs) / 2**20,
            "state_hash": " ".join(sorted(hashes)),
        }
        row["ratio"] = row["loop_wall_s"] / reference
        rows.append(row)
        print(f"{name:28} {row['loop_wall_s']:8.3f} {row['ratio']:7.3f} {row['us_per_element_step']:10.2f} "
              f"{row['utilisation']:8.3f} {row['outside_engine']:8.3f} {row['ghost_fraction']:7.3f} "
              f"{row['peak_mib']:7.0f}  {row['state_hash']}")
    return rows


def common(arguments, count, steps):
    return ["--set", f"count={arguments.count or count}", "--steps", str(arguments.steps or steps)]
