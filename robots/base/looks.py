"""The looks of a base: where it is, if its way is free, what its basket weighs, who is near."""

from collections.abc import Callable

from mend.robots.base.base import Base
from mend.robots.base.behaviors.execution import BaseExecution
from mend.robots.base.companion import CAUGHT_UP_M
from mend.robots.base.way_ahead import WayAhead
from mend.robots.execution.command_error import CommandError
from mend.robots.execution.execution import AnyExecution
from mend.robots.execution.routine import Routine
from mend.robots.link.messages import FeltLoad, Look, Looked, Position

_PERIOD_S = 0.5


def answer(
    base: Base,
    command: str,
    fulfilled: bool | None,
    felt: FeltLoad | None = None,
    *,
    led_round: bool = False,
) -> Looked:
    """Where the base is; it sees no objects, and judges no results."""
    here = base.body.pose()
    at = Position(x=here.x, y=here.y, z=here.z)
    return Looked(
        command=command,
        objects={},
        gripper=at,
        fulfilled=fulfilled,
        felt=felt,
        led_round=led_round,
    )


def look_as_told(
    base: Base, command: str, look: Look, held: AnyExecution | None
) -> Routine[Looked]:
    """The routine of a `look` command. Raises `CommandError` for what no base can see."""
    if look.expect == "located":
        return _look_where(base, command, look)
    if look.expect in ("loaded", "unloaded"):
        return _feel(base, command, look, held)
    if look.expect == "charged":
        return _until(base, command, look.within_s, lambda: base.battery.charging)
    if look.expect == "accompanied":
        return _until(base, command, look.within_s, lambda: _is_accompanied(base, held))
    if look.expect not in (None, "way_clear"):
        raise CommandError(f"a base that drives cannot look for '{look.expect}'")

    return _look_ahead(base, command, look, held)


def _look_ahead(base: Base, command: str, look: Look, held: AnyExecution | None) -> Routine[Looked]:
    """Where it is, or whether it gets on, and whether that is because another way leads round."""
    if look.expect is None or not isinstance(held, BaseExecution):
        return answer(base, command, None if look.expect is None else True)
    end_s = base.body.time_s() + look.within_s
    while (ahead := held.way_ahead()) is WayAhead.BARRED:
        left_s = end_s - base.body.time_s()
        if left_s <= 1e-9:
            return answer(base, command, fulfilled=False)
        yield from base.wait(min(_PERIOD_S, left_s))
    return answer(base, command, fulfilled=True, led_round=ahead is WayAhead.ROUND)


def _feel(base: Base, command: str, look: Look, held: AnyExecution | None) -> Routine[Looked]:
    """Whether the basket holds what the step that waits needs, or else what was in it before.

    Who has begun anew and waits with no step still knows what it had asked for, or offered.
    """

    def felt() -> FeltLoad | None:
        if isinstance(held, BaseExecution):
            return held.felt()
        return base.load.as_offered() if look.expect == "unloaded" else base.load.as_asked()

    end_s = base.body.time_s() + look.within_s
    while (told := felt()) is not None:
        left_s = end_s - base.body.time_s()
        if left_s <= 1e-9:
            return answer(base, command, fulfilled=False, felt=told)
        yield from base.wait(min(_PERIOD_S, left_s))
    return answer(base, command, fulfilled=True)


def _look_where(base: Base, command: str, look: Look) -> Routine[Looked]:
    """Whether it knows where it is, or, with a guess, sees that it is there."""
    if look.guess is not None:
        return _look_there(base, command, look.guess)

    return _until(base, command, look.within_s, lambda: not base.whereabouts.is_lost)


def _until(base: Base, command: str, within_s: float, so: Callable[[], bool]) -> Routine[Looked]:
    """Whether something comes to be so in time."""
    end_s = base.body.time_s() + within_s
    while not so():
        left_s = end_s - base.body.time_s()
        if left_s <= 1e-9:
            return answer(base, command, fulfilled=False)
        yield from base.wait(min(_PERIOD_S, left_s))
    return answer(base, command, fulfilled=True)


def _is_accompanied(base: Base, held: AnyExecution | None) -> bool:
    if isinstance(held, BaseExecution):
        return held.accompanied()
    return base.company.is_within(CAUGHT_UP_M)


def _look_there(base: Base, command: str, guess: str) -> Routine[Looked]:
    """By a scan that was made after somebody said so, and some more that bear it out."""
    yield from base.wait(_PERIOD_S)
    agrees = base.whereabouts.believe(guess)
    yield from base.wait(_PERIOD_S)
    return answer(base, command, fulfilled=agrees and not base.whereabouts.is_lost)
