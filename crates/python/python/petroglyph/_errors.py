"""What the package raises and warns of."""

from __future__ import annotations


class PetroglyphError(RuntimeError):
    """Something could not be done.

    The text is the sentence of the command line, followed by its hint.

    Attributes
    ----------
    reason : str
        What is wrong, in one sentence.
    hint : str
        What to do next.
    """

    def __init__(self, reason: str, hint: str = "") -> None:
        super().__init__(reason, hint)
        self.reason = reason
        self.hint = hint

    def __str__(self) -> str:
        return f"{self.reason}\nhint: {self.hint}" if self.hint else self.reason


class PetroglyphWarning(UserWarning):
    """Something that the user should know, which does not stop the work."""
