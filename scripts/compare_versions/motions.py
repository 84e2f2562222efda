"""Scenes of motion in time: their results must have the same bits."""

from .scene import MOTION, Case

RIGID = ("contact.mode=rigid", "inner.flexible=false", "outer.flexible=false")
MEAN = (('support = "clamped"', 'support = "mean_motion"'),) * 2
MASS = "shaft.mass=0.5 kg"
FREE_TILT = ("shaft.tilt_x=free", "shaft.tilt_y=free", MASS)
LOW_PRELOAD = "effects.axial_force.value=0.4 kN"
FRAME = "[effects.frame_rotation]\n[effects.ball_centrifugal]\n"
STIFFENED = "[effects.frame_rotation]\nstress_stiffening = true\n"
KEYWAY = '[[inner.cut]]\nazimuth = ["84 deg", "96 deg"]\nz = ["5 mm", "8 mm"]\n'
# Steps are retried in halves down to dt / 64 and rise again.
ADAPTIVE = "halvings = 6\nadaptive = { tolerance = 1e-2 }"
DAMPING = (
    '[effects.rayleigh_damping]\nmass = "10 1/s"\nstiffness = "1e-7 s"\n'
    '[effects.contact_damping]\ncoefficient = "5e-2 N s/mm"\nfull_approach = "1 um"\n'
)
# A run that goes on from the file of any step has the same next step: nothing but the state makes bits, no cache.
EVERY = tuple(range(1, 20))
WEIGHT_AND_CAGE = (
    '[effects.gravity]\nacceleration = "9.81 m/s2"\ndirection = [0.0, -1.0, 0.0]\n'
    "[effects.cage_slip]\ninner = 0.02\nouter = 0.01\n[effects.ball_centrifugal]\n"
    "[effects.gyroscopic_moment]\ninner_share = 0.5\nouter_share = 1.5\n"
)
THROWN_OFF = ("effects.radial_force.value=20 kN", 'effects.radial_force.schedule.step.at="0.1 ms"')
NODE_PROBES = (
    '[probes.node.po]\nring = "outer"\nazimuth = "20 deg"\ngroove_angle = "15 deg"\n'
    '[probes.node.pi]\nring = "inner"\nazimuth = "20 deg"\nr = "27 mm"\nz = "2 mm"\naxes = "cartesian"\n'
    '[probes.contact.c]\nball = 1\nring = "inner"\n'
)
STRESS_PROBES = (
    '[probes.point.under]\nring = "outer"\nazimuth = "20 deg"\ngroove_angle = "19 deg"\ndepth = "0.1 mm"\n'
    '[probes.profile.line]\nring = "inner"\nazimuth = "20 deg"\ngroove_angle = ["-40 deg", "40 deg"]\n'
    'depth = "0 mm"\npoints = 41\n[stress]\nnear_field = true\n'
)

# Spall and waves of rings under contact damping: all that a contact of strips does.
SURFACES = (
    '[[profiles.spall]]\nring = "outer"\nazimuth = "3 deg"\ngroove_angle = "19 deg"\nlength = "1 mm"\nwidth = "2 mm"\n'
    'depth = "20 um"\nedge = "0.1 mm"\n'
    '[[profiles.random]]\nring = "inner"\norders = [2, 30]\namplitude = "0.5 um"\nslope = 1.0\nseed = 1\n'
)


def dynamic(more="", steps=20, step=20, every=5, speed="12000 rpm"):
    """The table of a motion of so many steps of so many microseconds, and that of the speed."""
    table = f'[dynamic]\nduration = "{steps * step} us"\nstep = "{step} us"\noutput_every = {every}\n'
    # Few sectors resolve rolling balls badly; the guard wants bits, not accuracy.
    return f'{table}ledger_tolerance = 1e-2\n{more}\n[speed]\ninner = {speed_value(speed)}\n'


def speed_value(speed):
    """A constant speed is a string, a course a table."""
    return speed if speed.startswith("{") else f'"{speed}"'


def impact(force, start, duration):
    """Replaces the radial force by a pulse."""
    pulse = f'schedule.impact = {{ start = "{start} us", duration = "{duration} us" }}'
    return (('value = "1 kN"', f'value = "{force}"\n{pulse}'),)


def motion(name, tables=None, *settings, **more):
    """A case of motion."""
    return Case(name, MOTION, tables or dynamic(), settings, **more)


INTEGRATORS = [
    motion("hht", dynamic('integrator = "hht"\nalpha = 0.1'), resume=(10,)),
    motion("chung_hulbert", dynamic('integrator = "chung_hulbert"\nrho = 0.8\n') + FRAME, resume=(10,)),
    motion("newmark", dynamic('integrator = "newmark"\nbeta = 0.3025\ngamma = 0.6')),
    motion("pointwise", dynamic('contact = "pointwise"')),
]
SUPPORTS = [
    motion("clamped", dynamic(every=1), meshes="coarse", resume=EVERY, threads=True),
    motion("mean_motion", dynamic(every=1), edits=MEAN, resume=EVERY, threads=True),
    motion("free_tilt", None, *FREE_TILT),
    motion("free_tilt_mean", dynamic() + FRAME, *FREE_TILT, edits=MEAN),
    motion("locked_shaft", None, "shaft.x=locked", "shaft.y=locked", "shaft.z=30 um"),
    motion(
        "driven_shaft",
        dynamic() + "[effects.ball_centrifugal]\n[effects.gyroscopic_moment]\n",
        MASS,
        'shaft.z={ value = "30 um", schedule.ramp = { from = 1, to = 2, start = "0 s", duration = "0.2 ms" } }',
    ),
    motion("inner_partly_held", dynamic() + FRAME, "inner.partial=true", meshes="inner_partly_held", resume=(10,)),
    motion("outer_partly_held", None, "outer.partial=true", meshes="outer_partly_held", threads=True),
]
RINGS = [
    motion("frame_rotation", dynamic() + FRAME + DAMPING, LOW_PRELOAD, resume=(10,), threads=True),
    motion("stress_stiffening", dynamic() + STIFFENED + DAMPING, edits=MEAN, resume=(10,), threads=True),
    motion("rayleigh_mean", dynamic() + FRAME + DAMPING, edits=MEAN),
    motion("keyway_frame", dynamic(every=1) + FRAME + KEYWAY, LOW_PRELOAD, resume=EVERY, threads=True),
    motion("keyway_mean", dynamic() + FRAME + DAMPING + KEYWAY, edits=MEAN),
    motion("moved_nodes", dynamic() + FRAME, meshes="moved_nodes", resume=(10,)),
    motion("hex20", dynamic(steps=10) + FRAME, meshes="fine"),
    motion("inner_rigid", None, "inner.flexible=false", MASS),
    motion("outer_rigid", dynamic() + FRAME, "outer.flexible=false"),
    motion("both_rigid", dynamic(steps=40), *RIGID, MASS, LOW_PRELOAD, resume=(20,)),
    motion("tet10", dynamic(steps=4, every=2), meshes="tet10"),
    motion("sparse", dynamic(every=1) + FRAME + DAMPING, "solver.backend=sparse", resume=EVERY, threads=True),
    motion("sparse_mean", dynamic() + FRAME, "solver.backend=sparse", edits=MEAN),
    motion("sparse_keyway", dynamic() + FRAME + KEYWAY, "solver.backend=sparse"),
    motion("sectors", None, "solver.backend=sector", "solver.sectors=5", resume=(10,), threads=True),
    # From 16 sectors on their cross-sections are eliminated by cyclic reduction.
    motion("many_sectors", dynamic() + FRAME, "solver.backend=sector", "solver.sectors=18", threads=True),
    motion("sectors_mean", dynamic() + FRAME + DAMPING, "solver.backend=sector", "solver.sectors=5", edits=MEAN),
]
COURSES = [
    motion("speed_ramp", dynamic(speed='{ times = ["0 s", "0.3 ms"], values = ["1800 rpm", "18000 rpm"] }') + FRAME),
    motion("gravity_cage", dynamic() + WEIGHT_AND_CAGE, "speed.ball_speeds=outer_control"),
    motion(
        "schedules",
        None,
        'effects.axial_force.schedule.harmonic={ frequency = "5 kHz", mean = 1, amplitude = 0.5 }',
        'effects.radial_force.schedule.table={ times = ["0 s", "0.2 ms"], factors = [1, 0.2] }',
    ),
    motion("surfaces", dynamic() + SURFACES + DAMPING, "contact.edges=true", resume=(10,), threads=True),
    motion("started_free", dynamic("start.free = {}", step=5), MASS),
    motion("started_given", dynamic('start.given = { z = "10 um", velocity_x = "1 mm/s" }', step=5), MASS),
    motion("broken_ledger", dynamic('contact = "pointwise"').replace("1e-2", "1e-14"), code=3),
    motion("off_groove", None, *FREE_TILT, *THROWN_OFF, code=3),
    motion("failed_step", dynamic("halvings = 1\nadaptive = { tolerance = 1e-9 }", step=50), code=3),
]
RUNGS = [
    motion("rungs_rigid", dynamic(ADAPTIVE, step=50, every=1), MASS, *RIGID, edits=impact("5 kN", 100, 100)),
    motion(
        "rungs_flexible",
        dynamic(ADAPTIVE, step=50, every=1),
        LOW_PRELOAD,
        edits=impact("5 kN", 200, 200),
        resume=(5, 11, 15),
    ),
    motion(
        "rungs_in_frame",
        dynamic(ADAPTIVE, step=50, steps=12) + FRAME + KEYWAY,
        LOW_PRELOAD,
        edits=impact("5 kN", 100, 100),
    ),
]
OUTPUTS = [
    motion("probes_near_field", dynamic() + NODE_PROBES + STRESS_PROBES, threads=True),
    motion("own_frame_points", dynamic(every=10)
           + '[output]\nstress = "integration_points"\ninner_ring = "own_frame"\nprecision = "f64"\n'),
    motion("compressed", dynamic(every=10) + "[output]\ncompression = 4\n"),
    motion("small_files", dynamic(every=2)
           + '[output]\ndisplacement = "f32"\nrestart_every = 3\nstress_error = "10 kPa"\n'),
    motion("fields_and_extremes", dynamic(every=2)
           + '[output]\nrestart_every = 3\n[output.every]\nstress = 2\n[output.region]\nraceway_distance = "1 mm"\n'
           + '[output.reduction]\n', threads=True),
]
CASES = SUPPORTS + RINGS + INTEGRATORS + COURSES + RUNGS + OUTPUTS
