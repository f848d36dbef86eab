"""One pick and place, or one hand-over, and what became of it."""

from dataclasses import dataclass, field
from typing import NamedTuple

LAST_STEP = 8


class Moment(NamedTuple):
    """So far in a pick and place: step 0 is before the robot is told, 9 after it is done."""

    step: int
    fraction: float = 0.0


NEVER = Moment(99)
AFTER_DONE = Moment(LAST_STEP + 1)


class NotNowError(Exception):
    """A person cannot do what a fault takes; the trial says nothing."""


@dataclass(frozen=True, slots=True)
class Said:
    """An issue as the robot told it, and whether the world bore it out then."""

    issue: str
    time_s: float
    why: str
    true: bool


@dataclass(slots=True)
class Trial:
    """What became of one pick and place, or of one hand-over.

    `out_s` is from when the fingers really held the part no more after the fault. `placed`: in the
    end such a part stands at the place.
    """

    seed: int
    name: str
    kind: str
    moment: Moment = NEVER
    detail: str = ""
    said: list[Said] = field(default_factory=list)
    fault_s: float | None = None
    out_s: float | None = None
    plain_s: float | None = None
    finished: bool = False
    placed: bool = False
