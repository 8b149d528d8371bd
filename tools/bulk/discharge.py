# SPDX-License-Identifier: Apache-2.0
"""How fast a silo runs out, and how that grows with its opening: Beverloo et al. (1961)."""
import dataclasses
import math

from . import frames
from .rows import Row, by_seed, with_settings

TICK = 1 / math.sqrt(9.81)
EMPTY_ANNULUS = 1.4        # k: as much of the opening lets nothing through, in grains


@dataclasses.dataclass(frozen=True)
class Discharge:
    opening: str           # the scene's name for it
    sizes: tuple           # diameters
    exponent: float        # of the rate
    settled: float         # ticks; then the flap goes
    begin: float           # ticks after that; from when, and for how long the rate is measured, twice
    window: float
    depth: float           # rates are volumes per tick and this
    fill: tuple            # a box in which the solid fraction is measured: from and to along x, y and z
    papers: str            # that say what the exponent is
    factor: tuple          # C: what it should be, its tolerance, and both as numbers

    def runs(self):
        """Their settings."""
        return tuple(((self.opening, size), ("flowing", self.begin + 2 * self.window + 1)) for size in self.sizes)

    def measure(self, folder, summary, settings):
        passed, solid = [], 0
        for step, path in frames.paths(folder):
            ticks = step * summary["dt"] / TICK - self.settled
            if ticks < self.begin - 0.1:
                continue
            spheres = frames.read(path)
            solid = solid or self.fraction(spheres)
            passed.append((ticks, sum(s.volume for s in spheres if s.z < -1) / self.depth))
        begin, middle, end = (self.begin + n * self.window for n in range(3))
        early = [p for p in passed if begin - 0.1 <= p[0] <= middle + 0.1]
        late = [p for p in passed if middle - 0.1 <= p[0] <= end + 0.1]
        return {"early": frames.line(early)[0], "late": frames.line(late)[0], "solid": solid}

    def fraction(self, spheres):
        inside = [s for s in spheres if all(a <= at <= b for at, (a, b) in zip((s.x, s.y, s.z), self.fill))]
        return sum(s.volume for s in inside) / math.prod(b - a for a, b in self.fill)

    def of_sizes(self, results, value):
        """Per size, values by engine and how."""
        return {size: by_seed(with_settings(results, **{self.opening: size}), value) for size in self.sizes}

    def rows(self, results):
        answer, tolerance, low, high = self.factor
        rates = self.of_sizes(results, lambda r: 0.5 * (r["early"] + r["late"]))
        solids = self.of_sizes(results, lambda r: r["solid"])
        power = Row(f"exponent of the rate against {self.opening} - 1.4 d", f"{2 * self.exponent:.0f}/2: {self.papers}", "± 0.25")
        c = Row(f"C of C phi sqrt(g) ({self.opening} - 1.4 d)^({2 * self.exponent:.0f}/2)", answer, tolerance)
        for key in rates[self.sizes[0]]:
            seeds = range(len(rates[self.sizes[0]][key]))
            power.add(key, [self.power({s: rates[s][key][n] for s in self.sizes}) for n in seeds],
                      self.exponent - 0.25, self.exponent + 0.25)
            c.add(key, [sum(rates[s][key][n] / solids[s][key][n] / (s - EMPTY_ANNULUS) ** self.exponent for s in self.sizes)
                        / len(self.sizes) for n in seeds], low, high)
        steady = Row("what passes later / earlier, less 1, all openings together", "0: not the fill decides", "± 0.03")
        late, early = (self.together(results, window) for window in ("late", "early"))
        for key in late:
            steady.add(key, [a / b - 1 for a, b in zip(late[key], early[key])], -0.03, 0.03)
        return [power, c, steady]

    @staticmethod
    def power(rates):
        return frames.line([(math.log(size - EMPTY_ANNULUS), math.log(rate)) for size, rate in rates.items()])[0]

    def together(self, results, window):
        """Rates of all sizes added up, by seed."""
        own = self.of_sizes(results, lambda r: r[window])
        return {key: [sum(each) for each in zip(*(own[s][key] for s in self.sizes))] for key in own[self.sizes[0]]}
