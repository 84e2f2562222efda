"""The notebooks run from the first cell to the last, and a picture is made off screen."""

from __future__ import annotations

import ctypes.util
import subprocess
import sys
from pathlib import Path

import pytest

EXAMPLES = Path(__file__).resolve().parents[1] / "examples"


@pytest.mark.parametrize("notebook", sorted(EXAMPLES.glob("*.ipynb")), ids=lambda path: path.stem)
def test_a_notebook_runs_to_its_end(notebook):
    nbformat = pytest.importorskip("nbformat")
    client = pytest.importorskip("nbclient")
    book = nbformat.read(notebook, as_version=4)
    client.NotebookClient(book, timeout=120, resources={"metadata": {"path": str(EXAMPLES)}}).execute()
    code = [cell for cell in book.cells if cell.cell_type == "code"]
    assert len(code) > 5 and all(cell.execution_count for cell in code)
    shown = "".join(str(output) for cell in code for output in cell.outputs)
    assert "application/vnd.plotly.v1+json" in shown
    assert "axial force of all balls: 200" in shown
    assert "warning: " not in shown


def test_notebooks_are_kept_without_results():
    nbformat = pytest.importorskip("nbformat")
    for notebook in EXAMPLES.glob("*.ipynb"):
        book = nbformat.read(notebook, as_version=4)
        assert not any(cell.get("outputs") for cell in book.cells), f"{notebook}: clear its outputs"


PICTURE = """
import sys
import numpy, pyvista, raceway
grid = raceway.open(sys.argv[1]).step(-1).to_pyvista(scale=200.0)
grid["stress, MPa"] = 1e-6 * grid["von_mises"]
plotter = pyvista.Plotter(off_screen=True, window_size=(600, 450))
plotter.add_mesh(grid.extract_cells(numpy.flatnonzero(grid["body"] < 2)), scalars="stress, MPa")
plotter.screenshot(sys.argv[2])
"""


def test_pyvista_draws_off_screen(runs, tmp_path):
    pyvista = pytest.importorskip("pyvista")
    if not any(ctypes.util.find_library(name) for name in ("OSMesa", "EGL")):
        pytest.skip("no library that draws without a screen; Debian has libosmesa6 and libegl1")
    picture = tmp_path / "rings.png"
    # In a process of its own: a broken graphics library ends it without an exception.
    words = [sys.executable, "-c", PICTURE, str(runs.statics().folder), str(picture)]
    done = subprocess.run(words, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    image = pyvista.read(picture)
    colours = {tuple(colour) for colour in image.active_scalars[:, :3]}
    # White alone, or rings in one colour, are a few; stress takes hundreds.
    assert image.dimensions[:2] == (600, 450) and len(colours) > 200
