# SPDX-License-Identifier: Apache-2.0
"""The table of docs/accuracy.md and the list of what is missed."""
from reports import write_tables

from .rows import ENGINES

BEGIN, END = "<!-- collective -->", "<!-- collective end -->"


def table(case_rows):
    yield "| case | answer | tolerance | " + " | ".join(f"`{e}`" for e in ENGINES) + " |"
    yield "|---" * (len(ENGINES) + 3) + "|"
    for case, rows in case_rows.items():
        for row in rows:
            cells = " | ".join(row.cell(e) for e in ENGINES)
            yield f"| {case.TITLE}, {row.name} | {row.answer} | {row.tolerance} | {cells} |"


def misses(case_rows):
    """Lines with causes, and what has none. A case's CAUSES say: the row begins with, engine, how ("" for any), cause."""
    known, unknown = {}, []
    for case, rows in case_rows.items():
        for row in rows:
            for engine, how in row.misses():
                cause = next((c for name, e, h, c in case.CAUSES
                              if row.name.startswith(name) and e in (engine, "") and h in (how, "")), None)
                if cause:
                    known.setdefault((case.TITLE, cause), {}).setdefault(row.name, []).append(f"`{engine}` {how}")
                else:
                    unknown.append(f"{case.TITLE}, {row.name}: {engine} {how}")
    lines = [f"- {title}, " + "; ".join(f"{name} ({', '.join(who)})" for name, who in where.items()) + f": {cause}"
             for (title, cause), where in known.items()]
    return lines, unknown


def text(case_rows):
    lines, unknown = misses(case_rows)
    return [*table(case_rows), "", "What is missed, and why:" if lines else "Nothing is missed.", "", *lines], unknown


def write(lines):
    write_tables("accuracy.md", "\n" + "\n".join(lines).rstrip() + "\n\n", BEGIN, END)
