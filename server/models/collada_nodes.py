"""How much the nodes of a COLLADA file become once each that names another holds all of that."""

from collections import Counter
from collections.abc import Mapping
from graphlib import CycleError, TopologicalSorter

from mend.errors import WrongInputError

MOST_PARTS = 100_000
"""Nodes and shapes that a browser is to make of one file."""


class NodeTally:
    """Counts nodes and what they hold, as it hears of them; `file` is for its sentences."""

    def __init__(self, file: str) -> None:
        self._file = file
        self._parts = 0
        self._open: list[str] = []
        self._roots: list[str] = []
        self._under: dict[str, list[str]] = {}
        self._shapes: Counter[str] = Counter()

    def begin(self, name: str, attributes: Mapping[str, str]) -> None:
        """An element has begun. Raises `WrongInputError` where there are too many."""
        if name in ("node", "visual_scene") or (self._open and name.startswith("instance_")):
            self._parts += 1
            self._refuse_many(self._parts)
        if name in ("node", "visual_scene"):
            key = f"#{attributes.get('id') or f' {len(self._under)}'}"
            holders = self._under[self._open[-1]] if self._open else self._roots
            holders.append(key)
            self._under.setdefault(key, [])
            self._open.append(key)
        elif self._open and name == "instance_node":
            self._under[self._open[-1]].append(attributes.get("url", ""))
        elif self._open and name.startswith("instance_"):
            self._shapes[self._open[-1]] += 1

    def end(self, name: str) -> None:
        """It has ended."""
        if name in ("node", "visual_scene"):
            self._open.pop()

    def check(self) -> None:
        """Raises `WrongInputError` for nodes that hold themselves, or too much."""
        sizes: dict[str, int] = {}
        try:
            for key in TopologicalSorter(self._under).static_order():
                held = sum(sizes[each] for each in self._under.get(key, ()))
                sizes[key] = min(1 + self._shapes[key] + held, MOST_PARTS + 1)
        except CycleError:
            raise WrongInputError(f"{self._file}: a node of it holds itself") from None
        self._refuse_many(sum(sizes[each] for each in self._roots))

    def _refuse_many(self, parts: int) -> None:
        if parts > MOST_PARTS:
            raise WrongInputError(
                f"{self._file}: its nodes hold more than {MOST_PARTS} nodes and shapes, each "
                "counted as often as it is named"
            )
