# SPDX-License-Identifier: Apache-2.0
"""Loads that move, and sub-models on ranks and threads."""
import statistics
import sys

from .runs import common, measure, run, table

# Scenes for balancers: balancer, ranks, steps, options. Owners stated at the start put four fifths of the sub-models on one
# rank. When a heap lands, whole regions cost more at once: `greedy` gives every region to both ranks.
EVERY = ["--balance-every", "12"]
HEAP = EVERY + ["--set", "count=10000", "--sub-models", "40", "--set", "run.owners=[32,8]"]
BALANCE = {
    "uneven": ("uneven", "refine", 2, 300, ["--balance-every", "4"]),
    "uneven_40": ("uneven", "refine", 4, 300, EVERY + ["--set", "heaps=40"]),
    "dam": ("dam", "refine", 2, 300, EVERY + ["--sub-models", "16", "--set", "run.owners=[13,3]"]),
    "heap": ("heap", "greedy", 2, 400, HEAP),
    "heap_refine": ("heap", "refine", 2, 400, HEAP),
    "deposit": ("deposit", "refine", 2, 480, EVERY),
    "crust_small": ("crust_small", "refine", 2, 60, ["--balance-every", "4", "--sub-models", "8"]),
}
BALANCED = 1.08


def since_uneven(rounds, stays):
    """Imbalances from the first round on in which owners that stay are half as busy again as they should be."""
    uneven = [i for i, s in enumerate(stays) if s["imbalance"] >= 1.5]
    return [r["imbalance"] for r in rounds[uneven[0]:]] if uneven else []


def balance_row(scene, summary, stays):
    rounds, balancing = summary["balance"]["rounds"], summary["balance"]["seconds"] / summary["loop_wall_s"]
    print(f"{scene}: {summary['elements']} elements, {summary['sub_models']} sub-models, {summary['ranks']} ranks")
    print(f"  {'step':>6} {'owners stay':>11} {'balanced':>9} {'forecast':>9} {'moves':>6} {'KiB':>8}")
    for r, s in zip(rounds, stays["balance"]["rounds"]):
        print(f"  {r['step']:6} {s['imbalance']:11.3f} {r['imbalance']:9.3f} {r['forecast']:9.3f} {r['moves']:6} "
              f"{r['bytes'] / 1024:8.0f}")
    since = since_uneven(rounds, stays["balance"]["rounds"]) or [r["imbalance"] for r in rounds]
    within = next((i for i, imbalance in enumerate(since) if imbalance <= BALANCED), len(since))
    settled = since[within:] or since[-1:]
    row = {
        "scene": scene,
        "rounds": len(rounds),
        "unbalanced_max": max(r["imbalance"] for r in stays["balance"]["rounds"]),
        "rounds_to_balance": within,
        "settled_median": statistics.median(settled),
        "settled_max": max(settled),
        "over": sum(i > BALANCED for i in settled) / len(settled),
        "moves": summary["load"]["migrations"],
        "bytes": summary["balance"]["moved_bytes"],
        "time_share": balancing,
        "speed_up": stays["loop_wall_s"] / summary["loop_wall_s"],
        "state_hash": sorted({summary["state_hash"], stays["state_hash"]}),
    }
    print(f"  owners stay: at most {row['unbalanced_max']:.2f}; balanced: at most {BALANCED} {within} round(s) after that is 1.5, "
          f"from then on median {row['settled_median']:.3f}, at most {row['settled_max']:.3f}, {100 * row['over']:.0f} % of rounds "
          f"over {BALANCED}; {row['moves']} moves, {row['bytes'] / 2**20:.1f} MiB")
    print(f"  balancing takes {100 * balancing:.2f} % of the time; {row['speed_up']:.2f} times as fast as with owners that "
          f"stay; state hash {' '.join(row['state_hash'])}\n", flush=True)
    return row


def balance(arguments):
    rows = []
    for name in arguments.scenes.split(",") if arguments.scenes else BALANCE:
        scene, balancer, ranks, steps, options = BALANCE[name]
        options = options + ["--threads", "1", "--steps", str(arguments.steps or steps)]
        print(f"  {name} ...", file=sys.stderr)
        stays, balanced = (run(arguments.moraine, scene, options + ["--balancer", b], ranks)
                           for b in ("none", balancer))
        if not balanced["balance"]["rounds"]:
            sys.exit(f"bench: {name} saw no balance in {balanced['steps']} steps, expected more steps (--steps)")
        rows.append(balance_row(name, balanced, stays))
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
