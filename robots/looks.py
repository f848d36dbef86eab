"""Looks: one look at everything, or looking until what is expected has come to be."""

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Protocol

from robots.arm import Arm, Routine
from robots.behaviors.contact import hindering_n
from robots.behaviors.errand import Errand
from robots.behaviors.grasp_choice import others
from robots.behaviors.pick_and_place import lifting
from robots.behaviors.planning import Plan, at_once, plan_amid
from robots.behaviors.preparation import LOOK_AGAIN_S
from robots.body import CameraImage, ToolPose
from robots.catalogue import Part
from robots.grasp import can_grasp
from robots.grip import GripState
from robots.grip.composition import likeliest
from robots.link.messages import FinishedResult, Holding, Location, Look, Looked, ReportBody
from robots.result import Result
from robots.senses import Senses
from robots.understanding import Understanding
from robots.vision.head import HeadSighting
from robots.vision.obstruction import Obstruction
from robots.vision.presence import Presence
from robots.vision.seen_box import SeenBox

LOOK_PERIOD_S = 0.5

_Spot = tuple[str | None, float, float, float]
"""What stands somewhere: its name, x, y and height."""

_RESTS_WITHIN_M = 0.006
"""An object rests if it is this near to where the look before saw it."""
_STEADY_S = 0.3
_TRY_EVERY_S = 2.0
"""Where the picture cannot tell whether anything is held out, the fingers close that often."""
_CLEAR_FORCE_N = 20.0
"""What holds an arm up at its first try pushes harder; its own load and noise make at most 8 N."""
_MOST_READINGS = 6


@dataclass(frozen=True, slots=True)
class Looker:
    """What a look works with.

    `way` are the poses that the held execution has still to go through, `obstruction` what was seen
    to be in the way; `execution` its id, `destination` its object and where that goes.
    `may_move`: the arm may go to neutral to free the head camera's view. `finished`: the results
    that it is to judge.
    """

    arm: Arm
    senses: Senses
    report: Callable[[ReportBody], None]
    execution: str | None
    way: list[ToolPose]
    may_move: bool
    destination: tuple[Part, Location | None] | None = None
    obstruction: Obstruction | None = None
    finished: Sequence[Result] = ()

    def free_view(self) -> Routine[None]:
        """Move the arm out of the head camera's view if that is allowed."""
        if self.may_move:
            yield from self.arm.go_to_neutral()

    def answer(self, command: str, fulfilled: bool | None) -> Looked:
        """All that the head camera sees now; it judges no results."""
        return self._looked(command, fulfilled, self.senses.look(), {})

    def answer_and_judge(self, command: str, fulfilled: bool | None) -> Routine[Looked]:
        """All that the head camera sees, and what became of the finished results.

        What seems gone, or a picture that shows no table, has to be so in a second picture as
        well: a hand may pass by. With the arm in view it judges none.
        """
        image = self.senses.look()
        results = self.finished if self.arm.at_neutral else ()
        verdicts = self._judge(image, results)
        doubted = [each for each in results if verdicts[each.message] is Presence.GONE]
        blind = self.senses.why_blind(image) is not None
        if doubted or blind:
            yield from self.arm.wait(LOOK_AGAIN_S)
            self.senses.doubt()
            image = self.senses.look()
            verdicts |= self._judge(image, results if blind else doubted)
        return self._looked(command, fulfilled, image, verdicts)

    def look_at_table(self) -> CameraImage | None:
        """A head picture; None if it shows nothing of the table."""
        image = self.senses.look()
        return image if self.senses.why_blind(image) is None else None

    def _judge(
        self, image: CameraImage, results: Sequence[Result]
    ) -> dict[FinishedResult, Presence]:
        if self.senses.why_blind(image) is not None:
            return {each.message: Presence.HIDDEN for each in results}
        presence = self.senses.presence
        return {each.message: presence(image, each.part, each.target) for each in results}

    def _looked(
        self,
        command: str,
        fulfilled: bool | None,
        image: CameraImage,
        verdicts: Mapping[FinishedResult, Presence],
    ) -> Looked:
        blind = self.senses.why_blind(image)
        return Looked(
            command=command,
            objects=self.senses.sight_all(image) if blind is None else {},
            gripper=self.senses.gripper(),
            fulfilled=fulfilled,
            there=[each for each, so in verdicts.items() if so is Presence.THERE],
            gone=[each for each, so in verdicts.items() if so is Presence.GONE],
            held=self.senses.held,
            blind=blind,
        )


class Expectation(Protocol):
    """Something that a look waits for."""

    def is_fulfilled(self) -> bool:
        """Look once more."""
        ...


class AtPlace:
    """An object, or one just like it, rests at its place."""

    def __init__(self, looker: Looker, part: Part, target: Location) -> None:
        self._looker, self._part, self._target = looker, part, target

    def is_fulfilled(self) -> bool:
        image = self._looker.look_at_table()
        if image is None:
            return False
        return self._looker.senses.recognize_at(image, self._part, self._target)


class InReach:
    """An object rests, standing, where the arm can lift it amid all that is seen."""

    def __init__(self, looker: Looker, part: Part) -> None:
        self._looker, self._part = looker, part
        self._before: HeadSighting | None = None
        self._barred: Sequence[_Spot] = ()

    def is_fulfilled(self) -> bool:
        if not can_grasp(self._part, self._looker.arm.body.gripper):
            return False
        senses, image = self._looker.senses, self._looker.look_at_table()
        if image is None:
            return False
        before, self._before = self._before, senses.sight(self._part, image)
        now = self._before
        if before is None or now is None or not now.upright(senses.catalogue.table.height):
            return False
        moved_m = math.dist((now.x, now.y, now.z), (before.x, before.y, before.z))
        if moved_m > _RESTS_WITHIN_M:
            return False
        return self._can_lift(now, others(self._part, senses.seen_boxes(image)))

    def _can_lift(self, at: HeadSighting, around: Sequence[SeenBox]) -> bool:
        """Whether there is a plan for that; where there was none, only once something has moved."""
        spots = [(None, at.x, at.y, at.z), *((e.name, e.x, e.y, e.top_z) for e in around)]
        if _alike(spots, self._barred):
            return False
        body, table = self._looker.arm.body, self._looker.senses.catalogue.table
        errand = Errand(lifting, self._part, Location(x=at.x, y=at.y, z=at.z, yaw=at.yaw), None)
        plan = at_once(plan_amid(errand, body, table, around))
        self._barred = () if isinstance(plan, Plan) else spots
        return isinstance(plan, Plan)


def _alike(spots: Sequence[_Spot], before: Sequence[_Spot]) -> bool:
    """Whether the same things stand where they stood before."""
    return len(spots) == len(before) and all(
        one[0] == other[0] and math.dist(one[1:], other[1:]) <= _RESTS_WITHIN_M
        for one, other in zip(spots, before, strict=True)
    )


class WayClear:
    """Nothing hinders the arm or is where it has to go, object and place are free."""

    def __init__(self, looker: Looker) -> None:
        self._looker = looker

    def is_fulfilled(self) -> bool:
        senses, way, arm = self._looker.senses, self._looker.way, self._looker.arm
        here, body = arm.tool_pose(), arm.body
        pressed_n = body.contact_force_n()
        if here is not None and way:
            pressed_n = hindering_n(body.contact_force(), here, way[0])
        if pressed_n > _CLEAR_FORCE_N:
            return False
        if here is not None and not arm.at_neutral:
            way = [here, *way]
        image = self._looker.look_at_table()
        if image is None:
            return False
        part, target = self._looker.destination or (None, None)
        before = self._looker.obstruction
        if before is not None and senses.shows_anything(image, before.position, but=part):
            return False
        if senses.obstruction(image, way, part) is not None:
            return False
        if part is None:
            return True
        sighting = None if senses.holds(part.name) else senses.sight(part, image)
        return senses.occupant(image, part, sighting, target) is None


class ViewClear:
    """The head camera shows the table."""

    def __init__(self, looker: Looker) -> None:
        self._looker = looker

    def is_fulfilled(self) -> bool:
        return self._looker.look_at_table() is not None


def look_as_told(
    looker: Looker, command: str, look: Look, understanding: Understanding
) -> Routine[Looked]:
    """The routine of a `look` command. Raises `CommandError`."""
    if look.expect is None:
        return look_once(looker, command)
    if look.expect not in ("way_clear", "view_clear"):
        looker.senses.want(understanding.object_of(look))
    if look.expect == "in_gripper":
        part = understanding.object_of(look)
        return take_from_person(looker, command, part, look.within_s)
    make: dict[str, Callable[[], Expectation]] = {
        "at_place": lambda: AtPlace(
            looker, understanding.object_of(look), understanding.place_of(look)
        ),
        "in_reach": lambda: InReach(looker, understanding.object_of(look)),
        "way_clear": lambda: WayClear(looker),
        "view_clear": lambda: ViewClear(looker),
    }
    return look_until(looker, command, make[look.expect](), look.within_s)


def look_once(looker: Looker, command: str) -> Routine[Looked]:
    """One look at everything."""
    yield from looker.free_view()
    return (yield from looker.answer_and_judge(command, None))


def look_until(
    looker: Looker, command: str, expectation: Expectation, within_s: float
) -> Routine[Looked]:
    """Look every half second until it is so or `within_s` have passed."""
    yield from looker.free_view()
    end_s = looker.arm.body.time_s() + within_s
    while True:
        left_s = end_s - looker.arm.body.time_s()
        if left_s <= LOOK_PERIOD_S:
            # That nothing changes is not enough to say that it is not so.
            looker.senses.doubt()
        fulfilled = expectation.is_fulfilled()
        if fulfilled or left_s <= 1e-9:
            return (yield from looker.answer_and_judge(command, fulfilled))
        yield from looker.arm.wait(min(LOOK_PERIOD_S, left_s))


def take_from_person(looker: Looker, command: str, part: Part, within_s: float) -> Routine[Looked]:
    """Go to the hand-over pose and close the gripper on what is held between its fingers."""
    arm, senses = looker.arm, looker.senses
    end_s = arm.body.time_s() + within_s
    if not can_grasp(part, arm.body.gripper):
        return looker.answer(command, fulfilled=False)
    if not senses.holds(part.name):
        senses.let_go()
        yield from arm.go_to_hand_over()
        yield from arm.open_gripper()
    looker.report(Holding(execution=looker.execution, at="hand_over"))
    while not senses.holds(part.name):
        offered = yield from _wait_until_offered(looker, part, end_s)
        if not offered:
            return looker.answer(command, fulfilled=False)
        yield from arm.close_gripper()
        senses.watch_grip(part)
        yield from _judge_grip(looker)
        if not senses.holds(part.name):
            senses.let_go()
            yield from arm.open_gripper()
    return looker.answer(command, fulfilled=True)


def _wait_until_offered(looker: Looker, part: Part, end_s: float) -> Routine[bool]:
    """Watch until the part is held still between the fingers, or it is time to close and feel."""
    watch = looker.senses.new_watch(part)
    period_s = looker.senses.forearm_period_s
    needed = max(3, math.ceil(_STEADY_S / period_s))
    shown, begin_s = 0, looker.arm.body.time_s()
    while looker.arm.body.time_s() < end_s - 1e-9:
        seen = looker.senses.measure_grip(watch).composition
        shown = shown + 1 if seen is not None and likeliest(seen) == "right" else 0
        blind = seen is None and looker.arm.body.time_s() - begin_s >= _TRY_EVERY_S
        if shown >= needed or blind:
            return True
        yield from looker.arm.wait(period_s)
    return False


def _judge_grip(looker: Looker) -> Routine[None]:
    for _ in range(_MOST_READINGS):
        reading = looker.senses.read_grip()
        if reading is None or reading.state is not GripState.UNDECIDED:
            return
        yield from looker.arm.wait(looker.senses.forearm_period_s)
