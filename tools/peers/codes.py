# SPDX-License-Identifier: Apache-2.0
"""The other codes: the name of the program, and how it is told to run its script for the dam with these variables. Each
prints "Loop time of SECONDS" and writes the last positions to the file `final`."""


def lammps(program, script, variables):
    command = [program, "-in", script, "-log", "none"]
    for name, value in variables.items():
        command += ["-var", name, str(value)]
    return command


def yade(program, script, variables):
    return [program, "-n", "-x", "-j1", script] + [f"{name}={value}" for name, value in variables.items()]


CODES = {
    "lammps": ("lmp", "dam.lammps", lammps),
    "liggghts": ("liggghts", "dam.liggghts", lammps),
    "yade": ("yade", "dam.yade.py", yade),
}
