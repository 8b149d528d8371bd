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


def peer(arguments, code, *options):
    """What tools/peers/run measured; nothing if the program is missing."""
    command = [os.path.join(ROOT, "tools/peers/run"), code, "--moraine", arguments.moraine, *options]
    done = subprocess.run(command, capture_output=True, text=True)
    if done.returncode == 3:
        print(f"  {code} is not beside them: {done.stderr.strip()}", file=sys.stderr)
        return None
    if done.returncode != 0:
        sys.exit(done.stderr)
    return json.loads(done.stdout)


def peer_row(arguments, code, count):
    """One run per seed; nothing if the program is missing."""
    runs = []
    for seed in range(1, arguments.repeats + 1):
        print(f"  {code}, seed {seed} of {arguments.repeats} ...", file=sys.stderr)
        done = peer(arguments, code, "--count", str(count), "--seed", str(seed))
        if done is None:
            return []
        runs.append(done)
    little = peer(arguments, code, "--count", "8", "--time", "0.1")
    return [engine_row(code, runs, bytes_per_element(runs, little, count))]


def with_costs(summary):
    """As tools/peers/run has them."""
    return {**summary, "us_per_element_step": 1e6 / summary["element_steps_per_s"],
            "simulated_s_per_wall_s": summary["time"] / summary["loop_wall_s"]}


def bytes_per_element(runs, little, count):
    """What more elements need than next to none."""
    return (max(r["peak_rss_bytes"] for r in runs) - little["peak_rss_bytes"]) / count


def engine_row(name, runs, memory):
    def median(key):
        return statistics.median(key(r) for r in runs)
    return {"engine": name, "us_per_element_step": median(lambda r: r["us_per_element_step"]),
            "simulated_s_per_wall_s": median(lambda r: r["simulated_s_per_wall_s"]),
            "bytes_per_element": memory, "com_x": median(lambda r: r["center_of_mass"][0]),
            "com_z": median(lambda r: r["center_of_mass"][2]), "x95": median(lambda r: r["x95"])}


def print_engines(rows, count, repeats):
    reference = next(r for r in rows if r["engine"] == REFERENCE)
    print(f"dam of {count:,} spheres, one thread, one sub-model; medians of {repeats} seed(s); errors against {REFERENCE}")
    print(f"{'engine':12} {'us/el-step':>10} {'sim s/wall s':>12} {'bytes/el':>9} {'com x':>8} {'com z':>8} {'x95':>8}")
    for r in rows:
        errors = [f"{100 * (r[k] / reference[k] - 1):+7.2f}%" for k in ("com_x", "com_z", "x95")]
        print(f"{r['engine']:12} {r['us_per_element_step']:10.3f} {r['simulated_s_per_wall_s']:12.4f} "
              f"{r['bytes_per_element']:9.0f} {' '.join(errors)}")


def wanted(arguments, names):
    """Those asked for, and the reference; all if none was."""
    asked = set(arguments.engines.split(",")) if arguments.engines else set(names)
    if unknown := asked - set(names):
        sys.exit(f"bench: no engine or code {', '.join(sorted(unknown))}, expected some of {', '.join(names)}")
    return [n for n in names if n in asked or n == REFERENCE]


def engines(arguments):
    count = arguments.count or 3_000
    alone = ["--sub-models", "1", "--threads", "1", "--scheduler", "serial"]
    own = listed_engines(arguments.moraine)
    chosen = wanted(arguments, own + list(CODES))
    cases = [(e, alone + SETTINGS.get(e, [])) for e in chosen if e in own]
    runs = {name: [] for name, _ in cases}
    rows = []
    for seed in range(1, arguments.repeats + 1):
        for name, options in cases:
            print(f"  {name}, seed {seed} of {arguments.repeats} ...", file=sys.stderr)
            options = options + ["--engine", name, "--set", f"count={count}", "--set", f"seed={seed}"]
            runs[name].append(with_costs(run(arguments.moraine, "dam", options)))
    for name, options in cases:
        little = run(arguments.moraine, "dam", ["--engine", name, "--set", "count=8", "--steps", "10"] + options)
        rows.append(engine_row(name, runs[name], bytes_per_element(runs[name], little, count)))
    for code in chosen[len(cases):]:
        rows += peer_row(arguments, code, count)
    print_engines(rows, count, arguments.repeats)
    return rows


def bullet(arguments):
    """Bullet as it comes and as an engine, in one world and cut, on one thread."""
    count, steps = arguments.count or 100_000, arguments.steps or 30
    alone = ["--threads", "1", "--scheduler", "serial", "--engine", "bullet", "--set", f"count={count}", "--steps", str(steps)]
    ours = {"bullet, one world": ["--sub-models", "1"], "bullet, cut": ["--sub-models", "auto"]}
    runs = {name: [] for name in ("stock_bullet", *ours)}
    stock = peer(arguments, "stock_bullet", "--count", "8", "--time", "0.1")
    if stock is None:
        sys.exit("bench: nothing to compare with")
    for repeat in range(arguments.repeats):
        print(f"  run {repeat + 1} of {arguments.repeats} ...", file=sys.stderr)
        runs["stock_bullet"].append(peer(arguments, "stock_bullet", "--count", str(count), "--time", repr(steps / 120)))
        for name, options in ours.items():
            runs[name].append(with_costs(run(arguments.moraine, "dam", alone + options)))
    own = run(arguments.moraine, "dam", ["--engine", "bullet", "--set", "count=8", "--steps", "10"])
    little = {"stock_bullet": stock} | dict.fromkeys(ours, own)
    rows = [engine_row(name, of, bytes_per_element(of, little[name], count)) for name, of in runs.items()]
    print(f"dam of {count:,} spheres, {steps} steps, one thread; medians of {arguments.repeats}")
    print(f"{'':20} {'us/el-step':>10} {'ratio':>6} {'bytes/el':>9} {'ratio':>6}")
    for r in rows:
        ratios = [r[k] / rows[0][k] for k in ("us_per_element_step", "bytes_per_element")]
        print(f"{r['engine']:20} {r['us_per_element_step']:10.3f} {ratios[0]:6.2f} {r['bytes_per_element']:9.0f} {ratios[1]:6.2f}")
    return rows
