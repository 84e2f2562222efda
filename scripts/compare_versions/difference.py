"""What differs between two results, bit by bit, and how much."""

import re
from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class Difference:
    """One table column, data set or text that is not the same in both versions."""

    place: str
    # Number of values whose bits differ; 0 for what has no numbers.
    count: int = 0
    total: int = 0
    absolute: float = 0.0
    # Relative to the largest magnitude of its group of values.
    relative: float = 0.0
    # What is wrong where there are no real numbers to compare; no rule lets it pass.
    text: str = ""
    # Follows from other values, so that a tolerance covers it: counts of iterations, printed digits.
    is_secondary: bool = False

    def line(self):
        """One line for the user."""
        if self.text:
            return f"{self.place}: {self.text}"
        how = f"largest difference {self.absolute:.3e}, relative {self.relative:.3e}"
        if self.absolute == 0.0:
            how = "only signs of zeros"
        return f"{self.place}: {self.count} of {self.total} values, {how}"


def magnitude(*arrays):
    """Largest finite magnitude of all values."""
    return max((float(np.max(np.abs(a), initial=0.0, where=np.isfinite(a))) for a in arrays), default=0.0)


def compare_reals(place, old, new, scale=None):
    """None for the same bits; `scale` is the magnitude that relative differences refer to."""
    old, new = np.ascontiguousarray(old), np.ascontiguousarray(new)
    if old.shape != new.shape or old.dtype != new.dtype:
        return Difference(place, text=f"{old.dtype} {old.shape} became {new.dtype} {new.shape}")
    bits = np.dtype(f"u{old.dtype.itemsize}")
    changed = old.view(bits) != new.view(bits)
    count = int(np.count_nonzero(changed))
    if count == 0:
        return None
    a, b = old[changed].astype(np.float64), new[changed].astype(np.float64)
    if not (np.isfinite(a).all() and np.isfinite(b).all()):
        return Difference(place, text=f"{count} of {old.size} values differ, some of them not finite")
    absolute = float(np.max(np.abs(a - b)))
    scale = magnitude(old, new) if scale is None else scale
    return Difference(place, count, old.size, absolute, absolute / scale if scale > 0.0 else 0.0)


NUMBER = re.compile(r"[-+]?[0-9]+(\.[0-9]+)?(e[-+]?[0-9]+)?")


def compare_lines(place, old, new):
    """The first line that differs, or None; both are lists of lines."""
    if old == new:
        return None
    pairs = zip(old + [""] * len(new), new + [""] * len(old))
    first = next((i, a, b) for i, (a, b) in enumerate(pairs) if a != b)
    lines = f" ({len(old)} lines became {len(new)})" if len(old) != len(new) else ""
    digits = [[NUMBER.sub("#", line).split() for line in lines] for lines in (old, new)]
    text = f"line {first[0] + 1}: {first[1]!r} became {first[2]!r}{lines}"
    return Difference(place, text=text, is_secondary=digits[0] == digits[1])
