"""Tables, summary, fields and meshes of every kind of run."""

from __future__ import annotations

import shutil
from pathlib import Path

import h5py
import numpy as np
import pytest

import raceway


def test_forces_of_the_balls_balance_the_loads(runs):
    # 2 kN along z and 1 kN along x. Contact angles turn with the deformed rings by less than 1e-3 rad.
    balls = runs.statics().balls
    force, angle, azimuth = (balls[name] for name in ("inner_force_n", "inner_contact_angle_rad", "azimuth_rad"))
    assert len(balls) == 18
    assert np.isclose((force * np.sin(angle)).sum(), 2000.0, rtol=2e-3)
    assert np.isclose((force * np.cos(angle) * np.cos(azimuth)).sum(), 1000.0, rtol=2e-3)


def test_numbers_are_read_to_the_last_bit(runs):
    results = runs.statics()
    line = (results.folder / "balls.csv").read_text().splitlines()[1].split(",")
    row = results.balls.iloc[0]
    assert [float(cell) for cell in line] == [float(number) for number in row]
    assert row["inner_force_n"] == results.summary["balls"][0]["inner"]["force_n"]


def test_von_mises_follows_from_the_stress(runs):
    step = runs.statics().step(-1)
    xx, yy, zz, xy, yz, xz = step["stress"].astype(float).T
    ring = step.mesh.point_body < 2
    own = np.sqrt(0.5 * ((xx - yy) ** 2 + (yy - zz) ** 2 + (zz - xx) ** 2) + 3 * (xy**2 + yz**2 + xz**2))
    # Both are rounded to single precision.
    assert np.allclose(own[ring], step["von_mises"][ring], rtol=1e-5, atol=1.0)
    assert step["von_mises"].max() > 1e6


def test_forces_on_the_balls_are_those_of_the_table(runs):
    results = runs.statics()
    step, balls = results.step(-1), results.balls
    points = step.mesh.points_of("balls")
    force = np.linalg.norm(step["force_inner"][points], axis=1)
    assert np.allclose(force, balls["inner_force_n"], rtol=1e-12)
    assert not step["force_inner"][step.mesh.point_body < 2].any()


def test_a_ring_has_the_volume_of_its_surface(runs):
    # The theorem of Gauss over the triangles against the sum of the hexahedra, cut into tetrahedra.
    mesh = runs.statics().mesh
    for ring, largest in [("inner", 0.0302), ("outer", 0.0401)]:
        a, b, c = (mesh.points[mesh.surface(ring)][:, corner] for corner in range(3))
        by_surface = np.einsum("ij,ij->i", a, np.cross(b, c)).sum() / 6.0
        pyvista = pytest.importorskip("pyvista")
        grid = runs.statics().step(-1).to_pyvista()
        cells = grid.extract_cells(mesh.cells_of(ring))
        assert isinstance(grid, pyvista.UnstructuredGrid)
        assert np.isclose(abs(by_surface), cells.volume, rtol=1e-3)
        radius = np.hypot(*mesh.points[mesh.points_of(ring)][:, :2].T)
        assert radius.max() < largest + 1e-4


def test_small_files_are_read_by_h5py_alone(runs):
    whole, small = runs.motion(), runs.small_motion()
    assert small.steps == whole.steps
    for number in small.steps:
        with (
            h5py.File(whole.folder / f"step_{number:06}.hdf") as exact,
            h5py.File(small.folder / f"step_{number:06}.hdf") as file,
        ):
            exact_points, points = exact["VTKHDF/PointData"], file["VTKHDF/PointData"]
            assert set(points) == set(exact_points)
            for name in ("stress", "von_mises"):
                assert points[name].attrs["error_bound"] == 1e4
                # Both are rounded to single precision besides.
                error = np.abs(points[name][()].astype(float) - exact_points[name][()]).max()
                assert 0.0 < error <= 1.001e4
            assert points["displacement"].dtype == np.float32
            assert (points["displacement"][()] == exact_points["displacement"][()].astype(np.float32)).all()
            assert (points["force_inner"][()] == exact_points["force_inner"][()]).all()
            has_state = number == small.steps[-1] or number % 15 == 0
            assert (len(file["restart/state"]) > 0) == has_state
            assert len(exact["restart/state"]) > 0


def test_extremes_of_a_run_are_those_of_its_steps(runs):
    whole, reduced = runs.motion(), runs.reduced_motion()
    stress = np.stack([step["von_mises"] for step in whole])
    found = reduced.reduction
    # Both are rounded to single precision, in frames that differ by the turn of the ring.
    assert np.allclose(found["von_mises_maximum"], stress.max(axis=0), rtol=1e-6, atol=1.0)
    assert np.allclose(found["von_mises_minimum"], stress.min(axis=0), rtol=1e-6, atol=1.0)
    assert found["stress_range"].shape == (reduced.mesh.points.shape[0], 6)
    step = reduced.step(10)
    inside = step["in_region"] == 1.0
    assert 0 < inside.sum() < inside.size
    assert np.array_equal(step["von_mises"][inside], whole.step(10)["von_mises"][inside])
    assert np.isnan(step["von_mises"][~inside]).all()
    # Wrong: which points are kept would be a stress.
    assert reduced.dataset(["in_region"], steps=[10])["in_region"].attrs["units"] == "1"
    with pytest.raises(KeyError, match='step 5 has no field "von_mises" over points; fields are displacement'):
        reduced.step(5)["von_mises"]
    expected = r"has no reduction.vtkhdf; a scene with \[output.reduction\] gives it"
    with pytest.raises(raceway.ResultsError, match=expected):
        _ = whole.reduction


def test_a_sweep_has_its_values(runs):
    results = runs.sweep()
    assert results.steps == [0, 1, 2]
    data = results.balls_dataset()
    assert data["inner_force_n"].dims == ("step", "ball") and data["inner_force_n"].shape == (3, 18)
    values = data["effects.axial_force.value_n"]
    assert values.dims == ("step",) and list(values) == [1000.0, 2000.0, 5000.0]
    assert (np.diff(data["inner_force_n"].mean("ball")) > 0).all()


@pytest.mark.parametrize("kind", ["quasi_static", "motion"])
def test_runs_in_time_have_times(runs, kind):
    results = getattr(runs, kind)()
    assert results.summary["analysis"] == kind or results.summary["analysis"] == "dynamic"
    assert len(results.steps) >= 2
    assert [step.time for step in results] == sorted(step.time for step in results)
    last = results.shaft.iloc[-1]
    assert results.step(-1).time == last["time_s"] and results.step(-1).number == last["step"]
    assert "po2" in " ".join(results.table("probes").columns)


def test_a_dataset_has_the_fields_of_the_steps(runs):
    results = runs.motion()
    data = results.dataset(["displacement", "von_mises"], steps=results.steps[:2])
    assert data["displacement"].dims == ("step", "point", "vector")
    assert data["von_mises"].dims == ("step", "point") and data["von_mises"].attrs == {"units": "Pa"}
    second = data.sel(step=results.steps[1])
    assert np.array_equal(second["displacement"], results.step(results.steps[1])["displacement"])
    assert "tensor" not in data.coords and float(data["time"][1]) == results.step(results.steps[1]).time


def test_packed_steps_are_read_as_those_of_their_own(runs, tmp_path):
    own = runs.motion()
    folder = tmp_path / "packed"
    shutil.copytree(own.folder, folder)
    raceway.command("pack", folder)
    packed = raceway.open(folder)
    assert list(folder.glob("pack_*.hdf")) and len(list(folder.glob("step_*.hdf"))) < len(own.steps)
    assert packed.steps == own.steps
    for number in own.steps:
        for name in own.step(number):
            assert np.array_equal(own.step(number)[name], packed.step(number)[name]), (number, name)
    assert packed.step(0).scene == own.step(0).scene and packed.step(0).time == own.step(0).time


def test_modes_have_frequencies_and_shapes_of_one_millimetre(runs):
    results = runs.modes()
    table = results.table("modes")
    assert set(table["body"]) == {"inner", "bearing"}
    elastic = table[(table["body"] == "inner") & (table["rigid"] == 0)]
    assert elastic["frequency_hz"].min() > 1000.0
    shape = results.step(int(elastic["step"].iloc[0]))["displacement"]
    assert np.isclose(np.linalg.norm(shape, axis=1).max(), 1e-3, rtol=1e-6)


def test_stiffness_is_a_matrix_that_is_the_slope_of_the_load(runs):
    results = runs.stiffness()
    matrix = results.stiffness["stiffness"]
    assert matrix.shape == (5, 5) and results.stiffness["order"][2] == "z"
    # Patches of flexible rings go along with their contacts and have no energy of their own: docs/stiffness.md.
    assert np.allclose(matrix, matrix.T, rtol=2e-3, atol=1e-6 * abs(matrix).max())
    # An independent way: half the difference of the loads of two equilibria over that of the displacements.
    loads = (1990.0, 2010.0)
    places = []
    for load in loads:
        near = runs.of(f"near_{load:g}", "7010c_preload.toml", {"effects.axial_force.value": f"{load} N"})
        places.append(near.summary["shaft"]["displacement_m"][2])
    slope = (loads[1] - loads[0]) / (places[1] - places[0])
    assert np.isclose(matrix[2, 2], slope, rtol=1e-4)


def test_a_campbell_folder_opens(runs):
    results = runs.campbell()
    assert sorted(results.table("campbell")["speed_rpm"].unique()) == [0.0, 3000.0, 6000.0, 9000.0]
    assert results.steps == []


def test_a_heat_balance_opens_and_balances(runs):
    results = runs.heat()
    assert [path.name for path in results.folder.iterdir()] == ["heat.json"]
    heat = results.heat
    # The power of a torque of 0.05 N m at 3000 rpm is what flows off, by the conductances of the two rings.
    power = 0.05 * 3000.0 * np.pi / 30.0
    inner, outer = heat["temperatures_k"][:2]
    assert heat["end"] == "steady" and np.isclose(heat["given_off_w"], power, rtol=1e-9)
    assert np.isclose(0.4 * (inner - 293.15) + 2.0 * (outer - 293.15), power, rtol=1e-9)
    assert results.steps == [] and results.tables == [] and "no summary" in repr(results)


def test_a_load_matrix_is_an_array_of_gauges_and_balls(runs):
    results = runs.load_matrix()
    found, table = results.load_matrix, results.table("load_matrix")
    matrix = found["strain_per_n"]
    assert matrix.shape == (18, 18) and found["condition"] > 1.0
    assert np.array_equal(matrix, table.iloc[:, 2:].to_numpy()) and list(table["gauge"]) == found["gauges"]
    # A gauge beside each ball of a ring that is the same every 20 deg: each row is the one before, shifted.
    shifted = np.stack([np.roll(row, -i) for i, row in enumerate(matrix)])
    assert np.allclose(shifted, shifted[0], rtol=0, atol=1e-6 * abs(matrix).max())


def test_life_is_read_from_its_file_and_from_the_summary(runs, tmp_path):
    settings = {"life.contact_angle": "15 deg", "life.speed": "1800 rpm"}
    results = runs.of("life", "7010c_preload.toml", settings)
    by_summary = results.life["l10r_revolutions"]
    raceway.command("life", results.folder)
    again = raceway.open(results.folder)
    assert again.has("life.json") and again.life["l10r_revolutions"] == by_summary > 1e8


def test_stress_at_integration_points_is_a_field_of_cells(runs):
    step = runs.integration_points().step(-1)
    assert "stress" not in step and "stress_integration_points" in step.cell_fields
    values = step.cells("stress_integration_points")
    assert values.shape[0] == step.mesh.n_cells and values.shape[1] % 6 == 0
    assert "stress_integration_points" in step.to_pyvista().cell_data


def test_the_scene_of_a_run_runs_again_to_the_same_bits(runs, tmp_path):
    results = runs.statics()
    scene = tmp_path / "again.toml"
    scene.write_text(results.scene)
    again = raceway.run(scene, tmp_path / "out", threads=2)
    assert np.array_equal(again.balls["inner_force_n"], results.balls["inner_force_n"])


def test_wrong_folders_and_names_are_refused_with_what_was_expected(runs, tmp_path):
    results = runs.statics()
    cases = [
        (lambda: raceway.open(tmp_path / "no"), "is no folder; expected the results of a run"),
        (lambda: raceway.open(tmp_path), "holds no results; expected summary.json, tables or steps"),
        (lambda: results.table("cheese"), 'has no table "cheese"; tables are balls, energy, shaft'),
        (lambda: results.step(7), "has no step 7; steps are 0 to 0"),
        (lambda: results.stiffness, "has no stiffness.json; raceway stiffness writes it"),
        (lambda: results.life, "has no life; a scene with [life] or raceway life DIR gives it"),
        (lambda: raceway.open_study(tmp_path), "has no study.csv; expected the folder of a study"),
        (lambda: results.heat, "has no heat.json; raceway heat SCENE --out DIR writes it"),
        (lambda: results.load_matrix, "has no load_matrix.json; raceway load-matrix writes it"),
        (lambda: runs.campbell().summary, "has no summary.json; a run that has ended has it"),
        (lambda: runs.campbell().scene, "has no steps, which hold the scene"),
    ]
    for call, text in cases:
        with pytest.raises(raceway.ResultsError) as caught:
            call()
        assert text in str(caught.value)
    with pytest.raises(KeyError, match='step 0 has no field "cheese" over points; fields are displacement'):
        results.step(0)["cheese"]
    with pytest.raises(ValueError, match='no body "cheese"; bodies are inner, outer, balls'):
        results.mesh.points_of("cheese")


def test_damaged_files_and_those_of_another_run_are_refused(runs, tmp_path):
    folder = tmp_path / "copy"
    shutil.copytree(runs.statics().folder, folder)
    shutil.copy(runs.sweep().folder / "step_000000.hdf", folder / "step_000001.hdf")
    with pytest.raises(raceway.ResultsError, match="is of another run than mesh.hdf beside it"):
        raceway.open(folder).step(1)
    own = (folder / "summary.json").read_text()
    (folder / "summary.json").write_text(own.replace('"schema": 1', '"schema": 7', 1))
    with pytest.raises(raceway.ResultsError, match="summary.json has schema 7; this package reads schema 1"):
        _ = raceway.open(folder).summary
    (folder / "summary.json").write_text('{"scene": ')
    with pytest.raises(raceway.ResultsError, match="summary.json is damaged"):
        _ = raceway.open(folder).summary
    (folder / "mesh.hdf").write_bytes(b"cheese")
    with pytest.raises(raceway.ResultsError, match="mesh.hdf is damaged or no HDF5 file"):
        raceway.open(folder).step(0)
    (folder / "balls.csv").write_text("a,b\n1,2\n3,4,5,6\n")
    with pytest.raises(raceway.ResultsError, match="balls.csv is damaged"):
        _ = raceway.open(folder).balls


def test_results_say_what_they_are(runs):
    assert repr(runs.statics()).startswith(f"<raceway.Results {runs.folder / 'statics'}: static, 1 step, tables balls")
    assert "fields displacement, force_inner, force_outer" in repr(runs.statics().step(0))
    assert isinstance(runs.statics().folder, Path)


def test_bearings_of_a_list_are_opened_by_name(runs):
    """Wrong: the scene of a list would be said to be lost, and nothing would tell where its fields are."""
    results = runs.pair()
    assert results.bearings == ["front", "rear"]
    assert "[[bearing]]" in results.scene
    assert results.bearing("rear").folder == results.folder / "rear"
    assert results.bearing("rear").bearings == []
    for ask in (lambda: results.step(-1), lambda: results.mesh, lambda: results.reduction, results.dataset):
        with pytest.raises(raceway.ResultsError, match=r"bearing\(name\) opens it: front, rear"):
            ask()
    with pytest.raises(raceway.ResultsError, match="bearings are front, rear"):
        results.bearing("left")
    with pytest.raises(raceway.ResultsError, match="it holds one bearing"):
        results.bearing("rear").bearing("rear")
