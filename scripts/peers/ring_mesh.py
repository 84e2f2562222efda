"""A ring's mesh as arrays, for the programs that raceway is compared with."""

import meshio
import numpy


def read(path):
    """Nodes, m, [n][3], and the corners of the hexahedra, [m][8], in the order of Gmsh and Abaqus; the file is in mm."""
    mesh = meshio.read(path)
    corners = numpy.vstack([block.data for block in mesh.cells if block.type == "hexahedron"])
    used = numpy.unique(corners)
    number = numpy.full(len(mesh.points), -1)
    number[used] = numpy.arange(len(used))
    return 1e-3 * mesh.points[used], number[corners]


def bore(nodes):
    """The nodes of the bore: those of the least radius."""
    radius = numpy.hypot(nodes[:, 0], nodes[:, 1])
    return numpy.flatnonzero(radius < radius.min() * (1 + 1e-9))


def contacts(nodes, n_balls):
    """Of each ball, the node of the raceway in the plane z = 0 that is next to it."""
    radius = numpy.hypot(nodes[:, 0], nodes[:, 1])
    height = numpy.abs(nodes[:, 2]).min()
    middle = numpy.flatnonzero(numpy.abs(nodes[:, 2]) <= height + 1e-9)
    raceway = middle[radius[middle] > radius[middle].max() - 1e-9]
    azimuth = numpy.arctan2(nodes[raceway, 1], nodes[raceway, 0])
    balls = 2 * numpy.pi * numpy.arange(n_balls) / n_balls
    away = numpy.abs(numpy.angle(numpy.exp(1j * (azimuth[:, None] - balls))))
    return raceway[away.argmin(axis=0)]
