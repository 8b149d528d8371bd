# SPDX-License-Identifier: Apache-2.0
"""The collapse of apps/scenes/dam.yaml in YADE: linear springs and dashpots with tangential history. The variables are those
of dam.lammps."""
import math
import sys
import time

from yade import (Bo1_Sphere_Aabb, Bo1_Wall_Aabb, ForceResetter, Ig2_Sphere_Sphere_ScGeom, Ig2_Wall_Sphere_ScGeom,
                  InsertionSortCollider, InteractionLoop, Ip2_ViscElMat_ViscElMat_ViscElPhys, Law2_ScGeom_ViscElPhys_Basic,
                  NewtonIntegrator, O, ViscElMat, utils)

given = dict(text.split("=", 1) for text in sys.argv[1:])
stiffness, damping, friction = (float(given[name]) for name in ("stiffness", "damping", "friction"))


def read_layout(path):
    """Rows of id, type, diameter, density, x, y, z."""
    text = open(path, encoding="utf-8").read().split("Atoms\n\n")[1]
    return [[float(v) for v in row.split()] for row in text.splitlines()]


def material(normal_damping, density):
    """Two of these in series have half of each; a wall without damping leaves the sphere's."""
    return O.materials.append(ViscElMat(kn=2 * stiffness, ks=2 * stiffness * 2 / 7, cn=normal_damping, cs=normal_damping / 2,
                                        frictionAngle=math.atan(friction), density=density))


rows = read_layout(given["layout"])
density = rows[0][3]
sphere, wall = material(damping, density), material(0, density)
for _, _, diameter, _, x, y, z in rows:
    O.bodies.append(utils.sphere((x, y, z), diameter / 2, material=sphere))
for place, axis in ((0, 0), (given["length"], 0), (0, 1), (given["width"], 1), (0, 2)):
    O.bodies.append(utils.wall(float(place), axis, material=wall))

O.engines = [
    ForceResetter(),
    InsertionSortCollider([Bo1_Sphere_Aabb(), Bo1_Wall_Aabb()], verletDist=float(given["skin"]) / 2),
    InteractionLoop([Ig2_Sphere_Sphere_ScGeom(), Ig2_Wall_Sphere_ScGeom()], [Ip2_ViscElMat_ViscElMat_ViscElPhys()],
                    [Law2_ScGeom_ViscElPhys_Basic()]),
    NewtonIntegrator(damping=0, gravity=(0, 0, -9.81)),
]
O.dt = float(given["dt"])
started = time.perf_counter()
O.run(int(given["steps"]), True)
print(f"Loop time of {time.perf_counter() - started}")

with open(given["final"], "w", encoding="utf-8") as f:
    for number in range(len(rows)):
        f.write(" ".join(str(v) for v in (number + 1, *O.bodies[number].state.pos)) + "\n")
