"""Step files: the fields of one step, and where steps are."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

import h5py
import numpy as np

from .errors import MissingPackage, ResultsError
from .meshes import Floats, Mesh

if TYPE_CHECKING:
    import pyvista

MESH_FILE = "mesh.hdf"
STEP_FILE = re.compile(r"step_(\d{6,})\.hdf")
PACK_FILE = re.compile(r"pack_(\d{6,})_(\d{6,})\.hdf")
STEP_GROUP = re.compile(r"step_(\d{6,})")
#: Names of the six components of a stress in their order: that of VTK.
STRESS_COMPONENTS = ("xx", "yy", "zz", "xy", "yz", "xz")
VECTOR_COMPONENTS = ("x", "y", "z")


@dataclass(frozen=True)
class Place:
    """A step in its file: the group at which its paths start."""

    file: Path
    group: str


class Step(Mapping[str, Floats]):
    """One step: its fields over the points by their names, read when asked for.

    `step["displacement"]` is in m, [n_points][3]; `step["stress"]` in Pa, [n_points][6] in the order of
    `STRESS_COMPONENTS`; `step["von_mises"]` in Pa; `step["force_inner"]` and `step["force_outer"]` in N, on the balls.
    """

    def __init__(self, number: int, place: Place, mesh: Mesh) -> None:
        self.number = number
        #: The mesh of the run.
        self.mesh = mesh
        self._place = place
        with _opened(place.file) as file:
            group = file[place.group]
            #: Time, s; of a sweep or of modes the number of the step.
            self.time = float(group["VTKHDF/FieldData/time"][0])
            self._names = sorted(group["VTKHDF/PointData"]) if "PointData" in group["VTKHDF"] else []
            cells = group["VTKHDF/CellData"] if "CellData" in group["VTKHDF"] else {}
            #: Names of the fields over cells, such as `stress_integration_points`.
            self.cell_fields = sorted(set(cells) - {"body", "radius"})

    def __getitem__(self, name: str) -> Floats:
        if name not in self._names:
            raise KeyError(f'step {self.number} has no field "{name}" over points; fields are {", ".join(self._names)}')
        return self._read(f"VTKHDF/PointData/{name}")

    def __iter__(self) -> Iterator[str]:
        return iter(self._names)

    def __len__(self) -> int:
        return len(self._names)

    def __repr__(self) -> str:
        return f"<raceway.Step {self.number}, time {self.time:g} s, fields {', '.join(self._names)}>"

    def cells(self, name: str) -> Floats:
        """A field over the cells, [n_cells] or [n_cells][n]."""
        if name not in self.cell_fields:
            known = ", ".join(self.cell_fields) or "none"
            raise KeyError(f'step {self.number} has no field "{name}" over cells; fields are {known}')
        return self._read(f"VTKHDF/CellData/{name}")

    def to_pyvista(self, scale: float = 0.0) -> pyvista.UnstructuredGrid:
        """The bodies with all fields as a mesh of PyVista; `scale` times the displacement moves its points."""
        try:
            import pyvista
        except ImportError as error:
            raise MissingPackage(f"{error}; install it with: pip install 'raceway[meshes]'") from error
        mesh, points = self.mesh, self.mesh.points
        if scale != 0.0:
            points = points + scale * self["displacement"]
        counts = np.diff(mesh.offsets)
        cells = np.insert(mesh.connectivity, mesh.offsets[:-1], counts)
        grid = pyvista.UnstructuredGrid(cells, mesh.types, points)
        for name in self:
            grid.point_data[name] = self[name]
        grid.cell_data["body"], grid.cell_data["radius"] = mesh.body, mesh.radius
        for name in self.cell_fields:
            grid.cell_data[name] = self.cells(name)
        return grid

    @cached_property
    def scene(self) -> str:
        """Text of the scene, with its overrides, as it was run."""
        with _opened(self._place.file) as file:
            return _text(file[self._place.group]["restart"].attrs["scene"])

    def _read(self, path: str) -> Floats:
        with _opened(self._place.file) as file:
            try:
                return np.asarray(file[self._place.group][path][()])
            except (KeyError, OSError) as error:
                raise ResultsError(f"{self._place.file}: {path} cannot be read: {error}") from error


def find_steps(folder: Path) -> dict[int, Place]:
    """Where each step is, by its number; a step file counts before the same step in a pack."""
    steps: dict[int, Place] = {}
    for path in sorted(folder.iterdir()):
        if PACK_FILE.fullmatch(path.name):
            with _opened(path) as file:
                groups = [found for name in file if (found := STEP_GROUP.fullmatch(name))]
            steps |= {int(found[1]): Place(path, f"/{found[0]}") for found in groups}
    for path in folder.iterdir():
        if found := STEP_FILE.fullmatch(path.name):
            steps[int(found[1])] = Place(path, "/")
    return dict(sorted(steps.items()))


def read_point_fields(path: Path) -> dict[str, Floats]:
    """All fields over the points of a file, by name."""
    with _opened(path) as file:
        try:
            return {name: np.asarray(field[()]) for name, field in file["VTKHDF/PointData"].items()}
        except (KeyError, OSError) as error:
            raise ResultsError(f"{path} is damaged: {error}") from error


def read_mesh(folder: Path) -> Mesh:
    """The mesh of the run in a folder."""
    path = folder / MESH_FILE
    if not path.is_file():
        raise ResultsError(f"{folder} has no {MESH_FILE}; expected the results of a run that writes steps")
    with _opened(path) as file:
        try:
            grid = file["VTKHDF"]
            return Mesh(
                points=grid["Points"][()],
                connectivity=grid["Connectivity"][()],
                offsets=grid["Offsets"][()],
                types=grid["Types"][()],
                body=grid["CellData/body"][()],
                radius=grid["CellData/radius"][()],
            )
        except (KeyError, OSError) as error:
            raise ResultsError(f"{path} is damaged: {error}") from error


def require_same_run(mesh: Path, place: Place) -> None:
    """Fails if a step belongs to another run than the mesh beside it."""
    with _opened(mesh) as file:
        own = {key: _text(file["restart"].attrs[key]) for key in ("mesh_hash", "run") if key in file["restart"].attrs}
    with _opened(place.file) as file:
        texts = file[place.group]["restart"].attrs
        other = {key: _text(texts[key]) for key in own if key in texts}
    for key, value in other.items():
        if value != own[key]:
            raise ResultsError(f"{place.file} is of another run than {mesh.name} beside it: {value}, not {own[key]}")


def _opened(path: Path) -> Any:
    try:
        return h5py.File(path, "r")
    except OSError as error:
        raise ResultsError(f"{path} is damaged or no HDF5 file: {error}") from error


def _text(value: Any) -> str:
    return value.decode() if isinstance(value, bytes) else str(value)
