"""Comparison of result folders and of what the program prints."""

import re

from . import hdf, tables
from .difference import Difference, compare_lines

HDF = {".hdf", ".vtkhdf"}
# Files that say nothing of the result.
LEFT_OUT = {".raceway.lock", "run.log"}
# Seconds, memory, room on the disk: what may differ between two runs of one program.
VARYING = [
    (re.compile(r"^\[ *[0-9.]+ s\] "), ""),
    (re.compile(r"waited [0-9.]+ s for the disk"), ""),
    (re.compile(r", [0-9.]+ ms per step"), ""),
    (re.compile(r"; the disk of this folder has [0-9.]+ .?B free"), ""),
    (re.compile(r", peak [0-9.]+ .?B"), ""),
    (re.compile(r"( blocks), [0-9.]+ s$"), r"\1"),
]
SECONDS = re.compile(r" [0-9.]+ s\b")
LINES_LEFT_OUT = ("seconds:", "peak memory:", "memory ")


def files(folder):
    """Names of all files below, with their paths."""
    return {str(p.relative_to(folder)): p for p in folder.rglob("*") if p.is_file() and p.name not in LEFT_OUT}


def compare_folders(old_folder, new_folder):
    """All differences of two result folders."""
    old, new = files(old_folder), files(new_folder)
    found = [Difference(name, text="written by the old version only") for name in sorted(old.keys() - new.keys())]
    found += [Difference(name, text="written by the new version only") for name in sorted(new.keys() - old.keys())]
    for name in sorted(old.keys() & new.keys()):
        found += compare_one(name, old[name], new[name])
    return found


def compare_one(name, old, new):
    """Differences of two files, by their kind."""
    if old.suffix in HDF:
        return hdf.compare_files(name, old, new)
    if old.name == "summary.json":
        return tables.compare_summaries(name, old, new)
    if old.suffix == ".csv":
        return tables.compare_tables(name, old, new)
    if old.suffix in {".txt", ".md", ".html", ".svg", ".series", ".json", ".vtu", ".pvd"}:
        lines = [stable(path.read_text(encoding="utf-8")) for path in (old, new)]
        difference = compare_lines(name, *lines)
    else:
        same = old.read_bytes() == new.read_bytes()
        difference = None if same else Difference(name, text="other bytes")
    return [difference] if difference else []


def stable(text):
    """The lines of a printed text without seconds and memory."""
    lines = []
    for line in text.splitlines():
        if line.startswith(LINES_LEFT_OUT):
            continue
        if line.startswith("effects:"):
            line = SECONDS.sub("", line)
        for pattern, replacement in VARYING:
            line = pattern.sub(replacement, line)
        lines.append(line)
    return lines


def compare_prints(place, old, new):
    """Differences of exit codes and of both printed streams of two finished processes."""
    if old.returncode != new.returncode:
        last = (new.stderr.strip().splitlines() or [""])[-1]
        text = f"exit code {old.returncode} became {new.returncode}: {last}"
        return [Difference(place, text=text)]
    streams = [("output", old.stdout, new.stdout), ("log", old.stderr, new.stderr)]
    found = [compare_lines(f"{place} {name}", stable(a), stable(b)) for name, a, b in streams]
    return [difference for difference in found if difference]
