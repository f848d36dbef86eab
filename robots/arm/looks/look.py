"""The routines of a look: once, or until what is expected has come to be."""

from collections.abc import Callable

from mend.robots.arm.behaviors.search import LOOK_AGAIN_S
from mend.robots.arm.command_resolver import CommandResolver
from mend.robots.arm.looks.expectation import AtPlace, ViewClear, VisualCheck
from mend.robots.arm.looks.gentle_try import GentleTry
from mend.robots.arm.looks.hand_over import take_from_person
from mend.robots.arm.looks.in_reach import InReach
from mend.robots.arm.looks.looker import Looker
from mend.robots.arm.looks.way_clear import WayClear
from mend.robots.execution.routine import Routine
from mend.robots.link.messages import Look, Looked
from mend.robots.vision.behind_others import BehindOthers

_PERIOD_S = 0.5


def look_as_told(
    looker: Looker, command: str, look: Look, resolver: CommandResolver
) -> Routine[Looked]:
    """The routine of a `look` command. Raises `CommandError`."""
    if look.expect is None:
        return look_once(looker, command)
    if look.expect not in ("way_clear", "view_clear"):
        looker.perception.head.want(resolver.object_of(look))
    if look.expect == "in_gripper":
        part = resolver.object_of(look)
        return take_from_person(looker, command, part, look.within_s)
    make: dict[str, Callable[[], VisualCheck]] = {
        "at_place": lambda: AtPlace(looker, resolver.object_of(look), resolver.place_of(look)),
        "in_reach": lambda: InReach(looker, resolver.object_of(look)),
        "way_clear": lambda: WayClear(looker),
        "view_clear": lambda: ViewClear(looker),
    }
    # Nobody is pushed before they had time to clear the way.
    trial = GentleTry(looker) if look.expect == "way_clear" and look.within_s > 0.0 else None
    return look_until(looker, command, make[look.expect](), look.within_s, trial)


def look_once(looker: Looker, command: str) -> Routine[Looked]:
    """One look at everything."""
    yield from looker.feel_whether_it_is_held()
    yield from looker.free_view()
    return (yield from looker.answer_and_judge(command, None))


def look_until(
    looker: Looker,
    command: str,
    expectation: VisualCheck,
    within_s: float,
    trial: GentleTry | None = None,
) -> Routine[Looked]:
    """Look every half second until it is so twice and a `trial` passes, or `within_s` have passed.

    That it is not so is said of nothing that robots have hidden all the time that just pass.
    """
    yield from looker.free_view()
    end_s = looker.arm.body.time_s() + within_s
    behind = BehindOthers()
    while True:
        left_s = end_s - looker.arm.body.time_s()
        if left_s <= _PERIOD_S:
            # That nothing changes is not enough to say that it is not so.
            looker.perception.head.doubt()
        yield from looker.feel_whether_it_is_held()
        fulfilled = expectation.is_fulfilled()
        if fulfilled:
            # A thank-you is not said for what one noisy picture shows.
            yield from looker.arm.wait(LOOK_AGAIN_S)
            looker.perception.head.doubt()
            fulfilled = expectation.is_fulfilled()
        if fulfilled and trial is not None:
            fulfilled = yield from trial.passes()
        passing = not fulfilled and looker.others_pass(behind)
        if fulfilled or (left_s <= 1e-9 and not passing):
            return (yield from looker.answer_and_judge(command, fulfilled, expectation.detection))
        yield from looker.arm.wait(min(_PERIOD_S, left_s) if left_s > 1e-9 else LOOK_AGAIN_S)
