# SPDX-License-Identifier: Apache-2.0
"""What a task costs."""
import json
import os
import subprocess
import sys

from .runs import SCHEDULERS, launcher

PATTERNS = ["trivial", "stencil", "tree", "random"]
LAYOUTS = [(1, 1), (1, 2), (2, 1), (4, 1)]  # ranks, threads


def task_bench(arguments, ranks, threads, pattern, kernel):
    """What task_bench says of all systems that can run so, which must have computed the same."""
    systems = [s for s in SCHEDULERS if s != "serial" or threads == 1]
    if ranks == 1:
        systems += ["tbb_flow_graph", "openmp_tasks"]
    command = [os.path.join(os.path.dirname(arguments.moraine), "task_bench"), "--pattern", pattern, "--kernel", kernel,
               "--threads", str(threads), "--repeats", str(arguments.repeats), "--system", ",".join(systems)]
    command = launcher(ranks) + command
    print(f"  {ranks} rank(s) x {threads}, {pattern}, {kernel} ...", file=sys.stderr)
    out = subprocess.run(command, check=True, capture_output=True, text=True).stdout
    rows = [json.loads(line) for line in out.splitlines()]
    answers = {}
    for row in rows:
        for size in row.get("sizes", []):
            if answers.setdefault(size[0], size[3]) != size[3]:
                sys.exit(f"tools/bench: {row['system']} computed something else than {rows[0]['system']}")
    return rows


def tasks(arguments):
    rows = []
    for ranks, threads in LAYOUTS:
        cases = [(p, k) for p in PATTERNS for k in ("empty", "fixed", "imbalanced")]
        columns = {}
        for pattern, kernel in cases:
            for row in task_bench(arguments, ranks, threads, pattern, kernel):
                rows.append(row)
                columns.setdefault(row["system"], []).append(row.get("metg_us", row.get("overhead_us")))
        print(f"\n{ranks} rank(s) x {threads} thread(s) on {rows[-1]['cores']} core(s): us of a core per empty task; METG(50 %) "
              f"in us for fixed and imbalanced tasks")
        print(f"{'':16}" + "".join(f"{p:^24}" for p in PATTERNS))
        for system, values in columns.items():
            print(f"{system:16}" + "".join(f"{v:8.2f}" if v is not None else f"{'-':>8}" for v in values))
    return rows
