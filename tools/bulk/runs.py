# SPDX-License-Identifier: Apache-2.0
"""Runs of the collective cases, several at once, and what is left of each: its figures."""
import concurrent.futures
import dataclasses
import functools
import glob
import hashlib
import importlib
import itertools
import json
import os
import subprocess
import sys
import tempfile
import time

from reports import ROOT

SCENES = os.path.join(ROOT, "tests", "validation", "collective")
# Restitution 0.5 of springs and dashpots compares with 0 of impulses in dense flow, see apps/scenes/dam.yaml.
SETTINGS = {"soft_sphere": (("restitution", 0.5),)}
SUB_MODELS = {"whole": 1, "cut": 3}


@dataclasses.dataclass(frozen=True)
class Job:
    case: str       # the module of this package that has it; its scene has the same name
    engine: str
    how: str        # whole or cut
    seed: int
    settings: tuple = ()  # pairs of parameter and value

    def options(self):
        sets = [*self.settings, ("seed", self.seed), ("run.engine", self.engine), *SETTINGS.get(self.engine, ())]
        return [w for k, v in sets for w in ("--set", f"{k}={v}")] + ["--sub-models", str(SUB_MODELS[self.how])]

    def __str__(self):
        return " ".join([self.case, self.engine, self.how, *(f"{k}={v}" for k, v in self.settings), f"seed={self.seed}"])


def libraries(moraine):
    """Of engines, in order of names, where the program looks for them: see physics/plugin.cpp."""
    here = os.path.dirname(os.path.realpath(moraine))
    beside = (here, os.path.join(here, "lib", "moraine"), os.path.join(os.path.dirname(here), "lib", "moraine"))
    found = {}
    for folder in (os.environ["MORAINE_ENGINES"],) if "MORAINE_ENGINES" in os.environ else beside:
        for path in glob.glob(os.path.join(glob.escape(folder), "moraine_*.so")):
            found.setdefault(os.path.basename(path), path)
    return [found[name] for name in sorted(found)]


def digest(path):
    state = os.stat(path)
    return digest_of(path, state.st_mtime_ns, state.st_size)


@functools.cache
def digest_of(path, *state):
    """A file is read again only if its state has changed."""
    with open(path, "rb") as f:
        return hashlib.sha256(f.read()).digest()


def fingerprint(job, moraine):
    """Of the run: program, engines, scene without its comments, meshes, options. How its figures are measured is not part of it."""
    parts = [job.case.encode(), str(job.options()).encode()]
    for path in (moraine, *libraries(moraine), *sorted(glob.glob(os.path.join(SCENES, "*.obj")))):
        parts.append(digest(path))
    with open(os.path.join(SCENES, job.case + ".yaml")) as f:
        parts.append("\n".join(line.split("#")[0].rstrip() for line in f).encode())
    return hashlib.sha256(b"".join(parts)).hexdigest()[:16]


def environment():
    """Without variables that stand for options of the command."""
    return {name: value for name, value in os.environ.items() if name == "MORAINE_ENGINES" or not name.startswith("MORAINE_")}


def figures(job, moraine):
    """Runs the job and lets its case measure what the run left."""
    with tempfile.TemporaryDirectory() as out:
        done = subprocess.run([moraine, "run", os.path.join(SCENES, job.case + ".yaml"), "--out", out, "--quiet", "--threads", "1",
                               *job.options()], env=environment(), capture_output=True, text=True)
        if done.returncode:
            raise RuntimeError(f"{job}: {done.stderr.strip()}")
        with open(os.path.join(out, "summary.json")) as f:
            summary = json.load(f)
        result = importlib.import_module("bulk." + job.case).measure(out, summary, dict(job.settings))
        return {**result, "elements": summary["elements"], "cpu_s": summary["loop_cpu_s"], "warnings": summary["warnings"]}


def remembered(job, moraine, folder):
    """As figures, unless the same job was done before."""
    path = os.path.join(folder, fingerprint(job, moraine) + ".json")
    if not os.path.exists(path):
        result = figures(job, moraine)
        with open(path + ".part", "w") as f:
            json.dump(result, f)
        os.replace(path + ".part", path)
    with open(path) as f:
        return json.load(f)


def run_all(jobs, moraine, folder, at_once):
    """Figures by job. If one fails no other is begun: none waits in the pool, which would still do it."""
    os.makedirs(folder, exist_ok=True)
    begun, results, waiting, pending = time.monotonic(), {}, iter(jobs), {}
    pool = concurrent.futures.ProcessPoolExecutor(at_once)
    try:
        while True:
            for job in itertools.islice(waiting, at_once - len(pending)):
                pending[pool.submit(remembered, job, moraine, folder)] = job
            if not pending:
                return results
            for done in concurrent.futures.wait(pending, return_when=concurrent.futures.FIRST_COMPLETED).done:
                job = pending.pop(done)
                results[job] = done.result()
                print(f"{len(results):4} of {len(jobs)}, {time.monotonic() - begun:5.0f} s: {job} ({results[job]['cpu_s']:.1f} s)",
                      file=sys.stderr)
    finally:
        pool.shutdown(wait=False, cancel_futures=True)
