"""Ring and block of compare-housing: their seats, the functions of the joint, and ball forces on the groove."""

import csv
import os
import sys

import h5py
import numpy

# Faces in the numbers of CalculiX: corners, and of tetrahedra the nodes between them.
QUADS = [(0, 1, 2, 3), (4, 7, 6, 5), (0, 4, 5, 1), (1, 5, 6, 2), (2, 6, 7, 3), (3, 7, 4, 0)]
TRIANGLES = [(0, 1, 2, 4, 5, 6), (0, 3, 1, 7, 8, 4), (1, 3, 2, 8, 9, 5), (2, 3, 0, 9, 7, 6)]


class Part:
    """Nodes, mm, and elements of a ring or the block, its seat and how raceway moves it, mm."""

    def __init__(self, nodes, cells, moved, seat_radius, half_width):
        used = numpy.unique(cells)
        self.nodes, self.moved = 1e3 * nodes[used], 1e3 * moved[used]
        self.cells = numpy.searchsorted(used, cells)
        self.faces = QUADS if self.cells.shape[1] == 8 else TRIANGLES
        radius = numpy.hypot(self.nodes[:, 0], self.nodes[:, 1])
        on_seat = (abs(radius - seat_radius) < 1e-3 * seat_radius) & (abs(self.nodes[:, 2]) < half_width + 1e-6)
        self.facets = []
        for number, face in enumerate(self.faces):
            for element in numpy.flatnonzero(on_seat[self.cells[:, face]].all(axis=1)):
                self.facets.append((element, number))
        self.seat, self.weights = self.seat_weights()

    def facet_nodes(self):
        return numpy.array([self.cells[element, list(self.faces[number])] for element, number in self.facets])

    def seat_weights(self):
        """Nodes of the seat and the integrals of their shape functions, mm^2."""
        facets = self.facet_nodes()
        weights = numpy.zeros(len(self.nodes))
        for n, dn, weight in rule(facets.shape[1]):
            tangents = [numpy.einsum("a,fai->fi", d, self.nodes[facets]) for d in dn]
            area = numpy.linalg.norm(numpy.cross(*tangents), axis=1)
            numpy.add.at(weights, facets, weight * area[:, None] * n[None, :])
        seat = numpy.unique(facets)
        return seat, weights[seat]


def rule(n_nodes):
    """Points of a facet: shape functions, their derivatives, weight."""
    found = []
    if n_nodes == 4:
        for x in (-(3 ** -0.5), 3 ** -0.5):
            for y in (-(3 ** -0.5), 3 ** -0.5):
                n, dx, dy = bilinear(x, y)
                found.append((n, (dx, dy), 1.0))
        return found
    a, b = (6 - 15 ** 0.5) / 21, (6 + 15 ** 0.5) / 21
    points = [(1 / 3, 1 / 3, 9 / 80)]
    for c, weight in ((a, (155 - 15 ** 0.5) / 2400), (b, (155 + 15 ** 0.5) / 2400)):
        points += [(c, c, weight), (1 - 2 * c, c, weight), (c, 1 - 2 * c, weight)]
    for x, y, weight in points:
        z = 1 - x - y
        n = numpy.array([z * (2 * z - 1), x * (2 * x - 1), y * (2 * y - 1), 4 * x * z, 4 * x * y, 4 * y * z])
        dx = numpy.array([1 - 4 * z, 4 * x - 1, 0, 4 * (z - x), 4 * y, -4 * y])
        dy = numpy.array([1 - 4 * z, 0, 4 * y - 1, -4 * x, 4 * x, 4 * (z - y)])
        found.append((n, (dx, dy), weight))
    return found


def bilinear(x, y):
    corners = numpy.array([(-1, -1), (1, -1), (1, 1), (-1, 1)])
    u, v = 1 + x * corners[:, 0], 1 + y * corners[:, 1]
    return u * v / 4, corners[:, 0] * v / 4, corners[:, 1] * u / 4


class Functions:
    """Fourier x Legendre on a seat, as docs/housings.md has them."""

    def __init__(self, harmonics, across, half_width):
        self.harmonics, self.across, self.half_width = harmonics, across, half_width

    def at(self, azimuth, z):
        """[points][functions of a component]."""
        legendre = numpy.polynomial.legendre.legvander(z / self.half_width, self.across)
        waves = [numpy.ones_like(azimuth)]
        for n in range(1, self.harmonics + 1):
            waves += [numpy.cos(n * azimuth), numpy.sin(n * azimuth)]
        return numpy.concatenate([wave[:, None] * legendre for wave in waves], axis=1)

    def of_part(self, part):
        """Values at the nodes of the seat and M."""
        x, y, z = part.nodes[part.seat].T
        phi = self.at(numpy.arctan2(y, x), z)
        return phi, phi.T @ (part.weights[:, None] * phi)

    def measure(self, part, moved):
        """Coefficients [function][radial, tangential, axial] of a displacement of all nodes."""
        phi, gram = self.of_part(part)
        return numpy.linalg.solve(gram, phi.T @ (part.weights[:, None] * cylindrical(part.nodes, moved)[part.seat]))

    def loads(self, part, forces):
        """Nodal forces [node][x, y, z] of forces on the functions."""
        phi, gram = self.of_part(part)
        own = numpy.zeros_like(part.nodes)
        own[part.seat] = part.weights[:, None] * (phi @ numpy.linalg.solve(gram, forces))
        return cartesian(part.nodes, own)


def cylindrical(nodes, u):
    azimuth = numpy.arctan2(nodes[:, 1], nodes[:, 0])
    c, s = numpy.cos(azimuth), numpy.sin(azimuth)
    return numpy.stack([c * u[:, 0] + s * u[:, 1], c * u[:, 1] - s * u[:, 0], u[:, 2]], axis=1)


def cartesian(nodes, u):
    azimuth = numpy.arctan2(nodes[:, 1], nodes[:, 0])
    c, s = numpy.cos(azimuth), numpy.sin(azimuth)
    return numpy.stack([c * u[:, 0] - s * u[:, 1], s * u[:, 0] + c * u[:, 1], u[:, 2]], axis=1)


def table(path):
    with open(path) as file:
        rows = list(csv.DictReader(file))
    return {key: numpy.array([float(row[key]) for row in rows]) for key in rows[0]}


def parts(out, seat_radius, half_width):
    """The outer ring and the block."""
    with h5py.File(os.path.join(out, "mesh.hdf")) as mesh, h5py.File(os.path.join(out, "step_000000.hdf")) as step:
        grid = mesh["VTKHDF"]
        nodes, offsets, body = grid["Points"][()], grid["Offsets"][()], grid["CellData/body"][()]
        connectivity, moved = grid["Connectivity"][()], step["VTKHDF/PointData/displacement"][()]
    spans = list(zip(offsets[:-1], offsets[1:], body))
    cells = [numpy.array([connectivity[a:b] for a, b, own in spans if own == number]) for number in (1, 3)]
    return [Part(nodes, own, moved, seat_radius, half_width) for own in cells]


class Groove:
    """Facets of the groove of the outer ring, as rectangles of azimuth and angle about the centre of the groove."""

    def __init__(self, ring, centre_radius, radius):
        self.ring, self.centre_radius, self.radius = ring, centre_radius, radius
        x, y, z = ring.nodes.T
        from_centre = numpy.hypot(x, y) - centre_radius
        on_groove = abs(numpy.hypot(from_centre, z) - radius) < 1e-3
        facets = numpy.concatenate([ring.cells[:, face] for face in QUADS])
        self.facets = facets[on_groove[facets].all(axis=1)]
        azimuth = numpy.arctan2(y, x)[self.facets]
        azimuth = azimuth[:, :1] + numpy.angle(numpy.exp(1j * (azimuth - azimuth[:, :1])))
        corners = numpy.stack([azimuth, numpy.arctan2(z, from_centre)[self.facets]], axis=2)
        self.low, self.size = corners.min(axis=1), numpy.ptp(corners, axis=1)
        # Of the corners, 0 or 1 in both directions.
        self.corners = (corners - self.low[:, None]) / self.size[:, None]

    def locate(self, place):
        """The facet of an azimuth and angle, and where in it, from 0 to 1."""
        off = place - self.low
        off[:, 0] = numpy.angle(numpy.exp(1j * off[:, 0]))
        share = off / self.size
        best = abs(share - 0.5).max(axis=1).argmin()
        if abs(share[best] - 0.5).max() > 0.5 + 1e-6:
            sys.exit("compare-housing: a contact reaches beyond the groove")
        return best, share[best]

    def weights(self, place, hertz, least):
        """Shares of the nodes in a semi-ellipsoidal pressure; semi-axes `hertz`, mm, but at least some elements."""
        lengths = numpy.array([self.centre_radius + self.radius * numpy.cos(place[1]), self.radius])
        axes = numpy.maximum(hertz, least * lengths * self.size[self.locate(place)[0]])
        shares = numpy.zeros(len(self.ring.nodes))
        heights, gauss = numpy.polynomial.legendre.leggauss(24)
        phases = 2 * numpy.pi * (numpy.arange(96) + 0.5) / 96
        for height, weight in zip((heights + 1) / 2, gauss / 2):
            for phase in phases:
                disc = (1 - height ** 2) ** 0.5 * numpy.array([numpy.cos(phase), numpy.sin(phase)])
                facet, inside = self.locate(place + axes * disc / lengths)
                shape = (1 - abs(self.corners[facet] - inside)).prod(axis=1)
                shares[self.facets[facet]] += 3 * height ** 2 * weight / len(phases) * shape
        return shares

    def ball_forces(self, summary, least):
        """Nodal forces of all balls, whose lines run through the centres of the groove."""
        loads = numpy.zeros_like(self.ring.nodes)
        for ball in summary["balls"]:
            force, angle = ball["outer"]["force_n"], ball["outer"]["contact_angle_rad"]
            if force == 0.0:
                continue
            azimuth = ball["azimuth_rad"]
            along, rolling = ball["outer"]["semi_axes_m"]
            shares = self.weights(numpy.array([azimuth, angle]), 1e3 * numpy.array([rolling, along]), least)
            c, s = numpy.cos(azimuth), numpy.sin(azimuth)
            line = numpy.array([c * numpy.cos(angle), s * numpy.cos(angle), numpy.sin(angle)])
            centre = self.centre_radius * numpy.array([c, s, 0.0])
            nodes = numpy.flatnonzero(shares)
            share = shares[nodes][:, None]
            mean = (share * self.ring.nodes[nodes]).sum(axis=0)
            arms = self.ring.nodes[nodes] - mean
            # share (line + turn x arm) has no moment about the centre.
            inertia = numpy.eye(3) * (share * arms ** 2).sum() - arms.T @ (share * arms)
            turn = numpy.linalg.solve(inertia, numpy.cross(centre - mean, line))
            own = force * share * (line + numpy.cross(turn, arms))
            wrong = [own.sum(axis=0) - force * line, numpy.cross(self.ring.nodes[nodes] - centre, own).sum(axis=0)]
            if max(abs(wrong[0]).max(), abs(wrong[1]).max()) > 1e-6 * force:
                sys.exit("compare-housing: the nodal forces of a ball have another resultant than the ball")
            loads[nodes] += own
        return loads
