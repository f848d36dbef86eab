"""Kills in an ordeal: at moments of its world's own clock, so that they come on any machine.

They are drawn before it begins, and written beside the truth. The witness in the world carries them
out, each once over all of its lives, and the truth tells of each.
"""

import json
import os
import signal
import time
from collections.abc import Callable, Set
from dataclasses import asdict, dataclass
from enum import StrEnum
from pathlib import Path
from random import Random
from typing import Any

PLAN = ".kills"
"""The plan is in a file of the truth's name with this behind it."""
SERVICE, WORLD = "service", "robots"
LONGEST_PAUSE_S = 0.05


class Moment(StrEnum):
    """What a kill may wait for: that a thing changes hands, or that a robot charges."""

    CHANGES_HANDS = "changes_hands"
    CHARGES = "charges"


PATIENCE_S = {Moment.CHANGES_HANDS: 20.0, Moment.CHARGES: 60.0}
"""A kill that waits for a moment waits no longer."""


@dataclass(frozen=True, slots=True)
class Kill:
    """`kill -9` of the service, or of a world that has a process of its own.

    `at_s`: when, by the world's clock; with `waits_for` the first time from then on that this is
    so. `pause_s` of wall time, in which the world stands still, the service goes on.
    """

    at_s: float
    whom: str
    waits_for: Moment | None
    pause_s: float


def draw_kills(chance: Random, kills: int, ends_s: float, *, apart: bool) -> list[Kill]:
    """So many kills until a time; `apart`: the world has a process of its own."""
    times_s = sorted(chance.uniform(5.0, ends_s) for _ in range(kills))
    return [
        Kill(
            at_s=at_s,
            whom=WORLD if apart and chance.random() < 0.5 else SERVICE,
            waits_for=chance.choice((None, None, Moment.CHANGES_HANDS, Moment.CHARGES)),
            pause_s=chance.uniform(0.0, LONGEST_PAUSE_S) if apart else 0.0,
        )
        for at_s in times_s
    ]


def write_kills(kills: list[Kill], truth: Path) -> None:
    """Before the world begins."""
    _plan_of(truth).write_text(json.dumps([asdict(each) for each in kills]))


def kills_so_far(truth: Path) -> int:
    """How many the truth tells of."""
    return truth.read_text().count('"what": "killed"') if truth.exists() else 0


class Executioner:
    """Kills in a world's process, or its service's, as was written, from where a kill left it."""

    def __init__(self, truth: Path, write: Callable[..., None], *, apart: bool) -> None:
        """`write`: has the truth tell of something; `apart`: it is not in the service's process."""
        plan = _plan_of(truth)
        drawn: list[dict[str, Any]] = json.loads(plan.read_text()) if plan.exists() else []
        self._left = [Kill(**each) for each in drawn[kills_so_far(truth) :]]
        self._write, self._service = write, os.getppid() if apart else os.getpid()

    def look(self, now_s: float, moments: Set[Moment]) -> None:
        """Kill if it is time, where all of `moments` are so; returns only if not."""
        if not self._left or now_s < self._left[0].at_s:
            return
        kill = self._left[0]
        moment = kill.waits_for
        if moment and moment not in moments and now_s < kill.at_s + PATIENCE_S[moment]:
            return
        self._write("killed", whom=kill.whom, due_s=kill.at_s, waits_for=kill.waits_for)
        time.sleep(kill.pause_s)
        if kill.whom == SERVICE and self._service == os.getppid():
            os.kill(self._service, signal.SIGKILL)
        os.kill(os.getpid(), signal.SIGKILL)


def _plan_of(truth: Path) -> Path:
    return truth.with_name(truth.name + PLAN)
