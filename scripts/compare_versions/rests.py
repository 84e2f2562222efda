"""Scenes at rest, quasi-static runs, sweeps and modes: results within the tolerance of their iterations."""

from .motions import FREE_TILT, KEYWAY, MEAN, NODE_PROBES, RIGID, STRESS_PROBES
from .scene import MODES, STATIC, Case

SWEEP = '[sweep]\nkey = "effects.radial_force.value"\nvalues = ["0 kN", "0.5 kN", "1 kN"]\n'
QUASI = '[quasi_static]\nduration = "1 ms"\nstep = "0.25 ms"\noutput_every = 2\n[speed]\ninner = "1800 rpm"\n'
SPINNING = '[speed]\ninner = "30000 rpm"\n[effects.ball_centrifugal]\n[effects.gyroscopic_moment]\n[static]\n'
ALL_BODIES = '[modes]\nnumber = 9\nbodies = ["inner", "outer", "bearing"]\n'
FITTED = ('[effects.fit.inner]\ninterference = "10 um"\n'
          '[effects.fit.outer]\ninterference = "5 um"\nhousing_diameter = "160 mm"\n'
          '[[effects.seat_form]]\nring = "inner"\norder = 3\namplitude = "1 um"\n')
SPARSE = "solver.backend=sparse"
MASS = "shaft.mass=2 kg"

REST = [
    Case("static", STATIC, meshes="coarse", threads=True),
    Case("static_facet", STATIC, settings=("contact.mode=facet",), meshes="coarse"),
    Case("static_rigid", STATIC, settings=RIGID),
    Case("static_tilt_mean", STATIC, settings=FREE_TILT, edits=MEAN),
    Case("static_keyway", STATIC, KEYWAY + "[static]\n"),
    Case("static_partly_held", STATIC, settings=("inner.partial=true",), meshes="inner_partly_held"),
    Case("static_moved_nodes", STATIC, meshes="moved_nodes"),
    Case("static_sparse", STATIC, settings=(SPARSE,)),
    Case("static_sectors", STATIC, settings=("solver.backend=sector", "solver.sectors=5"), threads=True),
    Case("static_many_sectors", STATIC, settings=("solver.backend=sector", "solver.sectors=18")),
    Case("static_tet10", STATIC, meshes="tet10"),
    Case("static_hex20", STATIC, meshes="fine"),
    Case("static_outer_rigid", STATIC, settings=("outer.flexible=false",)),
    Case("static_driven", STATIC, settings=("shaft.z=40 um", "shaft.tilt_y=0.1 mrad")),
    Case("static_near_field", STATIC, STRESS_PROBES + "[static]\n", meshes="coarse"),
    Case("static_points", STATIC, '[output]\nstress = "integration_points"\nprecision = "f64"\n[static]\n'),
    Case("static_spinning", STATIC, SPINNING),
    Case("static_gravity", STATIC, '[effects.gravity]\nacceleration = "9.81 m/s2"\ndirection = [0, -1, 0]\n'
         '[effects.moment]\nx = "1 N m"\ny = "3 N m"\n[static]\n', FREE_TILT),
    Case("static_fitted", STATIC, FITTED + "[static]\n"),
    Case("sweep", STATIC, SWEEP + NODE_PROBES),
    Case("sweep_sparse", STATIC, SWEEP, (SPARSE,), edits=MEAN),
    Case("quasi_static", STATIC, QUASI + NODE_PROBES + STRESS_PROBES, threads=True),
    Case("quasi_static_mean", STATIC, QUASI + KEYWAY, edits=MEAN),
]
MODE_CASES = [
    Case("modes", MODES, ALL_BODIES, (MASS,), threads=True),
    Case("modes_free", MODES, '[modes]\nnumber = 9\nbodies = ["outer", "inner"]\nsupport = "free"\n'),
    Case("modes_mean_tilt", MODES, ALL_BODIES, FREE_TILT, edits=MEAN),
    Case("modes_sparse", MODES, ALL_BODIES, (MASS, SPARSE)),
    Case("modes_partly_held", MODES, ALL_BODIES, (MASS, "outer.partial=true"), meshes="outer_partly_held"),
    Case("modes_keyway", MODES, KEYWAY + ALL_BODIES, (MASS,)),
    Case("modes_rigid", MODES, "[modes]\nnumber = 60\n", (MASS, *RIGID)),
]
CASES = REST + MODE_CASES
