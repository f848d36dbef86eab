"""Before the first step: what is seen and held, and the plan to walk that follows from it."""

from mend.errors import IllegalTransitionError
from mend.robots.arm.behaviors.backing_off import get_out_of_view
from mend.robots.arm.behaviors.elsewhere import require_where_it_was
from mend.robots.arm.behaviors.errand import errand_of
from mend.robots.arm.behaviors.findings import Findings, is_inexact
from mend.robots.arm.behaviors.grasp_choice import ways_to_grasp
from mend.robots.arm.behaviors.plan import make_plan
from mend.robots.arm.behaviors.planning import Plan
from mend.robots.arm.behaviors.put_down import put_down, set_down
from mend.robots.arm.behaviors.search import LOOK_AGAIN_S, feel_for_object, find_object, find_table
from mend.robots.arm.behaviors.watch import ArmWatch
from mend.robots.arm.behaviors.work import Work
from mend.robots.execution.phase import Phase
from mend.robots.execution.routine import Routine
from mend.robots.link.messages import Location
from mend.robots.vision.head import HeadSighting
from mend.robots.vision.presence import Presence, is_at


def prepare(work: Work, watch: ArmWatch) -> Routine[Plan | None]:
    """The plan to walk; None if there is nothing left to do. Raises `Interruption`."""
    progress = work.progress
    earlier, before = progress.plan, progress.seen.sighting
    progress.start_again()
    work.perception.head.want(work.assignment.part)
    held = yield from feel_for_object(work)
    progress.seen.carrying = held and _goes_on_carrying(work)
    if progress.seen.carrying:
        yield from _plan_with_it_held(work, watch)
    if not progress.seen.carrying:
        yield from _look_with_empty_hands(work, watch)
        if _is_in_place(work) and not _is_to_be_placed_better(work):
            return None
        if progress.felt is not None and _is_hidden(work, before):
            progress.plan = earlier
            watch.judge(progress.felt)
        yield from _plan_to_fetch_it(work, watch)
    hindered = progress.plan is None or progress.seen.obstruction is not None
    if hindered and progress.inexact and _is_in_place(work):
        # There is no way to place it better.
        return None
    return _judged(work, watch)


def _plan_with_it_held(work: Work, watch: ArmWatch) -> Routine[None]:
    """Go on from where it is held; what cannot be placed as it is held is set down instead."""
    progress = work.progress
    yield from find_table(work)
    _require_sight(work, watch)
    progress.plan = yield from make_plan(work)
    refused = progress.plan is None and progress.seen.refusal is not None
    if refused and (yield from set_down(work.arm, work.perception, progress.picked_at)):
        # Held otherwise it may fit.
        progress.start_again()


def _look_with_empty_hands(work: Work, watch: ArmWatch) -> Routine[None]:
    yield from put_down(work.arm, work.perception, work.progress.picked_at)
    yield from get_out_of_view(work, watch)
    yield from find_object(work)
    _require_sight(work, watch)
    if not _is_in_place(work):
        require_where_it_was(work)


def _plan_to_fetch_it(work: Work, watch: ArmWatch) -> Routine[None]:
    """Plan for what is seen, twice if there is no way: what one picture shows may be wrong."""
    progress = work.progress
    progress.picked_at = None
    progress.plan = yield from make_plan(work)
    seen = progress.seen
    if seen.sighting is None or (progress.plan is not None and not seen.obstruction):
        return
    progress.start_again()
    work.perception.head.doubt()
    yield from work.arm.wait(LOOK_AGAIN_S)
    yield from find_object(work)
    _require_sight(work, watch)
    require_where_it_was(work)
    progress.plan = yield from make_plan(work)


def _judged(work: Work, watch: ArmWatch) -> Plan:
    """The plan, once the monitors have let it pass. Raises `Interruption`."""
    progress = work.progress
    watch.check(work.perception.read_grip() if progress.seen.carrying else None)
    if progress.felt is not None and progress.felt.tries >= len(watch.tries(Phase.PREPARE)):
        # Nothing that is seen explains it.
        watch.judge(progress.felt)
    if progress.plan is None:
        expected = f"a path for {work.assignment.behavior.name} or an issue"
        raise IllegalTransitionError("the execution", progress.state, "neither", expected)
    progress.picked_at = progress.plan.picked_at or progress.picked_at
    return progress.plan


def _require_sight(work: Work, watch: ArmWatch) -> None:
    """Raises `Interruption` where the head camera shows nothing of the table."""
    blind = work.progress.seen.blind
    if blind is not None:
        watch.check(None)
        expected = f"an issue, as {blind}"
        raise IllegalTransitionError("the execution", work.progress.state, "none", expected)


def _goes_on_carrying(work: Work) -> bool:
    """Whether the behavior has a step at which to go on with its object in the gripper."""
    assignment, perception = work.assignment, work.perception
    errand = errand_of(assignment, perception, Findings(carrying=True))
    table_z = perception.catalogue.table.height
    (situation, *_) = ways_to_grasp(errand, work.arm.body.gripper, table_z, ())
    steps = assignment.behavior.steps(assignment.parameters, situation)
    return assignment.behavior.first_carrying(steps) is not None


def _is_in_place(work: Work) -> bool:
    seen, perception = work.progress.seen, work.perception
    part, target = work.assignment.part, work.assignment.target
    if part is None or target is None or seen.image is None:
        return False
    if seen.sighting is not None and is_at(
        seen.sighting, part, target, perception.catalogue.height_of(target)
    ):
        return True
    # What is out of sight at its place since it was seen there needs nobody to fetch it.
    hidden = perception.head.presence(seen.image, part, target) is Presence.HIDDEN
    return work.progress.was_done == "there" and hidden


def _is_to_be_placed_better(work: Work) -> bool:
    """Whether what is at its place is too far off; what people put there on request is not."""
    progress, assignment = work.progress, work.assignment
    seen, part, target = progress.seen.sighting, assignment.part, assignment.target
    untouched = progress.as_found and progress.was_done is None
    if untouched and seen is not None and part is not None and target is not None:
        progress.inexact = is_inexact(seen, part, target)
    return progress.inexact


def _is_hidden(work: Work, before: HeadSighting | None) -> bool:
    """Whether something may hide the object where it was seen before."""
    part, seen = work.assignment.part, work.progress.seen
    if seen.sighting is not None or part is None or seen.image is None or before is None:
        return False
    where = Location(x=before.x, y=before.y, z=before.z, yaw=before.yaw)
    return work.perception.head.presence(seen.image, part, where) is Presence.HIDDEN
