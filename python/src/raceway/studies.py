"""The results of a study: a grid of runs with their errors and costs."""

from __future__ import annotations

import json
import os
from functools import cached_property
from pathlib import Path
from typing import Any

import pandas as pd

from .errors import ResultsError
from .results import Results
from .tables import read_table


class Study:
    """A folder that `raceway study` has written."""

    def __init__(self, folder: str | os.PathLike[str]) -> None:
        #: The folder.
        self.folder = Path(folder)
        if not (self.folder / "study.csv").is_file():
            raise ResultsError(f"{self.folder} has no study.csv; expected the folder of a study that has been run")

    def __repr__(self) -> str:
        return f"<raceway.Study {self.folder}: {len(self.table)} points>"

    @cached_property
    def table(self) -> pd.DataFrame:
        """A row per point: its settings, values, errors and costs."""
        return read_table(self.folder / "study.csv")

    @cached_property
    def report(self) -> dict[str, Any]:
        """All that the study has found, with references and orders: `study.json`."""
        return dict(json.loads((self.folder / "study.json").read_text(encoding="utf-8")))

    def results(self, point: int) -> Results:
        """The results of a point."""
        folder = self.folder / "points" / f"{point:04}" / "run"
        if not folder.is_dir():
            raise ResultsError(f"{self.folder} has no results of point {point}; it failed or was not run")
        return Results(folder)


def open_study(folder: str | os.PathLike[str]) -> Study:
    """Opens the folder of a study."""
    return Study(folder)
