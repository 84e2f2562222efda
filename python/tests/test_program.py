"""The program as Python starts it: overrides, progress, errors, interrupts, studies."""

from __future__ import annotations

import math
import os
import signal
import subprocess
import sys
import time

import numpy as np
import pytest
from conftest import COARSE, ROOT, SCENES

import raceway
from raceway.program import override_arguments

RIGID = {"contact.mode": "rigid", "inner.flexible": False, "outer.flexible": False}


def test_overrides_become_words_of_the_command_line():
    changes = {
        "a": "3 kN",
        "b": True,
        "c": 2,
        "d": 0.25,
        "e": ["0 mm", "1 mm"],
        "f": {"start": "0 ms"},
        "g": None,
        "h": np.float64(1.5),
        "j": np.arange(2),
        "i": 'a "word"',
    }
    words = override_arguments(changes)
    assert words[::2] == ["--set"] * len(changes)
    assert words[1::2] == [
        'a="3 kN"',
        "b=true",
        "c=2",
        "d=0.25",
        'e=["0 mm", "1 mm"]',
        'f={ start = "0 ms" }',
        "g=none",
        "h=1.5",
        "j=[0, 1]",
        'i="a \\"word\\""',
    ]
    assert override_arguments(["a=1", "b=2"]) == ["--set", "a=1", "--set", "b=2"]
    assert override_arguments(None) == []
    with pytest.raises(ValueError, match="nan is no value of a scene"):
        override_arguments({"a": math.nan})
    with pytest.raises(TypeError, match="expected a dictionary or a list of texts"):
        override_arguments("a=1")
    with pytest.raises(TypeError, match="is no value of a scene; expected a text, number"):
        override_arguments({"a": object()})


def test_overrides_change_the_run(tmp_path):
    changes = {**RIGID, "effects.axial_force.value": "3 kN", "effects.radial_force": None}
    results = raceway.run(SCENES / "7010c_radial_tilt_locked.toml", tmp_path / "out", changes)
    forces = results.balls["inner_force_n"]
    assert np.ptp(forces) < 1e-6 * forces.mean()
    assert np.isclose((forces * np.sin(results.balls["inner_contact_angle_rad"])).sum(), 3000.0, rtol=1e-9)


def test_without_a_folder_the_results_are_found(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    results = raceway.run(SCENES / "7010c_preload.toml", overrides=RIGID)
    assert results.folder.resolve() == (tmp_path / "results/7010c_preload").resolve()


def test_progress_tells_steps_and_ends_with_the_last(tmp_path):
    signs: list[raceway.Progress] = []
    changes = {**COARSE, "sweep.values": ["1 kN", "2 kN"]}
    raceway.run(SCENES / "7010c_preload_sweep.toml", tmp_path / "out", changes, progress=signs.append)
    steps = [sign for sign in signs if not sign.warning]
    assert {sign.total for sign in steps} == {2} and len(steps) >= 2
    assert [sign.done for sign in steps] == sorted(sign.done for sign in steps)
    assert all(sign.text and sign.seconds >= 0.0 for sign in steps)
    # Wrong: a bar would stop before its end though all points are solved.
    assert steps[-1].done == 2


def test_warnings_come_with_the_progress(tmp_path):
    signs: list[raceway.Progress] = []
    changes = {**RIGID, "effects.axial_force.value": "90 kN"}
    raceway.run(SCENES / "7010c_preload.toml", tmp_path / "out", changes, progress=signs.append)
    warnings = [sign.warning for sign in signs if sign.warning]
    summary = raceway.open(tmp_path / "out").summary
    assert summary["warnings"] and set(warnings) >= {*summary["warnings"], *summary["advice"]}


def test_printed_progress_goes_to_the_error_stream(tmp_path, capsys):
    raceway.run(SCENES / "7010c_preload.toml", tmp_path / "out", {**COARSE}, progress=True)
    printed = capsys.readouterr()
    assert printed.out == "" and printed.err.startswith("0/1 ")


def test_errors_have_the_words_of_the_program(tmp_path):
    with pytest.raises(raceway.InputError) as caught:
        raceway.run(SCENES / "7010c_preload.toml", tmp_path / "out", {"bearing.balls": -1})
    words = ["run", SCENES / "7010c_preload.toml", "--out", tmp_path / "out", "--set", "bearing.balls=-1"]
    direct = subprocess.run([raceway.find_program(), *words], capture_output=True, text=True)
    assert "error: " + str(caught.value) == direct.stderr.strip() and "balls" in direct.stderr
    assert caught.value.code == 2 == direct.returncode
    with pytest.raises(raceway.NoSolution) as caught:
        changes = {**COARSE, "solver.max_iterations": 1}
        raceway.run(SCENES / "7010c_radial_tilt_locked.toml", tmp_path / "none", changes)
    assert caught.value.code == 3 and "contact places do not settle after 1 rounds" in str(caught.value)
    with pytest.raises(raceway.InputError, match="unrecognized subcommand 'cheese'"):
        raceway.command("cheese")


def test_a_run_that_stops_early_goes_on_to_the_same_bits(tmp_path):
    changes = {**COARSE, "dynamic.duration": "1 ms", "dynamic.output_every": 50, "output.stress": "none"}
    scene = SCENES / "7010c_1800rpm_coarse.toml"
    whole = raceway.run(scene, tmp_path / "whole", changes)
    words = ["run", scene, "--out", tmp_path / "cut", *override_arguments(changes)]
    with pytest.raises(raceway.StoppedEarly) as caught:
        raceway.command(*words, "--wall-time", "00:00:00")
    assert caught.value.code == 75
    resumed = raceway.resume(tmp_path / "cut")
    for column in ("x_m", "z_m"):
        assert np.array_equal(resumed.shaft[column], whole.shaft[column])


def test_an_interrupt_saves_the_step_of_a_motion(tmp_path):
    out = tmp_path / "out"
    changes = {**COARSE, "dynamic.duration": "1 s", "dynamic.output_every": 20}
    code = f"import raceway; raceway.run({str(SCENES / '7010c_1800rpm_coarse.toml')!r}, {str(out)!r}, {changes!r})"
    python = subprocess.Popen([sys.executable, "-c", code], stderr=subprocess.PIPE, text=True)
    deadline = time.monotonic() + 60.0
    while not list(out.glob("step_*.hdf")):
        assert time.monotonic() < deadline and python.poll() is None
        time.sleep(0.05)
    python.send_signal(signal.SIGINT)
    _, said = python.communicate(timeout=60)
    assert "KeyboardInterrupt" in said
    results = raceway.open(out)
    assert 0 < results.step(-1).number < 50_000
    assert "stopped" in results.summary["status"]


def test_a_missing_program_is_named(monkeypatch, tmp_path):
    with pytest.raises(raceway.ProgramMissing, match="cheese is no program that can be started"):
        raceway.find_program("cheese")
    monkeypatch.delenv("RACEWAY")
    monkeypatch.setenv("PATH", str(tmp_path))
    with pytest.raises(raceway.ProgramMissing, match="the program raceway is not on the PATH; install it"):
        raceway.find_program()


def test_a_study_runs_with_progress_and_has_a_table(tmp_path):
    # As tests/study.rs has it: the scene of all tests in motion.
    scene = (ROOT / "tests/fixtures/7010c.toml").read_text()
    motion = '[dynamic]\nduration = "0.2 ms"\nstep = "4 us"\noutput_every = 1000'
    (tmp_path / "scene.toml").write_text(scene.replace("[static]", motion))
    (tmp_path / "study.toml").write_text((ROOT / "tests/fixtures/study.toml").read_text())
    signs: list[raceway.Progress] = []
    study = raceway.study(tmp_path / "study.toml", tmp_path / "out", jobs=2, progress=signs.append)
    assert len(study.table) == 7 and "step" in study.table.columns
    assert {sign.total for sign in signs} == {7} and [sign.done for sign in signs] == list(range(7))
    assert len(study.results(0).shaft) > 10 and study.report["title"] == "rigid rings under a pulse"
    with pytest.raises(raceway.ResultsError, match="has no results of point 99"):
        study.results(99)


def test_the_version_is_that_of_the_program():
    from importlib.metadata import version

    assert raceway.command("--version").strip() == f"raceway {version('raceway')}"
    assert os.path.isfile(raceway.find_program())
