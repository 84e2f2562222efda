"""What a scene's differences mean: the same bits, within the rule of its kind, or not."""

from dataclasses import dataclass, field

from . import modes, tables
from .scene import MODES, STATIC

SAME, WITHIN, DIFFERS, MISSING = "same bits", "within the rule", "DIFFERS", "MISSING"
# Equal counts of iterations: the order of sums is all that may differ.
EQUAL_COUNTS = 1e-12
# Otherwise: so many times the tolerance at which iterations stop.
STOPPING = 10.0
STOPS = {"facet": 1e-6}
DEFAULT_STOP = 1e-10


@dataclass
class Verdict:
    """What was found of one scene or group of inputs."""

    name: str
    word: str
    size: str = ""
    differences: list = field(default_factory=list)
    # What a reader should know although it is no difference.
    notes: list = field(default_factory=list)

    def is_good(self):
        """Whether the refactoring may pass."""
        return self.word in (SAME, WITHIN)


def largest(differences):
    """The largest relative difference as text, or the first that has no size."""
    if any(d.text and not d.is_secondary for d in differences):
        return f"{len(differences)} places, some without size"
    return f"{len(differences)} places, largest relative {max((d.relative for d in differences), default=0.0):.1e}"


def tolerance(case, old_counts, new_counts):
    """The relative difference that a result at rest may have."""
    if old_counts == new_counts:
        return EQUAL_COUNTS
    mode = next((s.split("=")[1] for s in case.settings if s.startswith("contact.mode=")), "patch")
    return STOPPING * STOPS.get(mode, DEFAULT_STOP)


def judge(case, differences, folders):
    """The verdict on a scene's results; `folders` are those of the old and the new version."""
    if not differences:
        return Verdict(case.name, SAME)
    if case.kind == STATIC:
        return judge_at_rest(case, differences, folders)
    if case.kind == MODES and all((f / "modes.csv").exists() for f in folders):
        return judge_modes(case, differences, folders)
    return Verdict(case.name, DIFFERS, largest(differences), differences)


def judge_at_rest(case, differences, folders):
    """Equilibria agree to a tolerance."""
    summaries = [folder / "summary.json" for folder in folders]
    if not all(path.exists() for path in summaries):
        return Verdict(case.name, DIFFERS, largest(differences), differences)
    counts = [tables.iterations(path) for path in summaries]
    limit = tolerance(case, *counts)
    hard = [d for d in differences if not d.is_secondary and (d.text or d.relative > limit)]
    notes = [] if counts[0] == counts[1] else [f"iterations {counts[0]} became {counts[1]}"]
    if hard:
        return Verdict(case.name, DIFFERS, f"{largest(hard)}, allowed {limit:.0e}", hard, notes)
    return Verdict(case.name, WITHIN, f"{largest(differences)}, allowed {limit:.0e}", differences, notes)


def judge_modes(case, differences, folders):
    """Frequencies and subspaces agree; what else a file of a mode holds follows from its shape."""
    beyond, frequency, angle = modes.compare(*folders)
    size = f"frequencies {frequency:.1e}, angles {angle:.1e}"
    texts = [d for d in differences if d.text and not d.is_secondary]
    if beyond or texts:
        return Verdict(case.name, DIFFERS, size, beyond + texts)
    return Verdict(case.name, WITHIN, size, differences)
