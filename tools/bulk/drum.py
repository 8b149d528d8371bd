# SPDX-License-Identifier: Apache-2.0
"""How steep the bed in a turning drum is, and whether the drum's work is what holds the bed beside the axis."""
import math

from . import frames
from .rows import Row, by_seed, row_of, with_settings
from .sweep import Sweep, jobs_of

TITLE = "C6 drum"
RADIUS, GRAVITY, SETTLED = 12, 9.81, 30
TICK = 1 / math.sqrt(GRAVITY)
DENSITY = 6 / math.pi
TURNS = {0.01: 1, 0.03: 1.5, 0.1: 2}  # by Froude number
CENTRIFUGES, AROUND = 3, 8            # a Froude number at which the innermost grains go round as well, and turns until all do
RUNS = tuple((("froude", froude), ("turns", turns)) for froude, turns in (*TURNS.items(), (CENTRIFUGES, AROUND)))
jobs = jobs_of("drum", Sweep(("impulse",), RUNS), Sweep(("bullet", "soft_sphere"), RUNS[1:2]), Sweep(("bullet64", "ode"), RUNS[1:2], seeds=1),
               Sweep(("bullet", "soft_sphere"), (RUNS[0], *RUNS[2:]), seeds=1))


def angular_momentum(spheres):
    """About the axis, y."""
    return DENSITY * sum(s.volume * (s.z * s.velocity[0] - s.x * s.velocity[2] + 0.4 * s.radius**2 * s.spin[1]) for s in spheres)


def beside(spheres):
    """Torque of gravity about the axis."""
    return DENSITY * GRAVITY * sum(s.volume * s.x for s in spheres)


def surface_angle(spheres):
    """Of the middle half of the surface; the drum lifts the side of lesser x [degrees]."""
    top = frames.tops([s for s in spheres if math.hypot(s.x, s.z) < RADIUS - 0.8], 1)
    points = [(i + 0.5, top[i]) for i in range(-RADIUS // 2, RADIUS // 2) if i in top]
    return abs(frames.slope(points))


def off_axis(spheres):
    """Distance of the centre of mass from the axis [R]."""
    mass = sum(s.volume for s in spheres)
    return math.hypot(sum(s.volume * s.x for s in spheres), sum(s.volume * s.z for s in spheres)) / mass / RADIUS


def measure(folder, summary, settings):
    """The balance holds over the whole turning: work / spin = change of angular momentum + integral of gravity's torque."""
    begin, spin = SETTLED * TICK, math.sqrt(settings["froude"] / RADIUS) / TICK
    times, torques, angles, momenta = [], [], [], []
    for step, path in frames.paths(folder):
        time = step * summary["dt"]
        if time < begin - 0.5 * TICK:
            continue
        spheres = frames.read(path)
        times.append(time)
        torques.append(beside(spheres))
        momenta.append(angular_momentum(spheres))
        angles.append(surface_angle(spheres))
    held = sum(0.5 * (a + b) * (t - s) for a, b, s, t in zip(torques, torques[1:], times, times[1:]))
    late = angles[len(angles) // 2:]
    return {"angle": sum(late) / len(late), "off_axis": off_axis(spheres), "balance": summary["energy"]["work_of_boundaries"] / spin / (momenta[-1] - momenta[0] - held),
            "frames": len(times)}


def rows(results):
    means = {}
    for froude in TURNS:
        own = by_seed(with_settings(results, froude=froude), lambda r: r["angle"])
        row = Row(f"angle of the surface, Fr = {froude:g} [°]", "", "")
        for key, values in own.items():
            row.add(key, values, 0, 90)
            means.setdefault(key, []).append(sum(values) / len(values))
        yield row
    row = Row("rise of the angle, the lesser of both [°]", "rises with Fr: Mellmann (2001)", "> 0")
    for key, own in means.items():
        if len(own) > 1:
            row.add(key, [min(b - a for a, b in zip(own, own[1:]))], 0, 90)
    yield row
    yield row_of("centre of mass beside the axis, Fr = 3 [R]", "0, all go round: Mellmann (2001)", "0.05",
                 with_settings(results, froude=CENTRIFUGES), lambda r: r["off_axis"], 0, 0.05)
    # Frames are too few for the torque of a bed that goes round.
    bedded = {j: r for j, r in results.items() if dict(j.settings)["froude"] in TURNS}
    row = Row("work of the drum / (weight beside the axis, spin-up), less 1, Fr to 0.1", "0: angular momentum", "± 0.05, springs 0.02")
    for key, values in by_seed(bedded, lambda r: r["balance"] - 1).items():
        slack = 0.02 if key[0] == "soft_sphere" else 0.05
        row.add(key, values, -slack, slack)
    yield row


CAUSES = []
