# SPDX-License-Identifier: Apache-2.0
"""Loads that move, and sub-models on ranks and threads."""
import statistics
import sys

from .runs import measure, table

# Scenes for balancers: balancer, ranks, steps, options. Owners stated at the start put four fifths of the sub-models on one
# rank. When a heap lands, whole regions cost more at once: `greedy` gives every region to both ranks.
EVERY = ["--balance-every", "12"]
HEAP = EVERY + ["--set", "count=10000", "--sub-models", "40", "--set", "run.owners=[32,8]"]
BALANCE = {
    "uneven": ("uneven", "refine", 4, 400, EVERY + ["--set", "heaps=40", "--set", "rod=0.84", "--set", "width=0.14"]),
    "dam": ("dam", "refine", 2, 300, EVERY + ["--sub-models", "16", "--set", "run.owners=[13,3]"]),
    "heap": ("heap", "greedy", 2, 400, HEAP),
    "heap_refine": ("heap", "refine", 2, 400, HEAP),
    "deposit": ("deposit", "refine", 2, 480, EVERY),
    "crust_small": ("crust_small", "refine", 2, 60, ["--balance-every", "4", "--sub-models", "8"]),
}
BALANCED = 1.08


def since_uneven(rounds, stays):
    """Rounds from the first one on in which owners that stay are half as busy again as they should be; all if none is."""
    return rounds[next((i for i, imbalance in enumerate(stays) if imbalance >= 1.5), 0):]


def since_balanced(rounds):
    """How many rounds pass until one is balanced, and that one and those after it; the last one if none is."""
    within = next((i for i, imbalance in enumerate(rounds) if imbalance <= BALANCED), len(rounds))
    return within, rounds[within:] or rounds[-1:]


def over(rounds):
    return sum(i > BALANCED for i in rounds) / len(rounds)


def by_round(runs, key):
    """Per balance round, what every run says of it: which rounds there are depends on the answer alone."""
    return list(zip(*([r[key] for r in s["balance"]["rounds"]] for s in runs)))


def medians(rounds):
    return [statistics.median(values) for values in rounds]


def balance_row(scene, runs, stays):
    steps = [r["step"] for r in runs[0]["balance"]["rounds"]]
    each = by_round(runs, "imbalance")
    stay, balanced = medians(by_round(stays, "imbalance")), medians(each)
    columns = (steps, stay, balanced, each, medians(by_round(runs, "forecast")),
               medians(by_round(runs, "moves")), medians(by_round(runs, "bytes")))
    print(f"{scene}: {runs[0]['elements']} elements, {runs[0]['sub_models']} sub-models, {runs[0]['ranks']} ranks, medians of {len(runs)}")
    print(f"  {'step':>6} {'owners stay':>11} {'balanced':>9} {'least':>7} {'most':>7} {'forecast':>9} {'moves':>6} {'KiB':>8}")
    for step, s, b, all_runs, forecast, moves, size in zip(*columns):
        print(f"  {step:6} {s:11.3f} {b:9.3f} {min(all_runs):7.3f} {max(all_runs):7.3f} {forecast:9.3f} {moves:6.0f} {size / 1024:8.0f}")
    within, settled = since_balanced(since_uneven(balanced, stay))
    single = [i for run in zip(*each) for i in since_balanced(since_uneven(run, stay))[1]]
    row = {
        "scene": scene,
        "rounds": len(steps),
        "unbalanced_max": max(stay),
        "rounds_to_balance": within,
        "settled_median": statistics.median(settled),
        "settled_max": max(settled),
        "over": over(settled),
        "over_single": over(single),
        "single_max": max(single),
        "moves": statistics.median(s["load"]["migrations"] for s in runs),
        "bytes": statistics.median(s["balance"]["moved_bytes"] for s in runs),
        "time_share": statistics.median(s["balance"]["seconds"] / s["loop_wall_s"] for s in runs),
        "speed_up": statistics.median(a["loop_wall_s"] / b["loop_wall_s"] for a, b in zip(stays, runs)),
        "state_hash": sorted({s["state_hash"] for s in runs + stays}),
    }
    print(f"  owners stay: at most {row['unbalanced_max']:.2f}; balanced: at most {BALANCED} {within} round(s) after that is 1.5, "
          f"from then on median {row['settled_median']:.3f}, at most {row['settled_max']:.3f}, {100 * row['over']:.0f} % of rounds "
          f"over {BALANCED} (of single runs {100 * row['over_single']:.0f} %, at most {row['single_max']:.3f}); "
          f"{row['moves']:.0f} moves, {row['bytes'] / 2**20:.1f} MiB")
    print(f"  balancing takes {100 * row['time_share']:.2f} % of the time; {row['speed_up']:.2f} times as fast as with owners that "
          f"stay; state hash {' '.join(row['state_hash'])}\n", flush=True)
    return row


def balance(arguments):
    rows = []
    for name in arguments.scenes.split(",") if arguments.scenes else BALANCE:
        scene, balancer, ranks, steps, options = BALANCE[name]
        options = options + ["--threads", "1", "--steps", str(arguments.steps or steps)]
        cases = [(b, options + ["--balancer", b], ranks) for b in ("none", balancer)]
        stays, balanced = measure(arguments, scene, cases).values()
        if not balanced[0]["balance"]["rounds"]:
            sys.exit(f"bench: {name} saw no balance in {balanced[0]['steps']} steps, expected more steps (--steps)")
        rows.append(balance_row(name, balanced, stays))
    return rows


def utilisation(arguments):
    """Equal sub-models on ranks x threads, balanced and hybrid, beside owners that stay and a barrier."""
    rows = []
    for parts, ranks, threads, bound in ((7, 2, 1, 0.875), (7, 1, 2, 1.0), (28, 2, 1, 1.0)):
        base = ["--steps", str(arguments.steps or 240), "--sub-models", str(parts), "--threads", str(threads)]
        layout = f"{parts} on {ranks} x {threads}"
        cases = [(layout, base, ranks), (layout + ", none, barrier", base + ["--balancer", "none", "--scheduler", "barrier"], ranks)]
        for name, runs in measure(arguments, "bed", cases).items():
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
