"""A table of a report: what it shows, and what its figures were counted over."""

from collections.abc import Sequence
from dataclasses import dataclass

from mend.server.report.csv_text import no_formula

Cell = str | int | float | None
"""None is what is not known, or not there."""


@dataclass(frozen=True, slots=True)
class Table:
    """`note` says what its figures were counted over; `folded`: too long to be shown at once."""

    name: str
    title: str
    note: str
    columns: tuple[str, ...]
    rows: Sequence[tuple[Cell, ...]]
    folded: bool = False

    @property
    def figures(self) -> list[bool]:
        """By column, whether there are figures in it."""
        return [
            any(isinstance(row[number], int | float) for row in self.rows)
            for number in range(len(self.columns))
        ]


def shown(cell: Cell) -> str:
    """A cell for people: a figure to one decimal."""
    if cell is None:
        return "–"
    return f"{cell:.1f}" if isinstance(cell, float) else str(cell)


def written(cell: Cell) -> str:
    """A cell for programs: a figure to a thousandth, nothing for what is not known."""
    if cell is None:
        return ""
    if isinstance(cell, str):
        return no_formula(cell)
    return f"{cell:.3f}".rstrip("0").rstrip(".") if isinstance(cell, float) else str(cell)
