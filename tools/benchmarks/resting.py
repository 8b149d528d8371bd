# SPDX-License-Identifier: Apache-2.0
"""What skipping rest saves, and what it changes."""
import statistics

from .runs import measure

UNTIL = (16, 24)  # s; the bed has settled before


def rest(arguments):
    """A bed of 40 sections that is pushed at one end: cost between two times after it has settled, with and without skipping."""
    cases = {}
    for threshold in ("0", "0.02"):
        for until in UNTIL:
            cases[(threshold, until)] = ["--threads", "1", "--skip-threshold", threshold, "--set", "sections=40",
                                         "--set", f"time.duration={until}"]
    runs = measure(arguments, "pushed_bed", [(key, options) for key, options in cases.items()])
    rows = []
    print(f"{'threshold':>9} {'rested':>7} {'loop s':>7} {'ratio':>6} {'com x':>9} {'com z':>8} {'z95':>8} {'lost momentum':>14}"
          "  state hash")
    for threshold, until in [key for key in cases if key[1] == UNTIL[1]]:
        early, late = runs[(threshold, UNTIL[0])], runs[(threshold, until)]
        loop = statistics.median(b["loop_wall_s"] - a["loop_wall_s"] for a, b in zip(early, late))
        share = (late[0]["rested"] * until - early[0]["rested"] * UNTIL[0]) / (until - UNTIL[0])
        row = {"threshold": threshold, "rested": share, "loop_wall_s": loop, "com": late[0]["center_of_mass"],
               "z95": late[0]["quantiles"]["95"][2], "momentum_residual": late[0]["momentum_residual"]["linear"],
               "state_hash": late[0]["state_hash"]}
        row["ratio"] = loop / (rows[0]["loop_wall_s"] if rows else loop)
        rows.append(row)
        print(f"{threshold:>9} {share:7.3f} {loop:7.2f} {row['ratio']:6.3f} {row['com'][0]:9.4f} {row['com'][2]:8.4f} "
              f"{row['z95']:8.4f} {row['momentum_residual']:14.1e}  {row['state_hash']}")
    return rows
