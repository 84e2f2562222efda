"""Every Python block of the documents runs, in its order, in a folder with the scenes of the project."""

from __future__ import annotations

import ctypes.util
import re
import subprocess
import sys

import pytest
from conftest import ROOT

PAGES = ["docs/python.md", "python/README.md"]


@pytest.mark.parametrize("page", PAGES)
def test_the_python_of_a_page_runs(page, tmp_path):
    text = (ROOT / page).read_text(encoding="utf-8")
    blocks = re.findall(r"^```python\n(.*?)^```$", text, flags=re.MULTILINE | re.DOTALL)
    assert blocks
    if not any(ctypes.util.find_library(name) for name in ("OSMesa", "EGL")):
        blocks = [block for block in blocks if "Plotter" not in block]
    for name in ("scenes", "meshes"):
        (tmp_path / name).symlink_to(ROOT / name)
    done = subprocess.run([sys.executable, "-c", "\n".join(blocks)], cwd=tmp_path, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    if any("screenshot" in block for block in blocks):
        assert (tmp_path / "rings.png").stat().st_size > 5000
