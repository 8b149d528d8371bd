# SPDX-License-Identifier: Apache-2.0
"""Every engine on the dam."""
import json
import os
import statistics
import subprocess
import sys

from peers.codes import CODES

from .runs import ROOT, run

# What each engine needs to come within a few per cent of the reference, with as few steps as that allows.
SETTINGS = {
    "bullet": ["--dt", "1/120"],
    "bullet64": ["--dt", "1/120"],
    "impulse": ["--dt", "1/60", "--iterations", "4"],
    "ode": ["--dt", "1/240"],
    "soft_sphere": ["--dt", "1.4e-4", "--set", "materials.grain.restitution=0.5"],
}
REFERENCE = "soft_sphere"


def listed_engines(moraine):
    lines = subprocess.run([moraine, "list"], check=True, capture_output=True, text=True).stdout.splitlines()
    start = lines.index("engines") + 1
    rows = []
    while lines[start].startswith(" "):
        rows.append(lines[start].split()[0])
        start += 1
    return rows


def peer(arguments, code, count):
    """What tools/peers/run measured, one run per seed; nothing if the program is missing."""
    tool = os.path.join(ROOT, "tools/peers/run")
    runs = []
    for seed in range(1, arguments.repeats + 1):
        print(f"  {code}, seed {seed} of {arguments.repeats} ...", file=sys.stderr)
        done = subprocess.run([tool, code, "--moraine", arguments.moraine, "--count", str(count), "--seed", str(seed)],
                              capture_output=True, text=True)
        if done.returncode == 3:
            print(f"  {code} is not beside them: {done.stderr.strip()}", file=sys.stderr)
            break
        done.check_returncode()
        runs.append(json.loads(done.stdout))
    return runs


def engine_row(name, runs, bytes_per_element):
    def median(key):
        return statistics.median(key(r) for r in runs)
    return {"engine": name, "us_per_element_step": median(lambda r: r["us_per_element_step"]),
            "simulated_s_per_wall_s": median(lambda r: r["simulated_s_per_wall_s"]),
            "bytes_per_element": bytes_per_element, "com_x": median(lambda r: r["center_of_mass"][0]),
            "com_z": median(lambda r: r["center_of_mass"][2]), "x95": median(lambda r: r["x95"])}


def print_engines(rows, count, repeats):
    reference = next(r for r in rows if r["engine"] == REFERENCE)
    print(f"dam of {count:,} spheres, one thread, one sub-model; medians of {repeats} seed(s); errors against {REFERENCE}")
    print(f"{'engine':12} {'us/el-step':>10} {'sim s/wall s':>12} {'bytes/el':>9} {'com x':>8} {'com z':>8} {'x95':>8}")
    for r in rows:
        errors = [f"{100 * (r[k] / reference[k] - 1):+7.2f}%" for k in ("com_x", "com_z", "x95")]
        print(f"{r['engine']:12} {r['us_per_element_step']:10.3f} {r['simulated_s_per_wall_s']:12.4f} "
              f"{r['bytes_per_element'] or 0:9.0f} {' '.join(errors)}")


def wanted(arguments, names):
    """Those asked for, and the reference; all if none was."""
    asked = set(arguments.engines.split(",")) if arguments.engines else None
    return [n for n in names if asked is None or n in asked or n == REFERENCE]


def engines(arguments):
    count = arguments.count or 3_000
    alone = ["--sub-models", "1", "--threads", "1", "--scheduler", "serial"]
    cases = [(e, alone + SETTINGS.get(e, [])) for e in wanted(arguments, listed_engines(arguments.moraine))]
    runs = {name: [] for name, _ in cases}
    rows = []
    for seed in range(1, arguments.repeats + 1):
        for name, options in cases:
            print(f"  {name}, seed {seed} of {arguments.repeats} ...", file=sys.stderr)
            r = run(arguments.moraine, "dam", options + ["--engine", name, "--set", f"count={count}", "--set",
                                                         f"seed={seed}"])
            r["us_per_element_step"] = 1e6 / r["element_steps_per_s"]
            r["simulated_s_per_wall_s"] = r["time"] / r["loop_wall_s"]
            runs[name].append(r)
    for name, options in cases:
        little = run(arguments.moraine, "dam", ["--engine", name, "--set", "count=8", "--steps", "10"] + options)
        grown = max(r["peak_rss_bytes"] for r in runs[name]) - little["peak_rss_bytes"]
        rows.append(engine_row(name, runs[name], grown / count))
    for code in wanted(arguments, CODES):
        if beside := peer(arguments, code, count):
            rows.append(engine_row(code, beside, None))
    print_engines(rows, count, arguments.repeats)
    return rows
