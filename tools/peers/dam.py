# SPDX-License-Identifier: Apache-2.0
"""apps/scenes/dam.yaml as codes with springs and dashpots have it: where its spheres start, and its contacts."""
import math
import os
import re
import subprocess

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
SCENE = os.path.join(ROOT, "apps/scenes/dam.yaml")
GRAVITY, RESTITUTION = 9.81, 0.5


def parameters(count, seed):
    """The scene's `parameters:`, worked out in order with these two in place of its own."""
    names = {"cbrt": lambda x: x ** (1 / 3), "ceil": math.ceil, "round": round, "sqrt": math.sqrt}
    text = re.search(r"^parameters:\n((?:  .*\n)+)", open(SCENE, encoding="utf-8").read(), re.M).group(1)
    values = {}
    for name, expression in re.findall(r"^  (\w+): ([^#\n]+)", text, re.M):
        given = {"count": count, "seed": seed}.get(name)
        values[name] = given if given is not None else eval(expression, {"__builtins__": {}}, {**names, **values})
    return values


def start(moraine, count, seed, folder):
    """Spheres at the start: [id, radius, x, y, z], as moraine lays them out."""
    command = [moraine, "run", SCENE, "--engine", "impulse", "--steps", "1", "--output-every", "0", "--quiet", "--out", folder,
               "--set", "output.pictures=false", "--set", "output.formats=[lammps_dump]",
               "--set", f"count={count}", "--set", f"seed={seed}"]
    subprocess.run(command, check=True)
    lines = open(os.path.join(folder, "dump.lammpstrj"), encoding="utf-8").read().splitlines()
    columns = lines[8].split()[2:]
    at = [columns.index(c) for c in ("id", "radius", "x", "y", "z")]
    return [[float(row.split()[c]) for c in at] for row in lines[9:9 + int(lines[3])]]


def write_layout(path, spheres, p):
    """A data file of LAMMPS: id, type, diameter, density, x, y, z."""
    density = 6 / math.pi
    with open(path, "w", encoding="utf-8") as f:
        f.write(f"dam\n\n{len(spheres)} atoms\n1 atom types\n\n0 {3 * p['length']!r} xlo xhi\n0 {p['width']!r} ylo yhi\n"
                f"0 {2 * p['layers'] + 20} zlo zhi\n\nAtoms\n\n")
        for number, radius, x, y, z in spheres:
            f.write(f"{int(number) + 1} 1 {2 * radius!r} {density!r} {x!r} {y!r} {z!r}\n")


def contacts(stiffness, dt):
    """For spheres of 1 m and 1 kg, stiffness in m g / d: that in N/m, the damping per reduced mass in 1/s that gives the
    restitution of two spheres (Antypov & Elliott 2011), and the step, a tenth of the contact time unless given."""
    stiffness, reduced = stiffness * GRAVITY, 0.5
    ratio = -math.log(RESTITUTION) / math.hypot(math.pi, math.log(RESTITUTION))
    frequency = math.sqrt(stiffness / reduced)
    contact_time = math.pi / (frequency * math.sqrt(1 - ratio * ratio))
    return {"stiffness": stiffness, "damping": 2 * ratio * frequency, "dt": dt or 0.1 * contact_time}


def result(path, count):
    """Centre of mass and x95 of a file that ends with `count` rows of id, x, y, z."""
    rows = [[float(v) for v in line.split()] for line in open(path, encoding="utf-8").read().splitlines()[-count:]]
    x = sorted(r[1] for r in rows)
    return {"elements": len(rows), "center_of_mass": [sum(r[k] for r in rows) / len(rows) for k in (1, 2, 3)],
            "x95": x[math.ceil(0.95 * len(x)) - 1]}
