"""Figures of results with Plotly: hover, zoom, and HTML pages of their own."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from .errors import MissingPackage, ResultsError
from .results import Results, unit_of_field

if TYPE_CHECKING:
    import pandas as pd
    import plotly.graph_objects

#: Ending of a column in SI, factor to the unit shown, and that unit; longer endings first.
UNITS = (
    ("_rad_per_s", 1.0, "rad/s"),
    ("_n_m", 1.0, "N m"),
    ("_pa", 1e-6, "MPa"),
    ("_rad", 180.0 / np.pi, "deg"),
    ("_hz", 1.0, "Hz"),
    ("_per_k", 1.0, "1/K"),
    ("_k", 1.0, "K"),
    ("_j", 1e3, "mJ"),
    ("_n", 1.0, "N"),
    ("_m", 1e6, "µm"),
    ("_s", 1.0, "s"),
)
SIDES = ("inner", "outer")
# Both contacts of a ball at rest carry the same force: one must be seen through the other.
DASHES = {"inner": "solid", "outer": "dot"}
MARKERS = {"inner": "circle", "outer": "circle-open"}
#: Fields whose name is not that of the quantity.
FIELDS = {"von_mises": "von Mises stress"}


def shown(column: str) -> tuple[str, float, str]:
    """Name, factor and unit with which a column of a table is shown."""
    for ending, factor, unit in UNITS:
        if column.endswith(ending):
            return column.removesuffix(ending).replace("_", " "), factor, unit
    return column.replace("_", " "), 1.0, ""


def round_the_bearing(
    results: Results, quantity: str = "force_n", step: int | None = None
) -> plotly.graph_objects.Figure:
    """A quantity of both contacts of every ball against its azimuth, at a step, by default the last one.

    Of the folder of a list of bearings, each bearing has lines of its own.
    `quantity` is a column of the table of balls without its side: `force_n`, `contact_angle_rad`, `peak_pressure_pa`.
    """
    table = results.balls
    number = int(table["step"].iloc[-1]) if step is None else step
    rows = table[table["step"] == number]
    if rows.empty:
        first, last = table["step"].iloc[0], table["step"].iloc[-1]
        raise ResultsError(f"{results.folder}: the table of balls has no step {number}; steps are {first} to {last}")
    rows = rows.assign(azimuth_deg=np.degrees(rows["azimuth_rad"]) % 360.0).sort_values("azimuth_deg")
    name, factor, unit = shown(quantity)
    figure = _figure(f"{name} at both contacts, step {number}", "azimuth, deg", f"{name}, {unit}")
    for place, own in _apart(rows):
        for side in SIDES:
            column = _column(results, own, f"{side}_{quantity}")
            text = [f"ball {ball}" for ball in own["ball"]]
            figure.add_scatter(
                x=own["azimuth_deg"], y=factor * column, name=f"{place}{side}", mode="lines+markers", text=text,
                line={"dash": DASHES[side]}, marker={"symbol": MARKERS[side], "size": 8},
            )  # fmt: skip
    figure.update_xaxes(range=[-5, 365], dtick=45)
    return figure


def history(
    results: Results, columns: Sequence[str], table: str = "shaft", ball: int | None = None
) -> plotly.graph_objects.Figure:
    """Columns of a table over time; of a sweep against the swept value. `ball` chooses the rows of one ball.

    Of the folder of a list of bearings, each bearing, or place on the shaft, has a line of its own.
    """
    rows = results.table(table)
    if "ball" in rows:
        rows = rows[rows["ball"] == (0 if ball is None else ball)]
        if rows.empty:
            raise ResultsError(f"{results.folder}: the table {table} has no ball {ball}")
    if not columns:
        raise ValueError("no column is given; expected one or more of the table")
    swept = [name for name in rows.columns if "." in name]
    across = swept[0] if swept else "time_s"
    x_name, x_factor, x_unit = shown(across)
    units = {shown(column)[2] for column in columns}
    if len(units) > 1:
        raise ValueError(f"columns have the units {', '.join(sorted(units))}; one figure shows columns of one unit")
    label = units.pop() or "value"
    figure = _figure(", ".join(shown(column)[0] for column in columns), f"{x_name}, {x_unit}", label)
    for column in columns:
        name, factor, _ = shown(column)
        for place, own in _apart(rows):
            values = factor * _column(results, own, column)
            mode = "lines" if len(own) > 60 else "lines+markers"
            x = x_factor * _column(results, own, across)
            figure.add_scatter(x=x, y=values, name=f"{place}{name}", mode=mode)
    return figure


def _apart(rows: pd.DataFrame) -> list[tuple[str, pd.DataFrame]]:
    """The rows of each bearing of a list, or place on its shaft, with what its name begins with."""
    for column, text in (("bearing", "{} "), ("position_m", "{:.4g} m, ")):
        if column in rows and rows[column].nunique() > 1:
            return [(text.format(value), own) for value, own in rows.groupby(column, sort=False)]
    return [("", rows)]


def energy(results: Results) -> plotly.graph_objects.Figure:
    """All terms of the energy over time; in motion the ledger."""
    table = results.energy
    terms = [name for name in table.columns if name.endswith("_j")]
    figure = history(results, terms, "energy")
    figure.update_layout(title="energy")
    return figure


def modes(results: Results) -> plotly.graph_objects.Figure:
    """Natural frequencies of each body."""
    table = results.table("modes")
    figure = _figure("natural frequencies", "mode", "frequency, Hz")
    for body, rows in table.groupby("body", sort=False):
        figure.add_scatter(x=rows["mode"], y=rows["frequency_hz"], name=str(body), mode="markers")
    return figure


def campbell(results: Results) -> plotly.graph_objects.Figure:
    """Frequencies of the modes over the speed, and the lines of what excites the bearing."""
    table, lines = results.table("campbell"), results.table("campbell_lines")
    figure = _figure("Campbell diagram", "speed, rpm", "frequency, Hz")
    for whirl, rows in table.groupby("whirl", sort=False):
        damping = [f"mode {m}, damping ratio {d:.3g}" for m, d in zip(rows["mode"], rows["damping_ratio"])]
        figure.add_scatter(x=rows["speed_rpm"], y=rows["frequency_hz"], name=str(whirl), mode="markers", text=damping)
    for name in lines.columns.drop("speed_rpm"):
        label = name.removesuffix("_hz").replace("_", " ")
        figure.add_scatter(x=lines["speed_rpm"], y=lines[name], name=label, mode="lines", line={"dash": "dot"})
    figure.update_yaxes(range=[0, 1.1 * float(table["frequency_hz"].max())])
    return figure


def rings(
    results: Results, step: int = -1, scale: float = 0.0, field: str = "von_mises"
) -> plotly.graph_objects.Figure:
    """Both rings in space, coloured by a field of one number a point; `scale` times the displacement moves them."""
    shot = results.step(step)
    values = shot[field]
    if values.ndim != 1:
        raise ValueError(f"the field {field} has {values.shape[1]} components a point; one is expected")
    places = shot.mesh.points + (scale * shot["displacement"] if scale else 0.0)
    unit = unit_of_field(field)
    factor, unit = (1e-6, "MPa") if unit == "Pa" else (1.0, unit.removeprefix("1"))
    values = factor * values
    highest = float(np.nanmax(values))
    figure = _figure(f"{FIELDS.get(field, field.replace('_', ' '))}, step {shot.number}", "", "")
    for ring in SIDES:
        triangles = shot.mesh.surface(ring)
        used, corners = np.unique(triangles, return_inverse=True)
        i, j, k = corners.reshape(-1, 3).T
        x, y, z = 1e3 * places[used].T
        figure.add_mesh3d(
            x=x, y=y, z=z, i=i, j=j, k=k, intensity=values[used], name=ring,
            coloraxis="coloraxis", hovertemplate=f"%{{intensity:.4g}} {unit}<extra>" + ring + "</extra>",
        )  # fmt: skip
    bar = {"title": {"text": unit}}
    figure.update_layout(coloraxis={"colorscale": "Viridis", "colorbar": bar, "cmin": 0.0, "cmax": highest})
    figure.update_scenes(aspectmode="data", xaxis_title="x, mm", yaxis_title="y, mm", zaxis_title="z, mm")
    return figure


def _column(results: Results, rows: Any, column: str) -> Any:
    if column not in rows:
        known = ", ".join(rows.columns)
        raise ResultsError(f'{results.folder}: the table has no column "{column}"; columns are {known}')
    return rows[column]


def _figure(title: str, x: str, y: str) -> Any:
    try:
        from plotly import graph_objects
    except ImportError as error:
        raise MissingPackage(f"{error}; install it with: pip install 'raceway[figures]'") from error
    layout = {"title": {"text": title}, "template": "simple_white", "hovermode": "closest"}
    return graph_objects.Figure(layout={**layout, "xaxis": {"title": {"text": x}}, "yaxis": {"title": {"text": y}}})
