"""Mesh of a plummer block for a 6010 on two feet: needs the Python package gmsh.

    python3 meshes/plummer_block.py [SIZE] [OUT]

SIZE is the size of the elements in mm (default 7.5), OUT the file (default plummer_block.msh beside this file).
Lengths in mm, the axis of the seat is z, its middle z = 0, the ground lies at y = -60.
Groups: volume "body"; surfaces "seat_a" (radius 40, 16 wide) and "feet" (two pads of 35 x 28).
"""

import math

import gmsh

import gmsh_body

SEAT_RADIUS, SEAT_HALF = 40.0, 8.0     # the outer ring of a 6010
RELIEF_RADIUS, HALF = 41.5, 14.0       # bore beside the seat, half of the width of the block
CAP_RADIUS, GROUND = 53.0, -60.0       # outside of the cap, height of the ground
BASE_HALF, BASE_TOP = 95.0, -44.0      # base plate
PAD, PAD_HEIGHT = 35.0, 4.0            # length and height of a foot


def build(size):
    occ = gmsh.model.occ
    width = 2 * HALF
    cap = occ.addCylinder(0, 0, -HALF, 0, 0, width, CAP_RADIUS)
    web = occ.addBox(-CAP_RADIUS, BASE_TOP, -HALF, 2 * CAP_RADIUS, -BASE_TOP, width)
    base = occ.addBox(-BASE_HALF, GROUND, -HALF, 2 * BASE_HALF, BASE_TOP - GROUND, width)
    solid, _ = occ.fuse([(3, cap)], [(3, web), (3, base)])
    between = 2 * (BASE_HALF - PAD)
    recess = occ.addBox(-between / 2, GROUND, -HALF, between, PAD_HEIGHT, width)
    bore = occ.addCylinder(0, 0, -HALF, 0, 0, width, SEAT_RADIUS)
    ends = [
        occ.addCylinder(0, 0, start, 0, 0, HALF - SEAT_HALF, RELIEF_RADIUS)
        for start in (-HALF, SEAT_HALF)
    ]
    occ.cut(solid, [(3, recess), (3, bore)] + [(3, end) for end in ends])
    occ.synchronize()
    volumes = [tag for _, tag in gmsh.model.getEntities(3)]
    assert len(volumes) == 1, volumes
    seat, feet = [], []
    for _, tag in gmsh.model.getEntities(2):
        x0, y0, z0, x1, y1, z1 = gmsh.model.getBoundingBox(2, tag)
        if abs(y0 - GROUND) < 1e-3 and abs(y1 - GROUND) < 1e-3:
            feet.append(tag)
        elif gmsh.model.getType(2, tag) == "Cylinder" and abs(z1 - SEAT_HALF) < 1e-3 and abs(z0 + SEAT_HALF) < 1e-3:
            low, high = gmsh.model.getParametrizationBounds(2, tag)
            middle = [(a + b) / 2 for a, b in zip(low, high)]
            x, y, _ = gmsh.model.getValue(2, tag, middle)
            assert abs(math.hypot(x, y) - SEAT_RADIUS) < 1e-6, (x, y)
            seat.append(tag)
    assert seat and len(feet) == 2, (seat, feet)
    groups = [(3, volumes, "body"), (2, seat, "seat_a"), (2, feet, "feet")]
    gmsh_body.mesh(groups, size, 36)


gmsh_body.main(build, __file__, [7.5])
