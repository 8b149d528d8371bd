# SPDX-License-Identifier: Apache-2.0
"""The other codes. Each prints "Loop time of SECONDS" and writes the last positions to the file `final`."""
from typing import Callable, NamedTuple


def lammps(program, script, variables):
    command = [program, "-in", script, "-log", "none"]
    for name, value in variables.items():
        command += ["-var", name, str(value)]
    return command


def yade(program, script, variables):
    return [program, "-n", "-x", "-j1", script] + [f"{name}={value}" for name, value in variables.items()]


def stock_bullet(program, script, variables):
    return [program, variables["layout"], variables["final"]] + [f"{k}={v}" for k, v in variables.items()]


class Code(NamedTuple):
    program: str
    source: str        # where it is from
    script: str
    command: Callable  # of the program, the script and the variables of the dam
    dt: float = 0      # s; 0: a tenth of the contact time


CODES = {
    "lammps": Code("lmp", "Debian package lammps", "dam.lammps", lammps),
    "liggghts": Code("liggghts", "Debian package liggghts", "dam.liggghts", lammps),
    "stock_bullet": Code("stock_bullet", "is built with moraine", "dam.bullet.cpp", stock_bullet, 1 / 120),
    "yade": Code("yade", "Debian package yade", "dam.yade.py", yade),
}
