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


def causes_of(case, row, engine, how):
    """Those of the case's CAUSES that may be why it is missed. They say: the row begins with, engine, how ("" for any), how far
    the figure may be outside its tolerance, in its unit, and the cause."""
    return [c for c in case.CAUSES if row.name.startswith(c[0]) and c[1] in (engine, "") and c[2] in (how, "")]


def misses(case_rows):
    """Lines with causes; what has none, or is missed by more than that explains; causes of nothing."""
    known, unknown, idle = {}, [], []
    for case, rows in case_rows.items():
        used = []
        for row in rows:
            for engine, how in row.misses():
                excess, causes = row.excess((engine, how)), causes_of(case, row, engine, how)
                enough = [c for c in causes if excess <= c[3]][:1]
                used += enough or causes
                if enough:
                    known.setdefault((case.TITLE, enough[0][4]), {}).setdefault(row.name, []).append(f"`{engine}` {how}")
                else:
                    unknown.append(f"{case.TITLE}, {row.name}: {engine} {how}, by {excess:.2g}")
        idle += [f"{case.TITLE}, " + " ".join(filter(None, c[:3])) for c in case.CAUSES if c not in used]
    lines = [f"- {title}, " + "; ".join(f"{name} ({', '.join(who)})" for name, who in where.items()) + f": {cause}"
             for (title, cause), where in known.items()]
    return lines, unknown, idle


def worse(case_rows):
    """What an engine meets whole and misses cut."""
    return [f"{case.TITLE}, {row.name} (`{engine}`)" for case, rows in case_rows.items() for row in rows
            for engine, how in row.misses() if how == "cut" and (engine, "whole") in row.values and not row.missed((engine, "whole"))]


def text(case_rows):
    """Lines of the table and of the list; misses of which no cause is known; causes of which there is no miss; what is worse cut."""
    lines, *wrong = misses(case_rows)
    cut = worse(case_rows)
    return [*table(case_rows), "", f"Met whole and missed cut: {'; '.join(cut) or 'nothing'}.", "",
            "What is missed, and why:" if lines else "Nothing is missed.", "", *lines], *wrong, cut


def write(lines):
    write_tables("accuracy.md", "\n" + "\n".join(lines).rstrip() + "\n\n", BEGIN, END)
