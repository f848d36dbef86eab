"""Problems: the mistakes of a file, each with its line and node, told all at once."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

from mend.errors import WrongInputError

_MAX_TOLD = 50
_MAX_LISTED = 12
_MOST_CHARS = 1000
"""Of one message: what is quoted in it may be of any length."""


@dataclass(frozen=True, slots=True)
class Problem:
    """One mistake. `line` and `column` count from 1; `node_path` is the path of child indices.

    `column` is known where the text could not be read at all.
    """

    line: int | None
    node_path: str | None
    message: str
    column: int | None = None

    def describe(self, source: str) -> str:
        """One line: where it is and what is wrong."""
        place = source if self.line is None else f"{source}:{self.line}"
        node = "" if self.node_path is None else f"{self.node_path}: "
        cut = "..." if len(self.message) > _MOST_CHARS else ""
        return f"{place}: {node}{self.message[:_MOST_CHARS]}{cut}"


class InvalidFileError(WrongInputError):
    """A file has mistakes; `problems` holds every one of them, in the order of their lines."""

    def __init__(self, source: str, problems: Iterable[Problem]) -> None:
        self.source = source
        self.problems: Sequence[Problem] = sorted(problems, key=lambda each: each.line or 0)
        told = [problem.describe(source) for problem in self.problems[:_MAX_TOLD]]
        if len(self.problems) > _MAX_TOLD:
            told.append(f"{source}: and {len(self.problems) - _MAX_TOLD} more problems")
        super().__init__("\n".join(told))


def list_names(names: Iterable[str]) -> str:
    """Names for a sentence, cut short where there are many."""
    known = sorted(names)
    listed = ", ".join(f"'{name}'" for name in known[:_MAX_LISTED])
    return f"{listed}, ... ({len(known)} in all)" if len(known) > _MAX_LISTED else listed
