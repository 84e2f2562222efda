"""Starts the program `raceway`: runs, studies and all its other commands."""

from __future__ import annotations

import json
import math
import os
import re
import shutil
import signal
import subprocess
import sys
import threading
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import IO

import numpy as np

from .errors import InputError, NoSolution, ProgramError, ProgramMissing, StoppedEarly
from .results import Results, open_results
from .studies import Study, open_study

#: A path, as a text or as a `Path`.
PathLike = str | os.PathLike[str]
#: Changes of a scene: values by the path of their key, or texts such as `"effects.axial_force.value=3 kN"`.
Overrides = Mapping[str, object] | Sequence[str]

PROGRESS = re.compile(r"\[ *(?P<seconds>[\d.]+) s\] (?P<done>\d+)/(?P<total>\d+) (?P<text>.*)")
POINT = re.compile(r"point (?P<number>\d+): (?P<name>.*)")
#: How lines begin that a reader should know of.
WARNINGS = ("warning: ", "advice: ")
#: How the line begins with which the program ends early.
ENDS = ("error: ", "stopped: ")
ERRORS: dict[int, type[ProgramError]] = {2: InputError, 3: NoSolution, 75: StoppedEarly}
#: Lines of the program that are kept for the text of an error.
KEPT_LINES = 200


@dataclass(frozen=True)
class Progress:
    """How far a run or study is."""

    #: Steps, or points of a study, that are done.
    done: int
    #: Steps or points in all.
    total: int
    #: Time since the start, s; of a study NaN.
    seconds: float
    #: What is done now.
    text: str
    #: What the program warns of or advises, empty if this is no such line.
    warning: str = ""


#: Called with each sign of progress; `True` prints them, `None` is silent.
ProgressHandler = Callable[[Progress], object] | bool | None


def find_program(program: PathLike | None = None) -> Path:
    """The program: the one given, else that of the environment variable RACEWAY, else the one on the PATH."""
    asked = program or os.environ.get("RACEWAY")
    found = shutil.which(os.fspath(asked) if asked else "raceway")
    if found is None and asked:
        raise ProgramMissing(f"{os.fspath(asked)} is no program that can be started; expected raceway")
    if found is None:
        raise ProgramMissing(
            "the program raceway is not on the PATH; install it (cargo install --path .), "
            "or set the environment variable RACEWAY to its path"
        )
    return Path(found).resolve()


def run(
    scene: PathLike,
    out: PathLike | None = None,
    overrides: Overrides | None = None,
    *,
    threads: int | None = None,
    progress: ProgressHandler = None,
    program: PathLike | None = None,
) -> Results:
    """Runs a scene and opens its results.

    `out` is the folder of the results, by default `results/` and the name of the scene. `overrides` changes values of
    the scene: `{"effects.axial_force.value": "3 kN"}`; None as a value takes a table out. Raises `InputError`,
    `NoSolution` or `StoppedEarly` with the words of the program.
    """
    arguments = ["run", os.fspath(scene), *override_arguments(overrides), *_threads(threads)]
    if out is not None:
        arguments += ["--out", os.fspath(out)]
    said = command(*arguments, progress=progress, program=program)
    return open_results(_results_folder(said) if out is None else out)


def resume(
    folder: PathLike,
    *,
    threads: int | None = None,
    progress: ProgressHandler = None,
    program: PathLike | None = None,
) -> Results:
    """Goes on with a run over time from its newest whole step, to the same bits as if it had not been interrupted."""
    command("resume", folder, *_threads(threads), progress=progress, program=program)
    return open_results(folder)


def study(
    file: PathLike,
    out: PathLike | None = None,
    *,
    jobs: int = 1,
    progress: ProgressHandler = None,
    program: PathLike | None = None,
) -> Study:
    """Runs the points of a study that are missing and opens its tables; `jobs` points run at the same time."""
    total = len(command("study", file, "--list", program=program).splitlines())
    arguments = ["study", os.fspath(file), "--jobs", str(jobs)]
    if out is not None:
        arguments += ["--out", os.fspath(out)]
    said = command(*arguments, progress=_of_points(progress, total), program=program)
    return open_study(_results_folder(said) if out is None else out)


def command(
    *arguments: PathLike,
    progress: ProgressHandler = None,
    program: PathLike | None = None,
) -> str:
    """Runs any command of the program, such as `command("plot", "results/7208")`, and returns what it prints.

    An interrupt (Ctrl-C, or that of a notebook) reaches the program, which saves the step of a motion before it ends.
    """
    report = _handler(progress)
    words = [str(find_program(program)), "--parent", str(os.getpid()), *[os.fspath(word) for word in arguments]]
    process = subprocess.Popen(
        words,
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        errors="replace",
        start_new_session=True,
    )
    assert process.stdout is not None and process.stderr is not None
    printed: list[str] = []
    reader = threading.Thread(target=_collect, args=(process.stdout, printed), daemon=True)
    reader.start()
    try:
        notes, last = _follow(process.stderr, report)
        code = process.wait()
    except BaseException:
        process.send_signal(signal.SIGINT)
        process.wait()
        raise
    reader.join()
    if code != 0:
        raise _failure(code, notes)
    for line in printed:
        if line.startswith(WARNINGS) and line.rstrip("\n") not in notes:
            report(Progress(0, 0, math.nan, "", line.rstrip("\n").split(": ", 1)[1]))
    if last.done < last.total:
        # The program says what it does now; that it has done all of it, its end says.
        report(Progress(last.total, last.total, last.seconds, "finished"))
    return "".join(printed)


def override_arguments(overrides: Overrides | None) -> list[str]:
    """The words of the command line that change a scene, `--set PATH=VALUE` each."""
    if overrides is None:
        return []
    if isinstance(overrides, str):
        raise TypeError(f"overrides is the text {overrides!r}; expected a dictionary or a list of texts")
    if isinstance(overrides, Mapping):
        changes = [f"{path}={_toml(value)}" for path, value in overrides.items()]
    else:
        changes = list(overrides)
    return [word for change in changes for word in ("--set", change)]


def _toml(value: object) -> str:
    """A value as TOML; None is the word that takes a table out."""
    if isinstance(value, (np.generic, np.ndarray)):
        return _toml(value.tolist())
    if value is None:
        return "none"
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, str):
        return json.dumps(value, ensure_ascii=False)
    if isinstance(value, Mapping):
        return "{ " + ", ".join(f"{key} = {_toml(part)}" for key, part in value.items()) + " }"
    if isinstance(value, (list, tuple)):
        return "[" + ", ".join(map(_toml, value)) + "]"
    if isinstance(value, (int, float)):
        if isinstance(value, float) and not math.isfinite(value):
            raise ValueError(f"{value} is no value of a scene; expected a finite number")
        return repr(value)
    raise TypeError(f"{value!r} is no value of a scene; expected a text, number, truth value, list or dictionary")


def _threads(threads: int | None) -> list[str]:
    return [] if threads is None else ["--threads", str(threads)]


def _results_folder(said: str) -> Path:
    lines = [line for line in said.splitlines() if line.startswith("results: ")]
    if not lines:
        raise ProgramError(f"the program did not say where its results are; it said:\n{said}", 0)
    return Path(lines[-1].removeprefix("results: "))


def _collect(stream: IO[str], into: list[str]) -> None:
    into.extend(stream)


def _follow(stream: IO[str], report: Callable[[Progress], object]) -> tuple[list[str], Progress]:
    """Reports progress while the program runs; returns the last lines that are no progress, and the last progress."""
    notes: list[str] = []
    last = Progress(0, 0, 0.0, "")
    for line in stream:
        line = line.rstrip("\n")
        if found := PROGRESS.match(line):
            last = Progress(int(found["done"]), int(found["total"]), float(found["seconds"]), found["text"])
            report(last)
            continue
        if line.startswith(WARNINGS):
            warning = line.split(": ", 1)[1]
            report(Progress(last.done, last.total, last.seconds, last.text, warning))
        elif POINT.match(line):
            report(Progress(0, 0, math.nan, line))
        notes = [*notes[1 - KEPT_LINES :], line]
    return notes, last


def _failure(code: int, notes: list[str]) -> ProgramError:
    """The error of an exit code, with what the program said from its last line of an error on."""
    starts = [i for i, line in enumerate(notes) if line.startswith(ENDS)]
    lines = notes[starts[-1] :] if starts else notes
    text = "\n".join(lines).strip().removeprefix("error: ")
    kind = ERRORS.get(code, ProgramError)
    return kind(text or f"raceway ended with exit code {code} without a word", code)


def _handler(progress: ProgressHandler) -> Callable[[Progress], object]:
    if progress is None or progress is False:
        return lambda _: None
    if progress is True:
        return _print
    return progress


def _print(progress: Progress) -> None:
    text = f"warning: {progress.warning}" if progress.warning else f"{progress.done}/{progress.total} {progress.text}"
    print(text, file=sys.stderr, flush=True)


def _of_points(progress: ProgressHandler, total: int) -> Callable[[Progress], object] | None:
    """Progress over the points of a study: the one that starts now follows those before it."""
    report = _handler(progress)
    started = 0

    def of_point(sign: Progress) -> None:
        nonlocal started
        if POINT.match(sign.text) and not sign.warning:
            report(Progress(started, total, math.nan, sign.text))
            started += 1
        elif sign.warning:
            report(sign)

    return of_point
