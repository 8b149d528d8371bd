# SPDX-License-Identifier: Apache-2.0
"""Tests that leave rows of figures, and pages with tables of them."""
import os
import subprocess
import sys
import tempfile

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
MARK = "<!-- tables -->"


def rows_of(build, choice, variable):
    """Runs the chosen tests; returns the lines they left in the file that the variable names. A test that fails may have
    left none, so then this ends the program: no page is written without all rows."""
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "rows")
        open(path, "w").close()
        result = subprocess.run(["ctest", "--test-dir", build, *choice, "--no-tests=error", "-j1", "-Q"],
                                env={**os.environ, variable: path})
        with open(path) as f:
            lines = [line.rstrip("\n") for line in f]
    if result.returncode or not lines:
        sys.exit(f"{sys.argv[0]}: ctest {' '.join(choice)} in {build} has status {result.returncode} and left {len(lines)} rows; "
                 "no page is changed")
    return lines


def write_tables(page, text, begin=MARK, end=None):
    """Replaces all that is below the mark, or from one mark to the other."""
    path = os.path.join(ROOT, "docs", page)
    with open(path) as f:
        head, below = f.read().split(begin)
    with open(path, "w") as f:
        f.write(head + begin + "\n" + text + (end + below.split(end)[1] if end else ""))
