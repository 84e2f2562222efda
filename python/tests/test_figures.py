"""Figures show the numbers of the results, in the units that their axes state."""

from __future__ import annotations

import numpy as np
import pytest

import raceway

pytest.importorskip("plotly")


def test_a_figure_round_the_bearing_has_every_ball(runs):
    results = runs.statics()
    figure = raceway.figures.round_the_bearing(results)
    assert [trace.name for trace in figure.data] == ["inner", "outer"]
    order = np.argsort(np.degrees(results.balls["azimuth_rad"]) % 360.0)
    assert np.array_equal(figure.data[0].y, results.balls["inner_force_n"].to_numpy()[order])
    assert figure.layout.yaxis.title.text == "force, N"
    angles = raceway.figures.round_the_bearing(results, "contact_angle_rad")
    assert np.allclose(np.sort(angles.data[1].y), np.sort(np.degrees(results.balls["outer_contact_angle_rad"])))


def test_bearings_of_a_list_have_lines_of_their_own(runs):
    results = runs.pair()
    figure = raceway.figures.round_the_bearing(results)
    assert [trace.name for trace in figure.data] == ["front inner", "front outer", "rear inner", "rear outer"]
    own = results.balls[results.balls["bearing"] == "rear"]
    assert sorted(figure.data[2].y) == sorted(own["inner_force_n"])
    lines = raceway.figures.history(results, ["x_m"]).data
    assert len(lines) == results.shaft["position_m"].nunique() and all(len(line.x) == 1 for line in lines)
    with pytest.raises(raceway.ResultsError, match="several bearings: front, rear; take bearing"):
        results.balls_dataset()


def test_a_sweep_is_drawn_against_its_value(runs):
    figure = raceway.figures.history(runs.sweep(), ["inner_force_n"], "balls", ball=3)
    assert list(figure.data[0].x) == [1000.0, 2000.0, 5000.0]
    assert "axial force" in figure.layout.xaxis.title.text and figure.layout.xaxis.title.text.endswith(", N")


def test_a_motion_is_drawn_over_time(runs):
    results = runs.motion()
    figure = raceway.figures.history(results, ["x_m", "z_m"])
    assert np.array_equal(figure.data[1].y, 1e6 * results.shaft["z_m"]) and figure.layout.yaxis.title.text == "µm"
    assert {trace.name for trace in raceway.figures.energy(results).data} >= {"total", "defect", "kinetic balls"}


def test_modes_and_critical_speeds_are_drawn(runs):
    figure = raceway.figures.modes(runs.modes())
    assert [trace.name for trace in figure.data] == ["inner", "bearing"]
    names = {trace.name for trace in raceway.figures.campbell(runs.campbell()).data}
    assert "forward" in names and "backward" in names and "shaft" in names


def test_rings_are_drawn_with_their_stress(runs):
    results = runs.statics()
    figure = raceway.figures.rings(results, scale=100.0)
    step = results.step(-1)
    highest = max(float(np.max(trace.intensity)) for trace in figure.data)
    surface = np.unique(np.concatenate([step.mesh.surface(side) for side in ("inner", "outer")]))
    assert np.isclose(highest, 1e-6 * step["von_mises"][surface].max(), rtol=1e-6)
    assert figure.layout.coloraxis.colorbar.title.text == "MPa"


def test_rings_show_a_field_without_unit_as_it_is(runs):
    # Wrong: which points are kept would be shown as 0.000001 MPa.
    figure = raceway.figures.rings(runs.reduced_motion(), step=10, field="in_region")
    assert max(float(np.max(trace.intensity)) for trace in figure.data) == 1.0
    assert not figure.layout.coloraxis.colorbar.title.text


def test_wrong_columns_are_refused_with_what_there_is(runs):
    results = runs.statics()
    with pytest.raises(raceway.ResultsError, match='no column "inner_cheese"; columns are step, time_s, ball'):
        raceway.figures.round_the_bearing(results, "cheese")
    with pytest.raises(raceway.ResultsError, match="the table of balls has no step 9; steps are 0 to 0"):
        raceway.figures.round_the_bearing(results, step=9)
    with pytest.raises(ValueError, match="columns have the units deg, µm; one figure shows columns of one unit"):
        raceway.figures.history(results, ["x_m", "tilt_x_rad"])
    with pytest.raises(raceway.ResultsError, match="the table balls has no ball 77"):
        raceway.figures.history(results, ["inner_force_n"], "balls", ball=77)
