# SPDX-License-Identifier: Apache-2.0
"""How far a column runs out, and whether it has come to rest."""
import math

from . import frames
from .runs import Job
from .rows import Row, by_seed, with_settings

TITLE = "C5 column"
LENGTH, WIDTH = 20, 4
ASPECTS = {"impulse": (0.5, 1, 2, 4), "bullet": (0.5, 1), "soft_sphere": (0.5, 1)}
STEPS = {"soft_sphere": (("dt", 5e-4),)}
PAPERS = "Lube et al. (2005), Lajeunesse et al. (2005)"


def jobs(seeds):
    for engine, aspects in ASPECTS.items():
        for how in ("whole",) if engine == "soft_sphere" else ("whole", "cut"):
            for aspect in aspects:
                for seed in range(1, seeds + 1):
                    yield Job("column", engine, how, seed, (("aspect", aspect), *STEPS.get(engine, ())))


def front(spheres):
    """Where the slices end that hold at least half a layer of grains."""
    depth, i = frames.depths(spheres, 1, WIDTH), 0
    while depth.get(i, 0) >= math.pi / 12:
        i += 1
    return i


def height(spheres):
    """Of the highest grains at the wall: mean of five."""
    return sum(sorted(s.z + s.radius for s in spheres if s.x < 3)[-5:]) / 5


def measure(folder, summary, settings):
    found = frames.paths(folder)
    settled = 4 * math.sqrt(settings["aspect"] * LENGTH / 9.81) + 4
    kinetic, standing = [], None
    for step, path in found:
        if step * summary["dt"] < settled - 0.5:
            continue
        spheres = frames.read(path)
        standing = standing or height(spheres)
        kinetic.append(sum(s.kinetic() for s in spheres))
    return {"run_out": (front(spheres) - LENGTH) / LENGTH, "height": height(spheres) / LENGTH, "aspect": standing / LENGTH,
            "left": kinetic[-1] / max(kinetic)}


def lube(a):
    return 1.2 * a if a < 1.8 else 1.9 * a ** (2 / 3)


def lajeunesse(a):
    return 1.8 * a if a < 3 else 2.3 * a ** (2 / 3)


def rows(results):
    for a in ASPECTS["impulse"]:
        low, high = sorted((lube(a), lajeunesse(a)))
        row = Row(f"run-out, a = {a:g}", f"{low:.2g} to {high:.2g}: {PAPERS}", "± 25 %, springs 15 %")
        for key, values in by_seed(with_settings(results, aspect=a), lambda r: r["run_out"]).items():
            slack = 0.15 if key[0] == "soft_sphere" else 0.25
            row.add(key, values, (1 - slack) * low, (1 + slack) * high)
        yield row
    yield exponent(results)
    for name, chosen in (("a = 0.5", lambda a: a < 1), ("a from 1 on", lambda a: a >= 1)):
        own = {j: r for j, r in results.items() if chosen(dict(j.settings)["aspect"])}
        row = Row(f"motion left, {name}", "at rest after 10 sqrt(H/g)", "1e-4 of the largest kinetic energy, mean")
        for key, values in by_seed(own, lambda r: r["left"]).items():
            row.add(key, [sum(values) / len(values)], 0, 1e-4)
        yield row


def exponent(results):
    row = Row("exponent of run-out, a = 2 to 4", "2/3: both", "± 0.15")
    of = {a: by_seed(with_settings(results, aspect=a), lambda r: r["run_out"]) for a in (2, 4)}
    for key in of[4]:
        row.add(key, [math.log2(far / near) for near, far in zip(of[2][key], of[4][key])], 2 / 3 - 0.15, 2 / 3 + 0.15)
    return row


CAUSES = [
    ("exponent", "impulse", "", "smooth walls make it a wide channel, for which Balmforth & Kerswell (2005) find 0.9 ± 0.1, and 0.65 ± 0.05 for a narrow one; "
     "with friction on the walls it is 0.67 (run-outs 1.85 and 2.95, one seed). The size matters less: 0.93 for a column 30 diameters long"),
    ("motion left, a = 0.5", "", "", "one or two spheres still roll down the slope, 0.2 % of the little that falls"),
]
