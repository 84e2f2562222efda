"""Ring meshes of the 7010C: a structured section, revolved, of 8-node hexahedra, as MSH 2.2 text in mm."""

import math
from dataclasses import dataclass

# Measures of the rings, mm; those of the tests' scene, and shoulders, which that scene leaves open.
WIDTH = 16.0
BALLS = 18


@dataclass(frozen=True)
class Side:
    """One of the two rings; measures in mm."""

    seat: str
    seat_diameter: float
    raceway_diameter: float
    groove_radius: float
    shoulder_diameter: float
    outwards: float


INNER = Side("bore", 50.0, 56.01, 4.65, 60.4, 1.0)
OUTER = Side("seat", 80.0, 74.037, 4.75, 68.6, -1.0)


@dataclass(frozen=True)
class Level:
    """How finely a ring is divided, and what makes it irregular."""

    sectors: int = 54
    groove: int = 6
    shoulder: int = 1
    thickness: int = 1
    # Sectors of elements whose seat has no facets: nothing holds it there.
    free_seat: range = range(0)
    # Sectors of nodes whose shoulders stand a little farther out along the axis.
    moved: range = range(0)


def centre_radius(side):
    """Distance of the groove's centre from the axis, mm."""
    return side.raceway_diameter / 2 + side.outwards * side.groove_radius


def column_ends(side, level, column):
    """First and last point (r, z) of a column of nodes, on the raceway's side and on the seat, mm."""
    centre, radius = centre_radius(side), side.groove_radius
    height = side.outwards * (centre - side.shoulder_diameter / 2)
    reach = math.sqrt(radius**2 - height**2)
    columns = 2 * level.shoulder + level.groove
    shoulder, seat = side.shoulder_diameter / 2, side.seat_diameter / 2
    step = (WIDTH / 2 - reach) / level.shoulder
    if column < level.shoulder:
        z = -WIDTH / 2 + step * column
        return (shoulder, z), (seat, z)
    if columns - column < level.shoulder:
        z = WIDTH / 2 - step * (columns - column)
        return (shoulder, z), (seat, z)
    share = 2.0 * (column - level.shoulder) / level.groove - 1.0
    angle = share * math.atan2(reach, height)
    race = (centre - side.outwards * radius * math.cos(angle), radius * math.sin(angle))
    return race, (seat, share * reach)


def section_points(side, level):
    """Points (r, z) of the section, column by column, finer towards the raceway, mm."""
    points = []
    for column in range(2 * level.shoulder + level.groove + 1):
        race, back = column_ends(side, level, column)
        for row in range(level.thickness + 1):
            s = (row / level.thickness) ** 1.4
            points.append(tuple(a + s * (b - a) for a, b in zip(race, back)))
    return points


def node_lines(side, level):
    """Lines of the section $Nodes."""
    points, lines = section_points(side, level), []
    for sector in range(level.sectors):
        angle = 2.0 * math.pi * sector / level.sectors
        for index, (r, z) in enumerate(points):
            # The first point lies on the edge of a shoulder, away from raceway and seat.
            if sector in level.moved and index == 0:
                z -= 0.2
            lines.append(f"{len(lines) + 1} {r * math.cos(angle)!r} {r * math.sin(angle)!r} {z!r}")
    return lines


def element_lines(side, level):
    """Lines of the section $Elements: groups 1 ring, 2 raceway, 3 seat."""
    rows, columns = level.thickness, 2 * level.shoulder + level.groove
    per_sector = (columns + 1) * (rows + 1)
    found = []

    def quad(sector, corners):
        return [1 + (sector % level.sectors) * per_sector + i * (rows + 1) + j for i, j in corners]

    def facet(sector, i, j):
        return quad(sector, [(i, j), (i + 1, j)]) + quad(sector + 1, [(i + 1, j), (i, j)])

    for sector in range(level.sectors):
        for i in range(columns):
            if level.shoulder <= i < level.shoulder + level.groove:
                found.append((3, 2, facet(sector, i, 0)))
            if sector not in level.free_seat:
                found.append((3, 3, facet(sector, i, rows)))
    for sector in range(level.sectors):
        for i in range(columns):
            for j in range(rows):
                corners = [(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)]
                # Rows run towards the axis in the inner ring, away from it in the outer one.
                if side.outwards > 0:
                    corners.reverse()
                found.append((5, 1, quad(sector, corners) + quad(sector + 1, corners)))
    return [
        f"{tag} {kind} 2 {group} {group} {' '.join(map(str, nodes))}"
        for tag, (kind, group, nodes) in enumerate(found, start=1)
    ]


def text(side, level):
    """The whole file."""
    nodes, elements = node_lines(side, level), element_lines(side, level)
    names = ['3 1 "ring"', '2 2 "raceway"', f'2 3 "{side.seat}"']
    parts = ["$MeshFormat", "2.2 0 8", "$EndMeshFormat"]
    for name, lines in [("PhysicalNames", names), ("Nodes", nodes), ("Elements", elements)]:
        parts += [f"${name}", str(len(lines)), *lines, f"$End{name}"]
    return "\n".join(parts) + "\n"
