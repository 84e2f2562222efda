"""Comparison of modes: frequencies, and the angle between subspaces of modes with one frequency."""

from dataclasses import dataclass

import h5py
import numpy as np

from . import tables
from .difference import Difference

FREQUENCY = 1e-10
# Frequencies of a free ring are not exactly zero: relative to the highest of its body, about root round-off.
RIGID = 1e-5
# Modes closer than this belong to one subspace.
NEIGHBOURS = 1e-6
# Sine of the largest angle; two different solvers of the rings agree to 4e-11.
ANGLE = 1e-8


@dataclass(frozen=True)
class Modes:
    """Modes of one body."""

    steps: list
    frequencies: np.ndarray
    is_rigid: np.ndarray


def read(folder):
    """Modes by body, from the table."""
    columns, rows = tables.read_table(folder / "modes.csv")
    bodies = {}
    for row in rows:
        entry = dict(zip(columns, row))
        values = (int(entry["step"]), float(entry["frequency_hz"]), entry["rigid"] == "1")
        bodies.setdefault(entry["body"], []).append(values)
    return {b: Modes([s for s, _, _ in v], *map(np.array, list(zip(*v))[1:])) for b, v in bodies.items()}


def clusters(modes):
    """Lists of indices of modes of one frequency; all rigid motions are one."""
    found = [[0]]
    for i in range(1, len(modes.frequencies)):
        if are_neighbours(modes, i - 1, i):
            found[-1].append(i)
        else:
            found.append([i])
    return found


def are_neighbours(modes, i, j):
    """Whether two modes belong to one subspace."""
    a, b = modes.frequencies[[i, j]]
    return bool(modes.is_rigid[i] and modes.is_rigid[j]) or abs(a - b) <= NEIGHBOURS * abs(b)


def shapes(folder, steps):
    """Displacements, a column per mode."""
    columns = []
    for step in steps:
        with h5py.File(folder / f"step_{step:06}.hdf", "r") as file:
            columns.append(file["VTKHDF/PointData/displacement"][()].ravel())
    return np.array(columns).T


def sine(old, new):
    """Sine of the largest angle between the subspaces that the columns span."""
    p, q = np.linalg.qr(old)[0], np.linalg.qr(new)[0]
    return float(np.linalg.norm(q - p @ (p.T @ q), 2))


def compare(old_folder, new_folder):
    """Differences beyond the rule, and the largest relative ones of frequencies and angles."""
    old, new = read(old_folder), read(new_folder)
    if {b: m.steps for b, m in old.items()} != {b: m.steps for b, m in new.items()}:
        return [Difference("modes.csv", text="other bodies or numbers of modes")], 0.0, 0.0
    found, frequency, angle = [], 0.0, 0.0
    for body, a in old.items():
        b = new[body]
        scale = np.where(a.is_rigid, max(np.abs(a.frequencies)) * RIGID / FREQUENCY, np.abs(a.frequencies))
        error = np.abs(b.frequencies - a.frequencies) / np.where(scale > 0.0, scale, 1.0)
        frequency = max(frequency, float(np.max(error)))
        count = int(np.count_nonzero(error > FREQUENCY))
        if count or (a.is_rigid != b.is_rigid).any():
            largest = float(np.max(np.abs(b.frequencies - a.frequencies)))
            found.append(Difference(f"frequencies of {body}, Hz", count, len(error), largest, float(np.max(error))))
        groups = clusters(a)
        # The last group may lack modes beyond the number asked for; then its subspace is any part of the whole.
        for cluster in groups[:-1] or groups:
            steps = [a.steps[i] for i in cluster]
            x, y = shapes(old_folder, steps), shapes(new_folder, steps)
            # Modes of balls and shaft may leave the rings at rest.
            if x.size == 0 or not (x.any() and y.any()):
                continue
            s = sine(x, y)
            angle = max(angle, s)
            if s > ANGLE:
                place = f"subspace of modes {steps[0]} to {steps[-1]} of {body}"
                found.append(Difference(place, len(steps), len(steps), s, s))
    return found, frequency, angle
