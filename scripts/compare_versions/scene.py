"""A scene of the guard: the scene of the tests with an analysis of its own, tables and --set arguments."""

import shutil
from dataclasses import dataclass, replace
from pathlib import Path

from . import rings

ROOT = Path(__file__).resolve().parents[2]
BASE = ROOT / "tests" / "fixtures" / "7010c.toml"

# How results may differ: not at all, by the tolerance of the iterations, or modes by angle.
MOTION, STATIC, MODES = "motion", "static", "modes"

SMALL = rings.Level()
FEW = range(5, 9)
# Meshes of both rings by name: a file of the folder meshes, or how to make it.
MESHES = {
    "small": (SMALL, SMALL),
    "coarse": ("7010c_inner_coarse.msh", "7010c_outer_coarse.msh"),
    "fine": ("7010c_inner.msh", "7010c_outer.msh"),
    "tet10": ("7010c_inner_tet10.msh", "7010c_outer_coarse.msh"),
    "inner_partly_held": (rings.Level(free_seat=FEW), SMALL),
    "outer_partly_held": (SMALL, rings.Level(free_seat=FEW)),
    "moved_nodes": (rings.Level(moved=range(20, 22)), rings.Level(moved=FEW)),
}


@dataclass(frozen=True)
class Case:
    """One scene; `tables` stands for the analysis [static] of the base, `settings` are --set arguments."""

    name: str
    kind: str
    tables: str = "[static]"
    settings: tuple = ()
    meshes: str = "small"
    # Replacements in the text of the base, as pairs.
    edits: tuple = ()
    # Steps whose files the new version goes on from.
    resume: tuple = ()
    # Whether the new version also runs with the other number of threads.
    threads: bool = False
    # Exit code that both must have.
    code: int = 0

    def arguments(self):
        """The --set arguments."""
        return [text for setting in self.settings for text in ("--set", setting)]


def undeformed(case):
    """The case from undeformed bodies, if it is a motion that starts from an equilibrium."""
    if case.kind != MOTION or "start." in case.tables:
        return case
    # A start under full loads is a jump, of which some schemes gain energy: bits are compared all the same.
    tables = case.tables if case.code else case.tables.replace("ledger_tolerance = 1e-2", "ledger_tolerance = 1.0")
    return replace(case, tables=f"{tables}\n[dynamic.start.free]\n")


def scene_text(case):
    """The scene file; every step is written and nothing is rounded, unless the case says otherwise."""
    text = BASE.read_text(encoding="utf-8")
    for old, new in case.edits:
        if old not in text:
            raise ValueError(f"{case.name}: {BASE} has no text {old!r}")
        text = text.replace(old, new, 1)
    output = "" if "[output]" in case.tables else '\n[output]\nprecision = "f64"\n'
    return text.replace("[static]", case.tables) + output


def write(case, folder):
    """Writes scene and meshes into a new folder."""
    folder.mkdir(parents=True)
    (folder / "scene.toml").write_text(scene_text(case), encoding="utf-8")
    write_meshes(case.meshes, folder)


def write_meshes(name, folder):
    """Writes inner.msh and outer.msh."""
    pair = MESHES[name]
    for side, ring, file in zip((rings.INNER, rings.OUTER), pair, ("inner.msh", "outer.msh")):
        if isinstance(ring, rings.Level):
            (folder / file).write_text(rings.text(side, ring), encoding="ascii")
        else:
            shutil.copy(ROOT / "meshes" / ring, folder / file)
