"""Tables of the program, to the last bit of every number."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pandas as pd

from .errors import ResultsError

# From 3.1 on pandas reads numbers exactly and warns of being asked to.
_VERSION = tuple(int(part) for part in pd.__version__.split(".")[:2])
_EXACT: dict[str, Any] = {} if _VERSION >= (3, 1) else {"float_precision": "round_trip"}


def read_table(path: Path) -> pd.DataFrame:
    """A CSV file with a line of names."""
    try:
        table: pd.DataFrame = pd.read_csv(path, **_EXACT)
        return table
    except (pd.errors.ParserError, pd.errors.EmptyDataError, UnicodeDecodeError) as error:
        raise ResultsError(f"{path} is damaged: {error}") from error
