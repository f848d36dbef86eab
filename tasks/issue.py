"""An issue: one fault that a robot detected while it worked on a leaf."""

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Issue:
    """One detected fault.

    `kind` is the name under which a monitor and a dialogue script are registered
    (`missed`, `dropped`, `unreachable`, `positioning`, `missing`, `blocked`, ...).
    `node` is the leaf's path (`/0/2`); `step` is the behavior's step in which it was seen,
    0 before the first. `reason` is a clause that says what the robot sensed, empty if it does not
    say; `felt`: by force, and not by a camera. `interrupts`: the robot does not go on by itself.
    """

    kind: str
    robot: str
    node: str
    name: str
    object: str | None
    place: str | None
    step: int
    reason: str = ""
    felt: bool = False
    interrupts: bool = True
