# SPDX-License-Identifier: Apache-2.0
"""What frames of a run say: places and speeds of spheres, profiles, slopes."""
import csv
import glob
import math
import operator
import os


FIELDS = ("x", "y", "z", "radius", "vx", "vy", "vz", "wx", "wy", "wz")


class Sphere:
    """Place, radius, velocity and spin; equal densities, so volumes stand for masses."""
    __slots__ = ("x", "y", "z", "radius", "velocity", "spin")

    def __init__(self, *values):
        self.x, self.y, self.z, self.radius = values[:4]
        self.velocity, self.spin = values[4:7], values[7:]

    @property
    def volume(self):
        return 4 / 3 * math.pi * self.radius**3

    def kinetic(self):
        """Per density."""
        squares = sum(v * v for v in self.velocity) + 0.4 * self.radius**2 * sum(w * w for w in self.spin)
        return 0.5 * self.volume * squares


def weight(spheres):
    """Of spheres of density 6 / pi, so that one of unit diameter weighs 9.81 N."""
    return 6 / math.pi * sum(s.volume for s in spheres) * 9.81


def paths(folder):
    """Of all frames, with their steps."""
    found = glob.glob(os.path.join(folder, "frames", "elements_*.csv"))
    return sorted((int(os.path.basename(p)[9:-4]), p) for p in found)


def read(path):
    with open(path) as f:
        rows = csv.reader(f)
        names = next(rows)
        chosen = operator.itemgetter(*map(names.index, FIELDS))
        return [Sphere(*map(float, chosen(row))) for row in rows]


def last(folder):
    return read(paths(folder)[-1][1])


def line(points):
    """Least squares: slope and value at 0."""
    n = len(points)
    mx, my = sum(p[0] for p in points) / n, sum(p[1] for p in points) / n
    slope = sum((x - mx) * (y - my) for x, y in points) / sum((x - mx) ** 2 for x, _ in points)
    return slope, my - slope * mx


def at(folder, summary, time):
    """The first frame at that time or after it."""
    return read(next(path for step, path in paths(folder) if step * summary["dt"] >= time - 1e-6))


def tops(spheres, pitch):
    """Highest point of what lies in each slice of x, by the slice's number."""
    out = {}
    for s in spheres:
        i = math.floor(s.x / pitch)
        out[i] = max(out.get(i, -math.inf), s.z + s.radius)
    return out


def depths(spheres, distance, area):
    """Solid volume per area of the floor in each slice of one unit of distance, by the slice's number."""
    out = {}
    for s in spheres:
        i = math.floor(distance(s))
        out[i] = out.get(i, 0.0) + s.volume / area(i)
    return out


def rising_surface(spheres, wall, above):
    """Tops of slices of one diameter, from where all are higher than `above` to two diameters before a wall at x: places
    and heights."""
    top = tops([s for s in spheres if s.x < wall], 1)
    points = [(i + 0.5, top[i]) for i in sorted(top) if i + 1 <= wall - 2]
    return points[next(n for n in range(len(points)) if all(z > above for _, z in points[n:])):]


def slope(points):
    """Of the straight line through them [degrees]."""
    return math.degrees(math.atan(line(points)[0]))
