"""Shows that the guard can fail: one bit of a result is changed, and the guard must name its place."""

import json
import shutil

import h5py
import numpy as np

from . import motions, outputs, rests, rules, runs

MOTION, REST, FREE = "rungs_rigid", "static_rigid", "modes_free"


def next_number(path, name):
    """Changes the last bit of the first value of a data set."""
    with h5py.File(path, "r+") as file:
        values = file[name][()]
        flat = values.reshape(-1)
        flat[0] = np.nextafter(flat[0], np.inf)
        file[name][...] = values


def other_sign_of_zero(path):
    """Gives the first 0.0 of a table its other sign."""
    text = path.read_text(encoding="utf-8")
    path.write_text(text.replace(",0.0,", ",-0.0,", 1), encoding="utf-8")


def scaled(path, name, factor):
    """Multiplies a data set."""
    with h5py.File(path, "r+") as file:
        file[name][...] = file[name][()] * factor


def turned(folder, first, second):
    """Turns two modes into each other."""
    names = [folder / f"step_{step:06}.hdf" for step in (first, second)]
    place = "VTKHDF/PointData/displacement"
    with h5py.File(names[0], "r+") as a, h5py.File(names[1], "r+") as b:
        x, y = a[place][()], b[place][()]
        a[place][...] = 0.6 * x + 0.8 * y
        b[place][...] = 0.8 * x - 0.6 * y


def one_more_iteration(folder):
    """Another count in the summary, and a result that differs by less than the tolerance of iterations."""
    path = folder / "summary.json"
    summary = json.loads(path.read_text(encoding="utf-8"))
    summary["iterations"]["newton"] += 1
    path.write_text(json.dumps(summary), encoding="utf-8")
    scaled(folder / "step_000000.hdf", "restart/state/balls", 1.0 + 1e-10)


def changes():
    """Scene, change of a result folder, the word that must follow, and a part of a line that must be shown."""
    step, balls, time = "step_000010.hdf", "restart/state/balls", "VTKHDF/FieldData/time"
    return [
        (MOTION, lambda d: None, rules.SAME, ""),
        (MOTION, lambda d: next_number(d / step, balls), rules.DIFFERS, f"{step} /{balls}"),
        (MOTION, lambda d: next_number(d / step, time), rules.DIFFERS, f"{step} /{time}"),
        (MOTION, lambda d: other_sign_of_zero(d / "shaft.csv"), rules.DIFFERS, "only signs of zeros"),
        (MOTION, lambda d: (d / step).unlink(), rules.DIFFERS, f"{step}: written by the old version only"),
        (REST, lambda d: scaled(d / "step_000000.hdf", balls, 1.0 + 1e-13), rules.WITHIN, "balls"),
        (REST, lambda d: scaled(d / "step_000000.hdf", balls, 1.0 + 1e-10), rules.DIFFERS, "balls"),
        (REST, one_more_iteration, rules.WITHIN, "balls"),
        (FREE, lambda d: turned(d, 7, 8), rules.WITHIN, "displacement"),
        (FREE, lambda d: turned(d, 8, 9), rules.DIFFERS, "subspace of modes"),
    ]


def run(setting):
    """Exit code 0 if every change is judged as it must be, 1 if not, 2 if a scene cannot be run."""
    cases = {case.name: case for case in motions.CASES + rests.CASES if case.name in (MOTION, REST, FREE)}
    for case in cases.values():
        verdict = runs.compare(setting, case)
        if verdict.word != rules.SAME:
            print(f"self-test: {case.name} of one version twice: {verdict.word} {verdict.size}")
            return 2
    failures = 0
    for number, (name, change, word, part) in enumerate(changes()):
        old = setting.pair(name)[0] / "out"
        new = setting.work / f"changed_{number}"
        shutil.copytree(old, new)
        change(new)
        verdict = rules.judge(cases[name], outputs.compare_folders(old, new), [old, new])
        lines = [difference.line() for difference in verdict.differences]
        is_right = verdict.word == word and (not part or any(part in line for line in lines))
        failures += not is_right
        print(f"{'ok    ' if is_right else 'WRONG '} {name:14} {verdict.word} ({verdict.size}) {lines[:1]}")
    print(f"self-test: {failures} of {len(changes())} changes were judged wrongly")
    return 1 if failures else 0
