"""Results of every kind of run on coarse meshes, made once by the program of this tree: seconds in all."""

from __future__ import annotations

import os
from collections.abc import Mapping
from pathlib import Path

import pytest

import raceway

ROOT = Path(__file__).resolve().parents[2]
SCENES = ROOT / "scenes"
SIDES = ("inner", "outer")
COARSE: dict[str, object] = {f"{side}.mesh": str(ROOT / f"meshes/7010c_{side}_coarse.msh") for side in SIDES}
# The scenes describe finer sections than those of the coarse meshes.
COARSE |= {"inner.section": None, "outer.section": None}


@pytest.fixture(scope="session", autouse=True)
def program() -> Path:
    """The program of this tree, unless RACEWAY names another."""
    os.environ.setdefault("RACEWAY", str(ROOT / "target/release/raceway"))
    return raceway.find_program()


class Runs:
    """Runs of shipped scenes with coarse meshes, each once."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder

    def of(self, name: str, scene: str, overrides: Mapping[str, object]) -> raceway.Results:
        out = self.folder / name
        if out.is_dir():
            return raceway.open(out)
        return raceway.run(SCENES / scene, out, {**COARSE, **overrides}, threads=1)

    def statics(self) -> raceway.Results:
        return self.of("statics", "7010c_radial_tilt_locked.toml", {"output.stress": "nodal"})

    def pair(self) -> raceway.Results:
        return self.of("pair", "7010c_spindle_pair.toml", {})

    def sweep(self) -> raceway.Results:
        return self.of("sweep", "7010c_preload_sweep.toml", {"sweep.values": ["1 kN", "2 kN", "5 kN"]})

    def quasi_static(self) -> raceway.Results:
        overrides = {"quasi_static.duration": "2 ms", "quasi_static.output_every": 5}
        return self.of("quasi_static", "7010c_1800rpm_quasi_static_coarse.toml", overrides)

    def motion(self) -> raceway.Results:
        probe = {"ring": "outer", "azimuth": "20 deg", "groove_angle": "19.5 deg"}
        overrides = {"dynamic.duration": "0.4 ms", "dynamic.output_every": 5, "probes.node.po2": probe}
        return self.of("motion", "7010c_1800rpm_coarse.toml", overrides)

    def small_motion(self) -> raceway.Results:
        """The same motion with all that makes its files smaller."""
        smaller = {"stress_error": "10 kPa", "displacement": "f32", "restart_every": 3}
        overrides = {"dynamic.duration": "0.4 ms", "dynamic.output_every": 5}
        return self.of(
            "small_motion",
            "7010c_1800rpm_coarse.toml",
            overrides | {f"output.{key}": value for key, value in smaller.items()},
        )

    def reduced_motion(self) -> raceway.Results:
        """The same motion with extremes of the run, and stress in every second file near the grooves."""
        overrides = {
            "dynamic.duration": "0.4 ms",
            "dynamic.output_every": 5,
            "output.every.stress": 2,
            "output.region.raceway_distance": "1 mm",
            "output.reduction.every": 5,
        }
        return self.of("reduced_motion", "7010c_1800rpm_coarse.toml", overrides)

    def modes(self) -> raceway.Results:
        return self.of("modes", "7010c_modes.toml", {"modes.number": 8, "modes.bodies": ["inner", "bearing"]})

    def integration_points(self) -> raceway.Results:
        overrides = {"output.stress": "integration_points"}
        return self.of("integration_points", "7010c_preload.toml", overrides)

    def by_command(self, name: str, *words: str) -> raceway.Results:
        """The results of a command that takes a scene and --out."""
        out = self.folder / name
        if not out.is_dir():
            settings = raceway.program.override_arguments(COARSE)
            raceway.command(words[0], SCENES / words[1], *words[2:], *settings, "--out", out)
        return raceway.open(out)

    def stiffness(self) -> raceway.Results:
        return self.by_command("stiffness", "stiffness", "7010c_preload.toml")

    def campbell(self) -> raceway.Results:
        changes = ["shaft.tilt_x=free", "shaft.tilt_y=free"]
        changes += ("shaft.mass=2 kg", "shaft.transverse_inertia=2e-3 kg m2", "shaft.polar_inertia=1e-3 kg m2")
        words = [word for change in changes for word in ("--set", change)]
        return self.by_command("campbell", "campbell", "7010c_preload.toml", "--speeds", "0..9000:3000", *words)

    def heat(self) -> raceway.Results:
        heat = {"torque": "0.05 N m", "speed": "3000 rpm", "ambient": "20 degC"}
        conductances = {"inner_ambient": "0.4 W/K", "outer_ambient": "2 W/K", "inner_outer": "0.8 W/K"}
        settings = {f"heat.{key}": value for key, value in heat.items()}
        settings |= {f"heat.conductance.{key}": value for key, value in conductances.items()}
        settings |= {f"materials.{part}.expansion": "11.5e-6 /K" for part in ("rings", "balls")}
        words = raceway.program.override_arguments(settings)
        return self.by_command("heat", "heat", "7010c_preload.toml", *words)

    def load_matrix(self) -> raceway.Results:
        place = {"ring": "outer", "surface": "seat", "z": "2 mm", "direction": "hoop"}
        place |= {"length": "3 mm", "width": "1 mm"}
        settings: dict[str, object] = {
            f"probes.gauge.g{ball:02}.{key}": value
            for ball in range(18)
            for key, value in (place | {"azimuth": f"{20 * ball} deg"}).items()
        }
        settings["outer.support"] = "mean_motion"
        words = raceway.program.override_arguments(settings)
        return self.by_command("load_matrix", "load-matrix", "7010c_preload.toml", *words)


@pytest.fixture(scope="session")
def runs(tmp_path_factory: pytest.TempPathFactory) -> Runs:
    return Runs(tmp_path_factory.mktemp("runs"))
