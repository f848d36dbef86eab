"""An issue: one fault that a robot detected while it worked on a leaf."""

from dataclasses import dataclass
from enum import StrEnum


class Sensed(StrEnum):
    """How a robot came to know of an issue."""

    SEEN = "seen"
    """It saw what is wrong, or does not say how it knows."""
    FELT = "felt"
    """By force, and not by a camera."""
    BY_LASER = "by_laser"
    """A laser saw something where the robot was to drive."""
    NOWHERE = "nowhere"
    """It looked for the object and saw it nowhere."""


@dataclass(frozen=True, slots=True)
class Issue:
    """One detected fault.

    `kind` is the name under which a monitor and a dialogue script are registered
    (`missed`, `dropped`, `unreachable`, `positioning`, `missing`, `blocked`, ...).
    `node` is the leaf's path (`/0/2`); `step` is the behavior's step in which it was seen,
    0 before the first. `reason` is a clause that says what the robot sensed, empty if it does not
    say; `sensed` how it came to know. `interrupts`: the robot does not go on by itself.
    `guesses`: where it may be if it is lost, likeliest first (`at F1-101`). `item`: what the leaf
    carries for people, `held_by`: in the basket of which robot that is, where it is in one,
    `away_m`: how far off that one stands, `message`: what it tells them, and `person`: whom it
    escorts, if it does.
    """

    kind: str
    robot: str
    node: str
    name: str
    object: str | None
    place: str | None
    step: int
    reason: str = ""
    sensed: Sensed = Sensed.SEEN
    interrupts: bool = True
    guesses: tuple[str, ...] = ()
    item: str | None = None
    message: str | None = None
    person: str | None = None
    held_by: str | None = None
    away_m: float | None = None
