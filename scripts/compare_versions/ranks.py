"""Runs on 1, 2 and 4 ranks of programs built with MPI: the bits of the old version, and those of one rank."""

import shutil

from . import outputs, rules, scene
from .difference import Difference
from .motions import FRAME, LOW_PRELOAD, dynamic
from .runs import renamed, start

NAME = "ranks"
SECTORS = ("solver.backend=sector", "solver.sectors=5")
CASES = [
    scene.Case("ranks/static", scene.STATIC, settings=SECTORS),
    scene.Case("ranks/motion", scene.MOTION, dynamic() + FRAME, (*SECTORS, LOW_PRELOAD)),
    scene.Case("ranks/harmonic", scene.MOTION, dynamic() + FRAME, (LOW_PRELOAD,)),
]
RANKS = (1, 2, 4)


def run(binary, folder, case, n_ranks):
    """The finished run, its results in a folder named after the number of ranks."""
    launcher = ["mpirun", "-n", n_ranks, "--oversubscribe", "--allow-run-as-root"]
    out = f"ranks_{n_ranks}"
    return start([*launcher, binary, "run", "scene.toml", "--out", out, "--threads", 1, *case.arguments()], folder)


def compare(setting):
    """The verdict on all runs together."""
    if shutil.which("mpirun") is None:
        return rules.Verdict(NAME, rules.MISSING, "there is no mpirun")
    differences = []
    for case in CASES:
        old, new = setting.pair(case.name)
        for folder in (old, new):
            scene.write(case, folder)
        for n in RANKS:
            done = [run(binary.resolve(), folder, case, n) for binary, folder in zip(setting.mpi, (old, new))]
            codes = [process.returncode for process in done]
            if codes != [0, 0]:
                differences.append(Difference(f"{case.name} on {n} ranks", text=f"exit codes {codes}"))
                continue
            pairs = [("old and new", old / f"ranks_{n}"), ("new on 1 rank", new / "ranks_1")]
            for what, folder in pairs:
                found = outputs.compare_folders(folder, new / f"ranks_{n}")
                differences += renamed(f"{case.name} on {n} ranks, {what}", found)
    word = rules.DIFFERS if differences else rules.SAME
    return rules.Verdict(NAME, word, f"{len(CASES)} scenes", differences)
