"""The outlook of an attempt, read off the state of its run: what follows if it fails."""

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from mend.dialogue.evidence import has_moved
from mend.dialogue.outlook import Next, Outlook, Sequel
from mend.dialogue.script import Expectation
from mend.dialogue.spoken import MOST_NAMES, bound_for
from mend.server.journal import events as ev
from mend.server.runtime.choosing import able_mask
from mend.server.runtime.dialogue_state import DialogueState
from mend.server.runtime.in_place import in_place_mask
from mend.server.runtime.parting import Parting
from mend.server.runtime.robot_proxy import RobotProxy
from mend.server.runtime.run_state import RunState
from mend.tasks.task_tree import TaskTree

_Deed = tuple[str, str | None]
"""What a leaf handles, or its own name, and the place that it fills."""


def outlook_at(
    state: RunState, proxy: RobotProxy, raised: ev.IssueRaised, most_helped: int
) -> Outlook:
    """The outlook when an issue is raised; its event is not folded yet.

    `most_helped`: to so many tries of one leaf a robot may be helped.
    """
    leaf = state.tree.index_of(raised.node)
    alike = [each for each in state.issues.get(leaf, ()) if each.issue == raised.issue]
    outlook = Outlook(
        attempt=state.tree.attempts(leaf) + 1,
        attempts=state.request.max_attempts,
        times=len(alike) + 1,
        unchanged=_unchanged(state, leaf, raised),
        helped_out=state.helped_retries[leaf] >= most_helped,
        alone=len(state.started.robots) == 1,
    )
    return outlook_now(state, proxy, leaf, outlook)


def outlook_now(
    state: RunState, proxy: RobotProxy, leaf: int, outlook: Outlook, *, begins_anew: bool = False
) -> Outlook:
    """An outlook with what follows as things are now: other robots may have gone on meanwhile."""
    return replace(
        outlook,
        failed=_sequel(state, proxy, leaf, failed=True),
        helped=_sequel(state, proxy, leaf, failed=False),
        begins_anew=begins_anew,
    )


def is_suspect(state: RunState, raised: ev.IssueRaised) -> bool:
    """Whether an issue looks like a false alarm: the same again, though nothing was seen wrong.

    What was seen itself is not doubted: things may go wrong again and again.
    """
    if raised.outlook is None or raised.outlook.unchanged < 2:
        return False
    leaf = state.tree.index_of(raised.node)
    previous = _previous(state, leaf, raised)
    before = None if previous is None else _dialogue_about(state, previous)
    felt = raised.detection is not None and raised.detection.felt
    looked = None if before is None else before.first_look
    # Who answers before the robot has looked once leaves it with what it saw before it tried again:
    # where it has begun, the object was there, and in its reach.
    begun = bool(raised.step) and raised.last_seen is not None
    right = begun if looked is None else bool(looked.fulfilled)
    return felt or (state.scripts[raised.issue].may_be_mistaken and right)


# --- The same issue again ----------------------------------------------------------------------


def _unchanged(state: RunState, leaf: int, raised: ev.IssueRaised) -> int:
    """How often on end this issue has come with nothing seen to change in between."""
    before = _previous(state, leaf, raised)
    if before is None or before.issue != raised.issue or before.outlook is None:
        return 1
    if _barred_between(before) != _barred_between(raised):
        return 1
    dialogue = _dialogue_about(state, before)
    if dialogue is None or (dialogue.resolved is not None and dialogue.resolved.helped):
        return 1
    looked = dialogue.first_look
    then = before.last_seen if looked is None or looked.blind else looked.position
    put_right = state.scripts[raised.issue].put_right
    by_itself = {Expectation.WAY_CLEAR, Expectation.VIEW_CLEAR, Expectation.LOCATED}
    about_the_part = not by_itself & set(put_right)
    if about_the_part and _is_elsewhere(then, raised.last_seen):
        return 1
    return before.outlook.unchanged + 1


def _previous(state: RunState, leaf: int, raised: ev.IssueRaised) -> ev.IssueRaised | None:
    """The last issue of a leaf before one, which may be folded already, that held the robot up."""
    issues = reversed(state.issues.get(leaf, []))
    return next((each for each in issues if each.interrupts and each is not raised), None)


def _barred_between(raised: ev.IssueRaised) -> list[str]:
    return [] if raised.detection is None else sorted(raised.detection.between)


def _is_elsewhere(
    then: tuple[float, float, float] | None, now: tuple[float, float, float] | None
) -> bool:
    if then is None or now is None:
        return then is not now
    return has_moved(then, now)


def _dialogue_about(state: RunState, raised: ev.IssueRaised) -> DialogueState | None:
    return next(
        (each for each in reversed(state.dialogues.values()) if each.raised is raised), None
    )


# --- What follows ------------------------------------------------------------------------------


def _sequel(state: RunState, proxy: RobotProxy, leaf: int, *, failed: bool) -> Sequel:
    """What the run does next once an active leaf is put back."""
    tree = state.tree.copy()
    tree.running = True
    if not tree.active(leaf):
        return Sequel()
    tree.put_back(leaf, failed=failed)
    if failed and tree.attempts(leaf) >= state.request.max_attempts:
        return _after_giving_up(tree, leaf)
    return _before_the_next_try(state, proxy, tree, leaf, failed=failed)


def _after_giving_up(tree: TaskTree, leaf: int) -> Sequel:
    given_up = tree.give_up(leaf)
    if given_up is None:
        return Sequel(Next.RUN_FAILS)
    for each in given_up.put_back:
        tree.put_back(each, failed=False)
    tree.abandon(given_up.alternative)
    goal = tree.parent_of(given_up.alternative)
    assert goal is not None, "an alternative has an OR above it"
    leaves = tree.eligible_leaves()
    begin, end = leaves.searchsorted((goal, tree.end_of(goal)))
    return Sequel(Next.INSTEAD, _names(tree, leaf, leaves[begin:end]))


def _before_the_next_try(
    state: RunState, proxy: RobotProxy, tree: TaskTree, leaf: int, *, failed: bool
) -> Sequel:
    """Leaves with fewer failed attempts go first; alternatives may keep it from being tried.

    Where as many have failed elsewhere, too, that may come first, and be the end of it.
    """
    leaves = tree.eligible_leaves()
    able = leaves[able_mask(state, proxy, leaves)]
    in_place = able[in_place_mask(state, tree, proxy.seen, able)]
    others = able[able != leaf]
    attempts, mine = tree.attempts_of(others), tree.attempts(leaf)
    parting = Parting(tree, leaf, others)
    rivals = parting.at_or
    if (done := np.isin(others, in_place) & rivals).any() and leaf not in in_place:
        return Sequel(Next.INSTEAD, _names(tree, leaf, others[done]))
    first = ~rivals & (attempts < mine)
    sooner = rivals & (attempts < mine)
    if sooner.any():
        # What else belongs to this alternative may be nearer, and decide for it.
        open_still = first.any() and parting.height[first].min() < parting.height[sooner].max()
        return Sequel(
            Next.EITHER if open_still else Next.INSTEAD, _names(tree, leaf, others[sooner])
        )
    as_soon = rivals & (attempts == mine)
    if as_soon.any():
        return Sequel(Next.EITHER, _names(tree, leaf, others[as_soon]))
    if first.any():
        return Sequel(Next.OTHERS_FIRST, _names(tree, leaf, others[first]))
    as_near = others[failed & (attempts == mine)]
    return Sequel(Next.ANY_OF, _names(tree, leaf, as_near)) if as_near.size else Sequel()


def _names(tree: TaskTree, leaf: int, leaves: NDArray[np.int64]) -> tuple[str, ...]:
    """What leaves do, each thing once; by its place where that tells it from another one's."""
    deeds: dict[_Deed, None] = {}
    for each in leaves.tolist():
        deeds[_deed_of(tree, each)] = None
        if len(deeds) == MOST_NAMES:
            break
    handled = [what for what, _ in {*deeds, _deed_of(tree, leaf)}]
    return tuple(
        bound_for(what, place) if place is not None and handled.count(what) > 1 else what
        for what, place in deeds
    )


def _deed_of(tree: TaskTree, leaf: int) -> _Deed:
    handled = tree.nodes.text(leaf, "object")
    if handled is None:
        return tree.name_of(leaf), None
    return handled, tree.nodes.text(leaf, "place")
