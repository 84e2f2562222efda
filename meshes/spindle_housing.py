"""Mesh of a spindle housing for a pair of 7010C, a sleeve on a flange: needs the Python package gmsh.

    python3 meshes/spindle_housing.py [SIZE] [OUT] [DISTANCE]

SIZE is the size of the elements in mm (default 12), OUT the file (default spindle_housing.msh beside this file),
DISTANCE that of the middles of both seats (default 70). Lengths in mm, the axis of both seats is z, the middle of the
front one z = 0, that of the rear one z = DISTANCE.
Groups: volume "body"; surfaces "seat_front" and "seat_rear" (radius 40, 16 wide) and "flange" (the face of the flange
at the rear, outside a radius of 65).
"""

import gmsh

import gmsh_body

SEAT_RADIUS, SEAT_HALF = 40.0, 8.0     # the outer ring of a 7010
RELIEF_RADIUS = 41.0                   # bore beside the seats
OUTSIDE, FLANGE = 55.0, 85.0           # radii of sleeve and flange
END, THICKNESS = 6.0, 18.0             # from a seat to the end of the sleeve, thickness of the flange


def build(size, distance):
    occ = gmsh.model.occ
    start, end = -SEAT_HALF - END, distance + SEAT_HALF + END
    sleeve = occ.addCylinder(0, 0, start, 0, 0, end - start, OUTSIDE)
    flange = occ.addCylinder(0, 0, end - THICKNESS, 0, 0, THICKNESS, FLANGE)
    spigot = occ.addCylinder(0, 0, end, 0, 0, 4.0, 65.0)
    solid, _ = occ.fuse([(3, sleeve)], [(3, flange), (3, spigot)])
    bore = occ.addCylinder(0, 0, start, 0, 0, end + 4.0 - start, SEAT_RADIUS)
    reliefs = [(start, -SEAT_HALF), (SEAT_HALF, distance - SEAT_HALF), (distance + SEAT_HALF, end + 4.0)]
    cuts = [occ.addCylinder(0, 0, a, 0, 0, b - a, RELIEF_RADIUS) for a, b in reliefs]
    occ.cut(solid, [(3, bore)] + [(3, cut) for cut in cuts])
    occ.synchronize()
    volumes = [tag for _, tag in gmsh.model.getEntities(3)]
    assert len(volumes) == 1, volumes
    groups = {"seat_front": [], "seat_rear": [], "flange": []}
    for _, tag in gmsh.model.getEntities(2):
        x0, _, z0, x1, _, z1 = gmsh.model.getBoundingBox(2, tag)
        if gmsh.model.getType(2, tag) == "Cylinder":
            if abs(x1 - SEAT_RADIUS) > 1e-3 and abs(x0 + SEAT_RADIUS) > 1e-3:
                continue
            if abs(z1 - z0 - 2 * SEAT_HALF) < 1e-3:
                name = "seat_front" if z1 < distance / 2 else "seat_rear"
                groups[name].append(tag)
        elif abs(z0 - end) < 1e-3 and abs(z1 - end) < 1e-3:
            groups["flange"].append(tag)
    assert all(groups.values()), groups
    groups = [(3, volumes, "body")] + [(2, tags, name) for name, tags in groups.items()]
    gmsh_body.mesh(groups, size, 28)


gmsh_body.main(build, __file__, [12.0, 70.0])
