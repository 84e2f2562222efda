"""The mesh of a run: both rings as finite elements, and a vertex for each ball."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
import numpy.typing as npt

from .errors import ResultsError

Floats = npt.NDArray[np.floating]
Integers = npt.NDArray[np.integer]

#: Number of a body in `Mesh.body` by its name.
BODIES = {"inner": 0, "outer": 1, "balls": 2}
#: Corners of the faces of a cell by its VTK type; the first nodes of a quadratic cell are its corners.
FACES: dict[int, tuple[tuple[int, ...], ...]] = {
    kind: faces
    for kinds, faces in [
        ((10, 24), ((0, 2, 1), (0, 1, 3), (1, 2, 3), (0, 3, 2))),
        ((12, 25, 29), ((0, 3, 2, 1), (4, 5, 6, 7), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7))),
    ]
    for kind in kinds
}


@dataclass(frozen=True)
class Mesh:
    """All bodies as one unstructured grid, undeformed."""

    #: Places of the nodes and of the centres of the balls, m, [n_points][3].
    points: Floats
    #: Nodes of all cells, one cell after another; cell i has those from offsets[i] to offsets[i + 1].
    connectivity: Integers
    #: Where the nodes of a cell start in `connectivity`, [n_cells + 1].
    offsets: Integers
    #: VTK type of each cell: 12, 25, 29 hexahedra of 8, 20, 27 nodes, 24 tetrahedra of 10, 1 a ball.
    types: Integers
    #: Body of each cell: 0 the inner ring, 1 the outer ring, 2 the balls.
    body: Integers
    #: Radius of the ball of each cell, m; 0 for the cells of a ring.
    radius: Floats

    @property
    def n_points(self) -> int:
        """Number of nodes and balls."""
        return len(self.points)

    @property
    def n_cells(self) -> int:
        """Number of elements and balls."""
        return len(self.types)

    @cached_property
    def point_body(self) -> Integers:
        """Body of each point, [n_points]: 0 the inner ring, 1 the outer ring, 2 the balls."""
        bodies = np.full(self.n_points, -1, dtype=np.int64)
        bodies[self.connectivity] = np.repeat(self.body, np.diff(self.offsets))
        return bodies

    def points_of(self, body: str) -> Integers:
        """Numbers of the points of a body: "inner", "outer" or "balls"."""
        return np.flatnonzero(self.point_body == body_number(body))

    def cells_of(self, body: str) -> Integers:
        """Numbers of the cells of a body: "inner", "outer" or "balls"."""
        return np.flatnonzero(self.body == body_number(body))

    def surface(self, body: str) -> Integers:
        """Triangles on the surface of a ring, [n_triangles][3]: the corners of faces that one element alone has."""
        faces: list[tuple[int, ...]] = []
        for cell in self.cells_of(body):
            nodes = self.connectivity[self.offsets[cell] : self.offsets[cell + 1]]
            kind = int(self.types[cell])
            if kind not in FACES:
                known = ", ".join(map(str, sorted(FACES)))
                raise ResultsError(f"cells of {body} have the VTK type {kind}; surfaces are known of {known}")
            faces += [tuple(int(nodes[corner]) for corner in face) for face in FACES[kind]]
        seen: dict[tuple[int, ...], tuple[int, ...]] = {}
        for face in faces:
            key = tuple(sorted(face))
            if key in seen:
                del seen[key]
            else:
                seen[key] = face
        triangles = [(f[0], f[i], f[i + 1]) for f in seen.values() for i in range(1, len(f) - 1)]
        return np.array(triangles, dtype=np.int64).reshape(-1, 3)


def body_number(name: str) -> int:
    """Number of a body in the files."""
    if name not in BODIES:
        raise ValueError(f'no body "{name}"; bodies are {", ".join(BODIES)}')
    return BODIES[name]
