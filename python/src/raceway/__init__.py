"""Runs raceway, a solver of ball bearings with finite-element rings, and reads its results.

    import raceway

    results = raceway.run("scenes/7010c_preload.toml", "preload", {"effects.axial_force.value": "3 kN"})
    results.balls                          # a pandas table
    results.step(-1)["von_mises"]          # a numpy array, Pa
    results.step(-1).to_pyvista()          # with pip install 'raceway[meshes]'
    raceway.figures.round_the_bearing(results).show()   # with pip install 'raceway[figures]'

All numbers are SI, and z is the axis of the bearing. Names of files and columns are those of docs/results.md.
"""

from . import figures
from .errors import (
    InputError,
    MissingPackage,
    NoSolution,
    ProgramError,
    ProgramMissing,
    RacewayError,
    ResultsError,
    StoppedEarly,
)
from .meshes import Mesh
from .program import Progress, command, find_program, resume, run, study
from .results import Results, open_results
from .steps import STRESS_COMPONENTS, Step
from .studies import Study, open_study

#: Opens a result folder.
open = open_results

__all__ = [
    "STRESS_COMPONENTS",
    "InputError",
    "Mesh",
    "MissingPackage",
    "NoSolution",
    "ProgramError",
    "ProgramMissing",
    "Progress",
    "RacewayError",
    "Results",
    "ResultsError",
    "Step",
    "StoppedEarly",
    "Study",
    "command",
    "figures",
    "find_program",
    "open",
    "open_results",
    "open_study",
    "resume",
    "run",
    "study",
]
