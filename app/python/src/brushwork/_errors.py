"""What can go wrong, by the exit codes of the command line."""

from __future__ import annotations


class BrushworkError(Exception):
    """A command failed. The text is the program's own sentence; ``code`` is its exit code."""

    def __init__(self, sentence: str, code: int) -> None:
        super().__init__(sentence)
        self.code = code


class ProgramMissing(BrushworkError):
    """The program ``brushwork`` is not where it should be."""


class NoLink(BrushworkError):
    """No controller could be reached, or the link was lost (exit code 3)."""


class Refused(BrushworkError):
    """The controller or a safety rule refused or ended it (exit code 4)."""


class NotTaken(BrushworkError):
    """A setting or a profile was refused, or did not take (exit code 5)."""


_BY_CODE: dict[int, type[BrushworkError]] = {3: NoLink, 4: Refused, 5: NotTaken}


def failure(code: int, said: str) -> BrushworkError:
    """The error of that exit code with what the program said on standard error."""
    sentence = said.strip() or f"brushwork ended with {code} and said nothing"
    return _BY_CODE.get(code, BrushworkError)(sentence, code)
