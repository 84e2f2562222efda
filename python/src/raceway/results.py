"""The results of a run: summary, tables, steps, mesh."""

from __future__ import annotations

import json
import os
from collections.abc import Iterable, Iterator
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import pandas as pd

from .errors import MissingPackage, ResultsError
from .meshes import Floats, Mesh
from .steps import (
    MESH_FILE,
    STRESS_COMPONENTS,
    VECTOR_COMPONENTS,
    Place,
    Step,
    find_steps,
    read_mesh,
    read_point_fields,
    require_same_run,
)
from .tables import read_table

if TYPE_CHECKING:
    import xarray

#: Files of which at least one is in a result folder, besides tables and steps.
DOCUMENTS = ("summary.json", "stiffness.json", "life.json", "heat.json", "load_matrix.json")

#: Schema of `summary.json`.
SUMMARY_SCHEMA = 1

#: The scene of a list of bearings, beside their folders.
LIST_SCENE = "scene.toml"


class Results:
    """A folder that a command of the program has written. Nothing is read before it is asked for."""

    def __init__(self, folder: str | os.PathLike[str]) -> None:
        #: The folder.
        self.folder = Path(folder)
        if not self.folder.is_dir():
            raise ResultsError(f"{self.folder} is no folder; expected the results of a run")
        has_document = any((self.folder / name).is_file() for name in DOCUMENTS)
        if not (has_document or self.tables or self._places):
            expected = "expected summary.json, tables or steps as raceway run writes them"
            raise ResultsError(f"{self.folder} holds no results; {expected}")

    def __repr__(self) -> str:
        kind = self.summary.get("analysis", "no summary") if self.has("summary.json") else "no summary"
        steps = "1 step" if len(self.steps) == 1 else f"{len(self.steps)} steps"
        return f"<raceway.Results {self.folder}: {kind}, {steps}, tables {', '.join(self.tables)}>"

    def has(self, name: str) -> bool:
        """Whether the folder has a file of this name."""
        return (self.folder / name).is_file()

    @cached_property
    def summary(self) -> dict[str, Any]:
        """Key numbers of the run: `summary.json`."""
        found = self._document("summary.json", "a run that has ended has it")
        if found.get("schema") != SUMMARY_SCHEMA:
            schema = f"schema {found['schema']!r}" if "schema" in found else "no schema"
            expected = f"this package reads schema {SUMMARY_SCHEMA}: read it with that of the program that wrote it"
            raise ResultsError(f"{self.folder / 'summary.json'} has {schema}; {expected}")
        return found

    @cached_property
    def stiffness(self) -> dict[str, Any]:
        """What `raceway stiffness` has found: `stiffness.json`; matrices are arrays."""
        return _with_arrays(self._document("stiffness.json", "raceway stiffness writes it"))

    @cached_property
    def life(self) -> dict[str, Any]:
        """Ratings and life: `life.json` of `raceway life`, else key `life` of the summary."""
        if self.has("life.json") or not self.has("summary.json"):
            return self._document("life.json", "raceway life writes it")
        found = self.summary.get("life")
        if found is None:
            raise ResultsError(f"{self.folder} has no life; a scene with [life] or raceway life DIR gives it")
        return dict(found)

    @cached_property
    def heat(self) -> dict[str, Any]:
        """Rounds and end of `raceway heat`: `heat.json`; matrices are arrays."""
        return _with_arrays(self._document("heat.json", "raceway heat SCENE --out DIR writes it"))

    @cached_property
    def load_matrix(self) -> dict[str, Any]:
        """What gauges read under 1 N of each ball: `load_matrix.json`; `strain_per_n` is an array, gauges by balls."""
        return _with_arrays(self._document("load_matrix.json", "raceway load-matrix writes it"))

    @cached_property
    def reduction(self) -> dict[str, Floats]:
        """What `[output.reduction]` found, over points: `stress_maximum` and others in Pa, `damage`, `cycles`."""
        path = self.folder / "reduction.vtkhdf"
        if not path.is_file():
            hint = f"a scene with [output.reduction] gives it{self._of_bearings()}"
            raise ResultsError(f"{self.folder} has no reduction.vtkhdf; {hint}")
        require_same_run(self.folder / MESH_FILE, Place(path, "/"))
        return read_point_fields(path)

    @property
    def scene(self) -> str:
        """Text of the scene, with its overrides, as it was run; from the newest step, or of a list of bearings."""
        if self.bearings:
            return (self.folder / LIST_SCENE).read_text(encoding="utf-8")
        if not self.steps:
            raise ResultsError(f"{self.folder} has no steps, which hold the scene")
        return self.step(-1).scene

    @cached_property
    def bearings(self) -> list[str]:
        """Names of the bearings of a list, each with a folder of its own; empty if this is none."""
        if not self.has(LIST_SCENE):
            return []
        folders = sorted(path.parent.name for path in self.folder.glob(f"*/{MESH_FILE}"))
        return [name for name in folders if not name.startswith("superseded_")]

    def bearing(self, name: str) -> Results:
        """The results of one bearing of a list."""
        if name not in self.bearings:
            known = f"bearings are {', '.join(self.bearings)}" if self.bearings else "it holds one bearing, not a list"
            raise ResultsError(f'{self.folder} has no bearing "{name}"; {known}')
        return Results(self.folder / name)

    @property
    def tables(self) -> list[str]:
        """Names of the tables in the folder, without `.csv`."""
        return sorted(path.stem for path in self.folder.glob("*.csv"))

    def table(self, name: str) -> pd.DataFrame:
        """A table by its name, such as "balls"; units stand in the names of the columns."""
        path = self.folder / f"{name}.csv"
        if not path.is_file():
            known = ", ".join(self.tables) or "none"
            raise ResultsError(f'{self.folder} has no table "{name}"; tables are {known}')
        return read_table(path)

    @property
    def balls(self) -> pd.DataFrame:
        """Forces, angles, pressures of every ball at every step."""
        return self.table("balls")

    @property
    def shaft(self) -> pd.DataFrame:
        """Displacements and tilts of the shaft at every step."""
        return self.table("shaft")

    @property
    def energy(self) -> pd.DataFrame:
        """Energies of every step; in motion the ledger."""
        return self.table("energy")

    @property
    def steps(self) -> list[int]:
        """Numbers of the steps that have fields, from files of their own and from packs."""
        return list(self._places)

    def step(self, number: int) -> Step:
        """A step by its number; negative numbers count from the last one that there is."""
        steps = self.steps
        if number < 0 and -number <= len(steps):
            number = steps[number]
        if number not in self._places:
            known = f"steps are {steps[0]} to {steps[-1]}" if steps else f"it has none{self._of_bearings()}"
            raise ResultsError(f"{self.folder} has no step {number}; {known}")
        place = self._places[number]
        require_same_run(self.folder / MESH_FILE, place)
        return Step(number, place, self.mesh)

    def __iter__(self) -> Iterator[Step]:
        return (self.step(number) for number in self.steps)

    @cached_property
    def mesh(self) -> Mesh:
        """Rings and balls, undeformed."""
        if self.bearings:
            raise ResultsError(f"{self.folder} has no {MESH_FILE}{self._of_bearings()}")
        return read_mesh(self.folder)

    def dataset(self, fields: Iterable[str] = ("displacement",), steps: Iterable[int] | None = None) -> xarray.Dataset:
        """Fields over steps and points; dimensions step, point, and component of vectors and stress."""
        xr = _xarray()
        chosen = [self.step(number) for number in (self.steps if steps is None else steps)]
        if not chosen:
            raise ResultsError(f"{self.folder}: no step is chosen{self._of_bearings()}")
        arrays = {name: _over_steps(name, np.stack([step[name] for step in chosen])) for name in fields}
        points = {axis: ("point", self.mesh.points[:, i], {"units": "m"}) for i, axis in enumerate("xyz")}
        coordinates = {
            "step": [step.number for step in chosen],
            "time": ("step", [step.time for step in chosen], {"units": "s"}),
            "body": ("point", self.mesh.point_body),
            "vector": list(VECTOR_COMPONENTS),
            "tensor": list(STRESS_COMPONENTS),
            **points,
        }
        used = {dimension for dimensions, *_ in arrays.values() for dimension in dimensions}
        kept = {name: value for name, value in coordinates.items() if name not in {"vector", "tensor"} - used}
        return xr.Dataset(arrays, coords=kept, attrs={"folder": str(self.folder)})

    def balls_dataset(self) -> xarray.Dataset:
        """The table of the balls over step and ball, time and the swept value over step."""
        xr = _xarray()
        if "bearing" in self.balls:
            names = ", ".join(self.balls["bearing"].unique())
            raise ResultsError(f"{self.folder} holds the balls of several bearings: {names}; take bearing(name)")
        table = self.balls.set_index(["step", "ball"])
        data = xr.Dataset.from_dataframe(table)
        over_steps = [name for name in data if name == "time_s" or "." in str(name)]
        return data.assign_coords({name: data[name].isel(ball=0, drop=True) for name in over_steps})

    @cached_property
    def _places(self) -> dict[int, Place]:
        return find_steps(self.folder)

    def _of_bearings(self) -> str:
        """Where fields of a list of bearings are, for messages."""
        if not self.bearings:
            return ""
        return f"; each bearing has its own, bearing(name) opens it: {', '.join(self.bearings)}"

    def _document(self, name: str, hint: str) -> dict[str, Any]:
        path = self.folder / name
        if not path.is_file():
            raise ResultsError(f"{self.folder} has no {name}; {hint}")
        try:
            return dict(json.loads(path.read_text(encoding="utf-8")))
        except ValueError as error:
            raise ResultsError(f"{path} is damaged: {error}") from error


def open_results(folder: str | os.PathLike[str]) -> Results:
    """Opens a result folder of any command: run, resume, stiffness, campbell, life, heat, load-matrix."""
    return Results(folder)


def _over_steps(name: str, values: Any) -> tuple[tuple[str, ...], Any, dict[str, str]]:
    last = {3: ("vector",), 6: ("tensor",)}.get(values.shape[-1], ("component",)) if values.ndim == 3 else ()
    return ("step", "point", *last), values, {"units": unit_of_field(name)}


def unit_of_field(name: str) -> str:
    """The unit of a field over points of a step."""
    units = {
        "displacement": "m",
        "rotation": "rad",
        "velocity": "m/s",
        "acceleration": "m/s2",
        "force_inner": "N",
        "force_outer": "N",
        "in_region": "1",
    }
    return units.get(name, "Pa")


def _with_arrays(document: dict[str, Any]) -> dict[str, Any]:
    """The same with lists of lists of numbers as arrays."""

    def change(value: Any) -> Any:
        if isinstance(value, dict):
            return {key: change(part) for key, part in value.items()}
        if isinstance(value, list) and value and all(isinstance(row, list) for row in value):
            return np.array(value)
        if isinstance(value, list):
            return [change(part) for part in value]
        return value

    return {key: change(value) for key, value in document.items()}


def _xarray() -> Any:
    try:
        import xarray
    except ImportError as error:
        raise MissingPackage(f"{error}; install it with: pip install 'raceway[fields]'") from error
    return xarray
