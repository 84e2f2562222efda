"""Comparison of CSV tables and of summary.json."""

import csv
import json
import re

import numpy as np

from .difference import Difference, compare_reals, magnitude

# What a summary says of cost, program and paths, not of the bearing; and the identity of the run.
LEFT_OUT = {
    "run",
    "scene",
    "timing_s",
    "factor_bytes_forecast",
    "peak_memory_forecast_bytes",
    "peak_memory_bytes",
    "version",
}
# Columns of a study that say the same.
COST_COLUMNS = ("wall", "cpu", "peak_memory", "bytes_written")
# Name of a probe, one of its quantities, and the unit.
COMPONENT = re.compile(
    r"(.*?)_?(stress|von_mises|principal|maximum_shear|hydrostatic|displacement|force|moment).*_(pa|m|n|n_m)$"
)


def read_table(path):
    """Columns and rows of texts."""
    with open(path, newline="", encoding="utf-8") as file:
        rows = list(csv.reader(file))
    return (rows[0], rows[1:]) if rows else ([], [])


def reals(texts):
    """The texts as numbers, or None where one is none."""
    try:
        return np.array([float(t) if t else np.nan for t in texts])
    except ValueError:
        return None


def group(table, column):
    """Columns whose values have one magnitude: energies, reactions, components of one vector or tensor."""
    if column.endswith("_j"):
        return "energy"
    if table.startswith("shaft"):
        return "reaction" if column.startswith("reaction") else column.rsplit("_", 1)[-1]
    if table.startswith(("probes", "profiles")) and (found := COMPONENT.match(column)):
        return found[1], found[3]
    return column


def compare_tables(name, old_path, new_path):
    """Differences by column."""
    (columns, old), (new_columns, new) = read_table(old_path), read_table(new_path)
    if columns != new_columns:
        return [Difference(name, text=f"columns {columns} became {new_columns}")]
    if len(old) != len(new):
        return [Difference(name, text=f"{len(old)} rows became {len(new)}")]
    if old == new:
        return []
    return list(compare_columns(name, columns, list(zip(*old)), list(zip(*new))))


def compare_columns(name, columns, old, new):
    """Yields a difference for each column whose texts differ; numbers are written so that texts are bits."""
    numbers = {c: (reals(a), reals(b)) for c, a, b in zip(columns, old, new)}
    for column, a, b in zip(columns, old, new):
        if a == b or column.startswith(COST_COLUMNS):
            continue
        place, (x, y) = f"{name} {column}", numbers[column]
        if x is None or y is None:
            first = next((p, q) for p, q in zip(a, b) if p != q)
            yield Difference(place, text=f"{first[0]!r} became {first[1]!r}")
            continue
        peers = [v for c in columns if group(name, c) == group(name, column) for v in numbers[c] if v is not None]
        found = compare_reals(place, x, y, magnitude(*peers))
        yield found or Difference(place, text="other texts of the same numbers")


def leaves(value, path=()):
    """Yields path and value of everything below that is no dictionary or list."""
    if isinstance(value, dict):
        for key, item in value.items():
            if path or key not in LEFT_OUT:
                yield from leaves(item, (*path, key))
    elif isinstance(value, list):
        yield (*path, "length"), len(value)
        for index, item in enumerate(value):
            yield from leaves(item, (*path, index))
    else:
        yield path, value


def family(path):
    """Leaves of one name, whatever their place in a list; energies are one family, and reactions."""
    if path[0] == "energy_j":
        return path[:1]
    names = tuple(k for k in path if isinstance(k, str))
    is_reaction = names[-1].startswith("reaction")
    return (*names[:-1], "reaction") if is_reaction else names


def summary_of(path):
    """The whole file."""
    return json.loads(path.read_text(encoding="utf-8"))


def compare_summaries(name, old_path, new_path):
    """Differences by family of leaves."""
    old, new = (dict(leaves(summary_of(path))) for path in (old_path, new_path))
    if old.keys() != new.keys():
        only = sorted("/".join(map(str, k)) for k in old.keys() ^ new.keys())
        return [Difference(name, text=f"entries in one version only: {', '.join(only[:8])}")]
    families = {}
    for path in old:
        families.setdefault(family(path), []).append(path)
    found = []
    for key, paths in families.items():
        place = f"{name} {'/'.join(key)}"
        pairs = [(old[p], new[p]) for p in paths]
        if all(isinstance(v, float) for pair in pairs for v in pair):
            a, b = (np.array(column) for column in zip(*pairs))
            found.append(compare_reals(place, a, b))
        elif any(a != b or type(a) is not type(b) for a, b in pairs):
            first = next((a, b) for a, b in pairs if a != b or type(a) is not type(b))
            text = f"{first[0]!r} became {first[1]!r}"
            found.append(Difference(place, text=text, is_secondary=key[0] == "iterations"))
    return [difference for difference in found if difference]


def iterations(path):
    """Counts of iterations by name, where the summary has them."""
    return summary_of(path).get("iterations", {})
