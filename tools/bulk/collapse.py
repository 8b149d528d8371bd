# SPDX-License-Identifier: Apache-2.0
"""How far what stood upright runs out when its support goes, and whether it has come to rest."""
import dataclasses
import math
from collections.abc import Callable

from . import frames
from .rows import Row, by_seed, with_settings


@dataclasses.dataclass(frozen=True)
class Collapse:
    length: float          # of what stands, from the wall or the axis, diameters
    aspects: tuple         # heights / length
    distance: Callable     # of a sphere from the wall or the axis
    area: Callable         # of the floor in slice n of one diameter
    settled: Callable      # of the aspect: time at which the support goes [s]
    laws: tuple            # run-out / length of the aspect, by different experiments
    papers: str
    power: float           # of the aspect, for tall ones

    def measure(self, folder, summary, settings):
        kinetic, standing, spheres = [], None, []
        for step, path in frames.paths(folder):
            if step * summary["dt"] < self.settled(settings["aspect"]) - 0.5:
                continue
            spheres = frames.read(path)
            standing = standing or self.height(spheres)
            kinetic.append(sum(s.kinetic() for s in spheres))
        return {"run_out": (self.front(spheres) - self.length) / self.length, "height": self.height(spheres) / self.length,
                "aspect": standing / self.length, "left": kinetic[-1] / max(kinetic)}

    def front(self, spheres):
        """Where the slices end that hold at least half a layer of grains."""
        depth, i = frames.depths(spheres, self.distance, self.area), 0
        while depth.get(i, 0) >= math.pi / 12:
            i += 1
        return i

    def height(self, spheres):
        """Of the highest grains at the wall or the axis: mean of five."""
        return sum(sorted(s.z + s.radius for s in spheres if self.distance(s) < 3)[-5:]) / 5

    def rows(self, results):
        for a in self.aspects:
            low, high = sorted(law(a) for law in self.laws)
            row = Row(f"run-out, a = {a:g}", f"{low:.2g} to {high:.2g}: {self.papers}", "± 25 %, springs 15 %")
            for key, values in by_seed(with_settings(results, aspect=a), lambda r: r["run_out"]).items():
                slack = 0.15 if key[0] == "soft_sphere" else 0.25
                row.add(key, values, (1 - slack) * low, (1 + slack) * high)
            yield row
        yield self.exponent(results)
        for name, chosen in (("a = 0.5", lambda a: a < 1), ("a from 1 on", lambda a: a >= 1)):
            own = {j: r for j, r in results.items() if chosen(dict(j.settings)["aspect"])}
            row = Row(f"motion left, {name}", "at rest after 10 sqrt(H/g)", "1e-4 of the largest kinetic energy, mean")
            for key, values in by_seed(own, lambda r: r["left"]).items():
                row.add(key, [sum(values) / len(values)], 0, 1e-4)
            yield row

    def exponent(self, results):
        row = Row("exponent of run-out, a = 2 to 4", f"{self.power:.2f}: both", "± 0.15")
        of = {a: by_seed(with_settings(results, aspect=a), lambda r: r["run_out"]) for a in (2, 4)}
        for key in of[4]:
            row.add(key, [math.log2(far / near) for near, far in zip(of[2][key], of[4][key])], self.power - 0.15, self.power + 0.15)
        return row


ROLLING = ("motion left, a = 0.5", "", "", 0.0025, "one or two spheres still roll down the slope, 0.2 % of the little that falls")
