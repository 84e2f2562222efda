"""What can go wrong, each with the words of the program or of this package."""

from __future__ import annotations


class RacewayError(Exception):
    """Any error of this package."""


class ResultsError(RacewayError):
    """A folder or file that is missing, damaged or of another kind than asked for."""


class MissingPackage(RacewayError):
    """An optional Python package is needed for what was asked."""


class ProgramMissing(RacewayError):
    """The program `raceway` was not found."""


class ProgramError(RacewayError):
    """The program ended with an error; the text is what it said."""

    def __init__(self, text: str, code: int) -> None:
        super().__init__(text)
        #: Exit code of the program; negative: the number of the signal that ended it.
        self.code = code


class InputError(ProgramError):
    """Wrong input or set-up (exit code 2)."""


class NoSolution(ProgramError):
    """No equilibrium or step was found (exit code 3)."""


class StoppedEarly(ProgramError):
    """A run stopped before its end and was saved (exit code 75): over time `raceway.resume` goes on."""
