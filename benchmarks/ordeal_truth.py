"""What really was in a building whose service is killed, as its witness wrote it down."""

import json
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

from mend.robots.base.basket import FELT_KG, UNSURE_KG

SPARE_S = 1.0
MOMENT_S = 0.6
"""The witness writes something so often at least."""


@dataclass(frozen=True, slots=True)
class Line:
    """What the witness wrote at a time of the world's clock."""

    t: float
    what: str
    body: dict[str, Any]


class Truth:
    """What really was; `lines`: all that was ever so, `kept`: without what kills undid."""

    def __init__(self, file: Path) -> None:
        written = file.read_text() if file.exists() else ""
        read = [json.loads(each) for each in written.splitlines()]
        self.lines = [Line(each["t"], each["what"], each) for each in read]
        self.kept: list[Line] = []
        self.faults: list[str] = []
        self.lives = 0
        for line in self.lines:
            if line.what == "begun":
                self._begin(line)
            self.kept.append(line)

    def _begin(self, line: Line) -> None:
        self.lives += 1
        if not self.kept:
            return
        if line.t > self.kept[-1].t + MOMENT_S:
            self.faults.append(
                f"{line.t:.1f} s: a life began after the moment that had been so far"
            )
        at_that_moment: list[Any] = []
        while self.kept and self.kept[-1].t > line.t - 1e-6:
            last = self.kept.pop()
            if "items" in last.body and last.t < line.t + 1e-6:
                at_that_moment.append(last.body["items"])
        before: Any = next((e.body["items"] for e in reversed(self.kept) if "items" in e.body), {})
        if line.body["items"] not in [before, *at_that_moment]:
            self.faults.append(f"{line.t:.1f} s: a kill changed where things are: {line.body}")

    @property
    def items(self) -> dict[str, list[Any]]:
        """Where everything is in the end: place, robot, taken, delivered; and its kg."""
        last = next((e for e in reversed(self.kept) if "items" in e.body), None)
        return {} if last is None else last.body["items"]

    def baskets_between(
        self, begun_s: float, ended_s: float, number: int
    ) -> Iterator[frozenset[str]]:
        """What was in the basket of a robot in a span of wall time, and just before."""
        last: frozenset[str] = frozenset()
        for each in self.kept:
            if "items" not in each.body or each.body["wall_s"] > ended_s:
                continue
            items = each.body["items"].items()
            now = frozenset(
                n for n, (_, robot, taken, *_) in items if robot == number and not taken
            )
            if each.body["wall_s"] >= begun_s:
                yield last
            last = now
        yield last

    def shut_between(self, begun_s: float, ended_s: float) -> Iterator[list[str]]:
        """Which doors were shut in a span of wall time, just before and next after it, also in what
        a kill undid: on a busy machine a world says so only now and then."""
        before: list[str] | None = None
        for each in self.lines:
            if each.what != "state":
                continue
            if each.body["wall_s"] < begun_s:
                before = each.body["shut"]
                continue
            if before is not None:
                yield before
                before = None
            yield each.body["shut"]
            if each.body["wall_s"] > ended_s:
                return
        if before is not None:
            yield before

    def felt_alike_s(self, item: str) -> Iterator[float]:
        """When its robot offered it, and lost it, or what weighs about as much, to somebody else.

        A load cell does not tell who takes what.
        """
        before: dict[str, list[Any]] = {}
        for line in self.kept:
            stolen = line.what == "stolen" and line.body["offers"] == item
            if stolen and _weigh_alike(before[item], before[line.body["item"]]):
                yield line.t
            now, offered = line.body.get("items"), before.get(item)
            if now is None:
                continue
            for name, (place, _, _, delivered, _) in now.items():
                was = before.get(name)
                if name == item or was is None or offered is None or offered[1] is None:
                    continue
                mistaken = was[1] == offered[1] and place is not None and not delivered
                if mistaken and _weigh_alike(was, offered):
                    yield line.t
            before = now

    @cached_property
    def states(self) -> list[Line]:
        """Where robots and people were."""
        return [each for each in self.kept if each.what == "state"]

    def states_between(self, begun_s: float, ended_s: float) -> Iterator[dict[str, Any]]:
        """Where robots and people were in a span."""
        for each in self.states:
            if begun_s - SPARE_S <= each.t <= ended_s + SPARE_S:
                yield each.body

    def robot_at(self, number: int, at_s: float) -> list[Any] | None:
        """Where a robot last was at a wall time, also in what a kill undid; None before all."""
        before = [e for e in self.lines if e.what == "state" and e.body["wall_s"] <= at_s]
        return before[-1].body["robots"][number] if before else None

    def items_between(self, begun_s: float, ended_s: float) -> Iterator[dict[str, list[Any]]]:
        """Where things were in a span."""
        current: dict[str, list[Any]] = {}
        for each in self.kept:
            if each.t > ended_s + SPARE_S:
                break
            if "items" not in each.body:
                continue
            if each.t >= begun_s - SPARE_S:
                yield current
            current = each.body["items"]
        yield current


def _weigh_alike(one: list[Any], other: list[Any]) -> bool:
    return abs(one[4] - other[4]) < FELT_KG + UNSURE_KG
