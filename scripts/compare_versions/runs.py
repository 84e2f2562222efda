"""Runs both versions on a scene, each in a folder of its own, and compares all they leave."""

import os
import shutil
import subprocess
from dataclasses import dataclass
from pathlib import Path

from . import outputs, rules, scene
from .difference import Difference

# Variables of launchers that the program looks at; the guard may itself run under a launcher.
LAUNCHERS = ("OMPI_COMM_WORLD_SIZE", "PMI_SIZE", "SLURM_STEP_NUM_TASKS")
LIMIT_S = 600


@dataclass(frozen=True)
class Setting:
    """The two programs, how many threads they take, and where they work."""

    old: Path
    new: Path
    threads: int
    work: Path
    # Both programs built with MPI, or None.
    mpi: tuple | None = None

    def pair(self, name):
        """Folders of both versions for one scene."""
        return self.work / name / "old", self.work / name / "new"


def start(command, folder):
    """A finished process."""
    environment = {k: v for k, v in os.environ.items() if k not in LAUNCHERS}
    words = list(map(str, command))
    return subprocess.run(
        words, cwd=folder, env=environment, capture_output=True, text=True, timeout=LIMIT_S, check=False
    )


def both(setting, case, arguments):
    """Starts both versions with the same arguments."""
    more = ["--threads", setting.threads]
    pairs = zip((setting.old, setting.new), setting.pair(case.name))
    return [start([binary, *arguments, *more], folder) for binary, folder in pairs]


def compare(setting, case):
    """The verdict on one scene."""
    folders = setting.pair(case.name)
    for folder in folders:
        scene.write(case, folder)
    differences = outputs.compare_prints("check", *both(setting, case, ["check", "scene.toml", *case.arguments()]))
    command = ["run", "scene.toml", "--out", "out", *case.arguments()]
    old, new = both(setting, case, command)
    if old.returncode != case.code:
        last = (old.stderr.strip().splitlines() or ["no message"])[-1]
        return rules.Verdict(case.name, rules.MISSING, f"the old version ends with {old.returncode}: {last}")
    differences += outputs.compare_prints("run", old, new)
    results = [folder / "out" for folder in folders]
    if all(result.is_dir() for result in results):
        differences += outputs.compare_folders(*results)
    verdict = rules.judge(case, differences, results)
    if case.threads:
        fail_on(verdict, other_threads(setting, case, command))
    for step in case.resume:
        resumed(setting, case, step, verdict)
    return verdict


def fail_on(verdict, differences):
    """Bits that must be the same whatever the kind of the scene."""
    if differences:
        verdict.word = rules.DIFFERS
        verdict.size = verdict.size or rules.largest(differences)
        verdict.differences = verdict.differences + differences


def renamed(prefix, differences):
    """The same differences at places that say of which comparison they are."""
    return [Difference(**{**vars(d), "place": f"{prefix}: {d.place}"}) for d in differences]


def other_threads(setting, case, command):
    """Differences of the new version with one thread, or with two where it has run with one."""
    threads = 2 if setting.threads == 1 else 1
    new = setting.pair(case.name)[1]
    command = ["other" if part == "out" else part for part in command]
    done = start([setting.new, *command, "--threads", threads], new)
    if done.returncode != case.code:
        return [Difference(f"threads {threads}", text=f"exit code {done.returncode}")]
    found = outputs.compare_folders(new / "out", new / "other")
    return renamed(f"threads {threads}", found)


def resumed(setting, case, step, verdict):
    """The new version goes on from a step of the old one: to the same bits, or it refuses by name."""
    old, new = setting.pair(case.name)
    target = new / "resumed"
    shutil.rmtree(target, ignore_errors=True)
    shutil.copytree(old / "out", target)
    (target / "summary.json").unlink()
    command = [setting.new, "resume", "resumed", "--step", step, "--threads", setting.threads]
    done = start(command, new)
    message = (done.stderr.strip().splitlines() or ["no message"])[-1]
    if done.returncode == 2 and message.startswith("error:"):
        verdict.notes.append(f"step {step} of the old version is refused: {message}")
        return
    if done.returncode != 0:
        fail_on(verdict, [Difference(f"resumed at step {step}", text=f"exit code {done.returncode}: {message}")])
        return
    shutil.rmtree(target / "superseded_1", ignore_errors=True)
    fail_on(verdict, renamed(f"resumed at step {step}", outputs.compare_folders(old / "out", target)))
    shutil.rmtree(target)
