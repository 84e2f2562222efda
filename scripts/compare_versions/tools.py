"""Commands that read results: both versions read those of the old one and must print and write the same."""

import shutil

from . import outputs, rules, scene
from .difference import Difference
from .motions import FRAME, NODE_PROBES, STRESS_PROBES, dynamic
from .runs import both, start

NAME = "commands"
CASE = scene.Case(NAME, scene.MOTION, dynamic() + FRAME + NODE_PROBES + STRESS_PROBES)
COMMANDS = [
    ["info", "out"],
    ["info", "out", "--verify"],
    ["info", "out/step_000010.hdf"],
    ["info", "out/mesh.hdf"],
    ["cycles", "out"],
    ["export", "out", "--to", "csv", "--steps", "10", "--out", "as_csv"],
    ["export", "out", "--to", "vtu", "--steps", "10", "--out", "as_vtu"],
    ["plot", "out", "--out", "figures"],
    ["report", "out", "--out", "report.html"],
    ["pack", "out", "--per-file", "2"],
    ["pack", "out", "--undo"],
    ["study", "study.toml", "--list"],
]
STUDY = (
    'title = "two loads"\nscene = "scene.toml"\nset = ["dynamic.duration = \\"60 us\\""]\ncost = "bytes"\n'
    '[[axes]]\nname = "load"\nvalues = [\n'
    '{ name = "low", size = 1, set = [\'effects.axial_force.value = "1 kN"\'] },\n'
    '{ name = "high", size = 2, set = [\'effects.axial_force.value = "2 kN"\'] },\n]\n'
    '[[quantities]]\nname = "place"\nunit = "m"\nsummary = "/shaft/displacement_m/2"\n'
    'reference = { point = { load = "high" } }\n'
)
STUDIED = ["study", "study.toml", "--out", "studied"]
# What a study writes besides its table and the results of its points tells of cost.
COSTS = ("study.json", "study.md", "plots/*", "points/*/log.txt", "points/*/point.json")


def compare(setting):
    """The verdict on all commands together."""
    old, new = setting.pair(NAME)
    for folder in (old, new):
        scene.write(CASE, folder)
        (folder / "study.toml").write_text(STUDY, encoding="utf-8")
    done = start([setting.old, "run", "scene.toml", "--out", "out", "--threads", setting.threads], old)
    if done.returncode != 0:
        return rules.Verdict(NAME, rules.MISSING, f"the run ends with {done.returncode}: {done.stderr[-200:]}")
    shutil.copytree(old / "out", new / "out")
    differences, refused = [], []
    for command in COMMANDS:
        results = both(setting, CASE, command)
        differences += outputs.compare_prints(" ".join(command), *results)
        if results[0].returncode != 0:
            refused.append(f"{' '.join(command)} ends with {results[0].returncode}: {results[0].stderr[-200:]}")
    for done in both(setting, CASE, STUDIED):
        if done.returncode != 0:
            refused.append(f"{' '.join(STUDIED)} ends with {done.returncode}: {done.stderr[-200:]}")
    for file in [f for folder in (old, new) for pattern in COSTS for f in (folder / "studied").glob(pattern)]:
        file.unlink()
    differences += outputs.compare_folders(old, new)
    if refused:
        return rules.Verdict(NAME, rules.MISSING, "; ".join(refused), differences)
    word = rules.DIFFERS if differences else rules.SAME
    return rules.Verdict(NAME, word, f"{len(COMMANDS) + 1} commands", differences)
