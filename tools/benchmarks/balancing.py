# SPDX-License-Identifier: Apache-2.0
"""Loads that move, and sub-models on ranks and threads."""
import statistics
import sys

from .runs import common, measure, run, table

# Scenes for balancers: steps; options, with a balance every so many steps.
BALANCE = {
    "uneven": (240, ["--balance-every", "12"]),
    "deposit": (480, ["--balance-every", "12"]),
    "heap": (480, ["--balance-every", "12"]),
    "dam": (240, ["--balance-every", "12", "--sub-models", "16"]),
    "crust_small": (24, ["--balance-every", "4", "--sub-models", "8"]),
}


def balance_row(scene, summary, stays):
    rounds, balancing = summary["balance"]["rounds"], summary["balance"]["seconds"] / summary["loop_wall_s"]
    print(f"{scene}: {summary['elements']} elements, {summary['sub_models']} sub-models, {summary['ranks']} ranks")
    print(f"  {'step':>6} {'owners stay':>11} {'balanced':>9} {'forecast':>9} {'moves':>6} {'KiB':>8}")
    for r, s in zip(rounds, stays["balance"]["rounds"]):
        print(f"  {r['step']:6} {s['imbalance']:11.3f} {r['imbalance']:9.3f} {r['forecast']:9.3f} {r['moves']:6} "
              f"{r['bytes'] / 1024:8.0f}")
    settled = [r["imbalance"] for r in rounds[3:] or rounds[-1:]]
    row = {
        "scene": scene,
        "rounds": len(rounds),
        "unbalanced_max": max(r["imbalance"] for r in stays["balance"]["rounds"]),
        "first": rounds[0]["imbalance"],
        "settled_median": statistics.median(settled),
        "settled_max": max(settled),
        "over_1.08": sum(i > 1.08 for i in settled) / len(settled),
        "moves": summary["load"]["migrations"],
        "bytes": summary["balance"]["moved_bytes"],
        "time_share": balancing,
        "speed_up": stays["loop_wall_s"] / summary["loop_wall_s"],
        "state_hash": sorted({summary["state_hash"], stays["state_hash"]}),
    }
    print(f"  owners stay: at most {row['unbalanced_max']:.2f}; balanced: {row['first']:.2f} at first, after three rounds "
          f"median {row['settled_median']:.3f}, at most {row['settled_max']:.3f}, {100 * row['over_1.08']:.0f} % of rounds over "
          f"1.08; {row['moves']} moves, {row['bytes'] / 2**20:.1f} MiB")
    print(f"  balancing takes {100 * balancing:.2f} % of the time; {row['speed_up']:.2f} times as fast as with owners that "
          f"stay; state hash {' '.join(row['state_hash'])}\n", flush=True)
    return row


def balance(arguments):
    rows = []
    for scene in arguments.scenes.split(",") if arguments.scenes else BALANCE:
        steps, options = BALANCE[scene]
        options = options + ["--threads", "1", "--steps", str(arguments.steps or steps)]
        options += ["--set", f"count={arguments.count}"] if arguments.count else []
        print(f"  {scene} ...", file=sys.stderr)
        stays, balanced = (run(arguments.moraine, scene, options + ["--balancer", b], arguments.ranks)
                           for b in ("none", "refine"))
        if not balanced["balance"]["rounds"]:
            sys.exit(f"bench: {scene} saw no balance in {balanced['steps']} steps, expected more steps (--steps)")
        rows.append(balance_row(scene, balanced, stays))
    return rows


def utilisation(arguments):
    """Sub-models on ranks x threads, balanced and hybrid, beside owners that stay and a barrier."""
    rows = []
    for parts, ranks, threads, bound in ((7, 2, 1, 0.875), (7, 1, 2, 1.0), (28, 2, 1, 1.0)):
        base = common(arguments, 21_000, 64) + ["--sub-models", str(parts), "--split", "slabs", "--threads", str(threads)]
        layout = f"{parts} on {ranks} x {threads}"
        cases = [(layout, base, ranks), (layout + ", none, barrier", base + ["--balancer", "none", "--scheduler", "barrier"], ranks)]
        for name, runs in measure(arguments, "dam", cases).items():
            row = {
                "case": name,
                "utilisation": statistics.median(s["load"]["utilisation"] for s in runs),
                "bound": bound,
                "loop_wall_s": statistics.median(s["loop_wall_s"] for s in runs),
                "state_hash": " ".join(sorted({s["state_hash"] for s in runs})),
            }
            rows.append(row)
    print(f"{'sub-models on ranks x threads':32} {'utilis.':>8} {'bound':>6} {'loop s':>8}  state hash")
    for r in rows:
        print(f"{r['case']:32} {r['utilisation']:8.3f} {r['bound']:6.3f} {r['loop_wall_s']:8.3f}  {r['state_hash']}")
    return rows


def ranks(arguments):
    rows = utilisation(arguments)
    base = ["--set", f"count={arguments.pair_count}", "--steps", str(arguments.steps or 40)]
    cases = [("2 ranks x 1 thread", base + ["--threads", "1"], 2), ("1 rank x 2 threads", base + ["--threads", "2"])]
    results = measure(arguments, "dam", cases)
    pairs = [a["loop_wall_s"] / b["loop_wall_s"] for a, b in zip(*results.values())]
    rows += table(results, cases[1][0])
    print(f"ratio of the times, 2 x 1 over 1 x 2: median {statistics.median(pairs):.3f} of {len(pairs)} pairs: "
          + " ".join(f"{p:.3f}" for p in pairs))
    return rows
