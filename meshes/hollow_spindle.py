"""Mesh of a hollow spindle with the seats of a pair of 7010C: needs the Python package gmsh.

    python3 meshes/hollow_spindle.py [SIZE] [OUT] [DISTANCE]

SIZE is the size of the elements in mm (default 16), OUT the file (default hollow_spindle.msh beside this file), DISTANCE
that of the middles of both seats (default 70). Lengths in mm, the axis is z, the nose at z = 0, the middle of the front
seat at z = 60, that of the rear one at z = 60 + DISTANCE.
Groups: volume "body"; surfaces "seat_front" and "seat_rear" (radius 25, 16 wide) and "nose" (the face at z = 0).
"""

import gmsh

import gmsh_body

SEAT_RADIUS, SEAT_HALF = 25.0, 8.0     # the inner ring of a 7010
RELIEF_RADIUS = 24.5                   # beside the seats
BORE = 12.5
FRONT = 60.0                           # from the nose to the middle of the front seat
COLLAR = 45.0                          # length of the nose, of radius 35
DRIVE_RADIUS, DRIVE = 20.0, 75.0       # behind the rear seat


def build(size, distance):
    occ = gmsh.model.occ
    rear = FRONT + distance
    end = rear + SEAT_HALF + DRIVE
    parts = [
        (0.0, COLLAR, 35.0),
        (COLLAR, FRONT - SEAT_HALF, RELIEF_RADIUS),
        (FRONT - SEAT_HALF, FRONT + SEAT_HALF, SEAT_RADIUS),
        (FRONT + SEAT_HALF, rear - SEAT_HALF, RELIEF_RADIUS),
        (rear - SEAT_HALF, rear + SEAT_HALF, SEAT_RADIUS),
        (rear + SEAT_HALF, end, DRIVE_RADIUS),
    ]
    solids = [(3, occ.addCylinder(0, 0, a, 0, 0, b - a, radius)) for a, b, radius in parts]
    solid, _ = occ.fuse(solids[:1], solids[1:])
    occ.cut(solid, [(3, occ.addCylinder(0, 0, 0, 0, 0, end, BORE))])
    occ.synchronize()
    volumes = [tag for _, tag in gmsh.model.getEntities(3)]
    assert len(volumes) == 1, volumes
    groups = {"seat_front": [], "seat_rear": [], "nose": []}
    for _, tag in gmsh.model.getEntities(2):
        x0, _, z0, x1, _, z1 = gmsh.model.getBoundingBox(2, tag)
        is_seat = abs(max(x1, -x0) - SEAT_RADIUS) < 1e-3 and abs(z1 - z0 - 2 * SEAT_HALF) < 1e-3
        if gmsh.model.getType(2, tag) == "Cylinder" and is_seat:
            groups["seat_front" if z1 < FRONT + distance / 2 else "seat_rear"].append(tag)
        elif abs(z0) < 1e-3 and abs(z1) < 1e-3:
            groups["nose"].append(tag)
    assert all(groups.values()), groups
    groups = [(3, volumes, "body")] + [(2, tags, name) for name, tags in groups.items()]
    gmsh_body.mesh(groups, size, 24)


gmsh_body.main(build, __file__, [16.0, 70.0])
