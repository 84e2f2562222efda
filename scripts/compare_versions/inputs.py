"""Scenes that must be refused: both versions say the same, with the same exit code, and write nothing."""

from dataclasses import dataclass

from . import outputs, rules, scene
from .difference import Difference
from .motions import KEYWAY, RIGID, dynamic
from .runs import both

NAME = "bad_scenes"
USER_ERROR = 2


@dataclass(frozen=True)
class Bad:
    """A line of the base scene and what stands for it, with an analysis and --set arguments."""

    line: str = ""
    replacement: str = ""
    tables: str = "[static]"
    settings: tuple = ()


LINES = [
    ('ball_diameter = "9 mm"', 'ball_diametr = "9 mm"'),
    ('ball_diameter = "9 mm"', 'ball_diameter = "-9 mm"'),
    ('ball_diameter = "9 mm"', 'ball_diameter = "9 km"'),
    ("balls = 18", "balls = 2"),
    ("balls = 18", "balls = 30"),
    ("balls = 18", "balls = 18.5"),
    ('width = "16 mm"', 'width = "16 N"'),
    ('width = "16 mm"', 'width = "16 mn"'),
    ('width = "16 mm"', "width = 16"),
    ('width = "16 mm"', 'width = "nan mm"'),
    ('width = "16 mm"', 'width = "8 mm"'),
    ('bore_diameter = "50 mm"\n', ""),
    ('outer_raceway_diameter = "74.037 mm"', 'outer_raceway_diameter = "75 mm"'),
    ('inner_groove_radius = "4.65 mm"', 'inner_groove_radius = "4.5 mm"'),
    ("poisson_ratio = 0.3", "poisson_ratio = 0.5"),
    ('young_modulus = "207 GPa"', 'young_modulus = "207 Pa"'),
    ('density = "7800 kg/m3"', 'density = "7.8 mg/m3"'),
    ('mode = "patch"', 'mode = "pach"'),
    ('mode = "patch"', 'mode = "rigid"'),
    ('mesh = "inner.msh"', 'mesh = "iner.msh"'),
    ('mesh = "inner.msh"', 'mesh = "outer.msh"'),
    ('mesh_unit = "mm"\n', ""),
    ('mesh_unit = "mm"', 'mesh_unit = "m"'),
    ('support = "clamped"', 'support = "glued"'),
    ('z = "free"', 'z = "12 mm"'),
    ('tilt_x = "locked"', 'tilt_x = "loose"'),
    ('tilt_x = "locked"', 'tilt_x = "5 deg"'),
    ("[effects.radial_force]", "[effects.radial_fource]"),
    ('value = "2 kN"', 'value = "2 TN"'),
    ('value = "1 kN"', 'value = "1 kN"\nschedule.step = { at = "1 ms" }'),
    ("[static]", ""),
    ("[static]", "[static"),
]
TABLES = [
    "[static]\n[sweep]\nkey = \"effects.axial_force.value\"\nvalues = [\"1 kN\"]",
    '[sweep]\nkey = "bearing.ball_diameter"\nvalues = ["9 mm", "9.1 mm", "-9 mm"]',
    '[sweep]\nkey = "materials.rings.young_modulus"\nvalues = ["200 GPa", "210 GPa"]',
    '[sweep]\nkey = "effects.radial_force.value"\nvalues = []',
    '[[inner.cut]]\nazimuth = ["96 deg", "84 deg"]\n[static]',
    '[[inner.cut]]\nazimuth = ["0 deg", "20 deg"]\nradius = ["45 mm", "46 mm"]\n[static]',
    "[effects.ball_centrifugal]\n[static]",
    '[effects.rayleigh_damping]\nmass = "10 1/s"\nstiffness = "1e-7 s"\n[static]',
    "[modes]\nnumber = 0",
    '[modes]\nnumber = 3\nsupport = "free"',
    '[modes]\nnumber = 3\n[speed]\ninner = "1800 rpm"',
    '[quasi_static]\nduration = "1.05 ms"\nstep = "0.1 ms"',
    '[probes.node.p]\nring = "outer"\nazimuth = "0 deg"\n[static]',
    '[probes.point.p]\nring = "outer"\nazimuth = "0 deg"\ngroove_angle = "80 deg"\n[static]',
    dynamic("halvings = 17"),
    dynamic('integrator = "hht"'),
    dynamic('integrator = "hht"\nalpha = 0.5'),
    dynamic('integrator = "newmark"\nrho = 0.5'),
    dynamic('start.given = { tilt_x = "1 mrad" }'),
    dynamic('start = { free = {}, given = { z = "1 um" } }'),
    dynamic("adaptive = { tolerance = 0.0 }"),
    dynamic().replace('"400 us"', '"403 us"'),
    dynamic(speed="fast"),
    dynamic(speed='{ times = ["0 s", "0 s"], values = ["1 rpm", "2 rpm"] }'),
    dynamic() + "[effects.frame_rotation]\nkey = 1\n",
    dynamic() + "[effects.cage_slip]\ninner = 1.0\nouter = 0.0\n",
    dynamic() + '[effects.contact_damping]\ncoefficient = "-1 N s/mm"\nfull_approach = "1 um"\n',
    dynamic() + '[output]\ninner_ring = "moon"\n',
]
SETTINGS = [
    (dynamic(), ("contact.mode=facet",)),
    ("[static]", ("solver.sectors=4",)),
    ("[static]", ("solver.backend=sector", "solver.sectors=4000")),
    ("[static]", ("solver.tolerance=1",)),
    ("[static]", ("effects.axial_force.value=0 N", "effects.radial_force.value=0 N")),
    ("[static]", ("inner.flexible",)),
    ("[static]", ("innner.flexible=false",)),
    (dynamic() + "[effects.frame_rotation]\n", RIGID),
    (KEYWAY + "[static]", RIGID[:2]),
]
CORPUS = (
    [Bad(line, replacement) for line, replacement in LINES]
    + [Bad(tables=tables) for tables in TABLES]
    + [Bad(tables=tables, settings=settings) for tables, settings in SETTINGS]
)


def compare(setting):
    """The verdict on all inputs together."""
    differences, accepted = [], []
    for number, bad in enumerate(CORPUS):
        edits = ((bad.line, bad.replacement),) if bad.line else ()
        case = scene.Case(f"{NAME}/{number}", scene.STATIC, bad.tables, bad.settings, edits=edits)
        for folder in setting.pair(case.name):
            scene.write(case, folder)
        old, new = both(setting, case, ["run", "scene.toml", "--out", "out", *case.arguments()])
        place = f"bad scene {number} ({bad.replacement or ' '.join(bad.settings) or bad.tables.splitlines()[-1]})"
        if old.returncode != USER_ERROR:
            accepted.append(f"{place}: the old version ends with {old.returncode}")
        differences += outputs.compare_prints(place, old, new)
        left = [(folder / "out").exists() for folder in setting.pair(case.name)]
        if left[0] != left[1]:
            differences.append(Difference(place, text="only one version makes a folder"))
    if accepted:
        return rules.Verdict(NAME, rules.MISSING, "; ".join(accepted), differences)
    word = rules.DIFFERS if differences else rules.SAME
    return rules.Verdict(NAME, word, f"{len(CORPUS)} inputs", differences)
