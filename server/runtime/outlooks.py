"""The outlook of an attempt, read off the state of its run: what follows if it fails."""

from dataclasses import replace

import numpy as np

from dialogue.evidence import has_moved
from dialogue.outlook import Next, Outlook, Sequel
from dialogue.script import Expectation
from server.journal import events as ev
from server.runtime.choosing import able_mask
from server.runtime.robot_side import RobotSide
from server.runtime.run_state import DialogueState, RunState
from tasks.definition import NodeKind
from tasks.task_tree import TaskTree


def outlook_at(
    state: RunState, side: RobotSide, raised: ev.IssueRaised, most_helped: int
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
    return outlook_now(state, side, leaf, outlook)


def outlook_now(
    state: RunState, side: RobotSide, leaf: int, outlook: Outlook, *, begins_anew: bool = False
) -> Outlook:
    """An outlook with what follows as things are now: other robots may have gone on meanwhile."""
    return replace(
        outlook,
        failed=_sequel(state, side, leaf, failed=True),
        helped=_sequel(state, side, leaf, failed=False),
        begins_anew=begins_anew,
    )


def is_suspect(state: RunState, raised: ev.IssueRaised) -> bool:
    """Whether an issue looks like a false alarm: the same again, though nothing was seen wrong.

    What was seen itself is not doubted: things may go wrong again and again.
    """
    if raised.outlook is None or raised.outlook.unchanged < 2:
        return False
    leaf = state.tree.index_of(raised.node)
    before = _dialogue_about(state, state.issues[leaf][-1])
    felt = raised.detection is not None and raised.detection.felt
    looked = None if before is None else before.first_look
    judged = state.scripts[raised.issue].may_be_mistaken
    return felt or (judged and looked is not None and bool(looked.fulfilled))


# --- The same issue again ----------------------------------------------------------------------


def _unchanged(state: RunState, leaf: int, raised: ev.IssueRaised) -> int:
    """How often on end this issue has come with nothing seen to change in between."""
    before = next((each for each in reversed(state.issues.get(leaf, [])) if each.interrupts), None)
    if before is None or before.issue != raised.issue or before.outlook is None:
        return 1
    dialogue = _dialogue_about(state, before)
    if dialogue is None or (dialogue.resolved is not None and dialogue.resolved.helped):
        return 1
    looked = dialogue.first_look
    then = before.last_seen if looked is None or looked.blind else looked.position
    put_right = state.scripts[raised.issue].put_right
    about_the_part = not {Expectation.WAY_CLEAR, Expectation.VIEW_CLEAR} & set(put_right)
    if about_the_part and _is_elsewhere(then, raised.last_seen):
        return 1
    return before.outlook.unchanged + 1


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


def _sequel(state: RunState, side: RobotSide, leaf: int, *, failed: bool) -> Sequel:
    """What the run does next once an active leaf is put back."""
    tree = state.tree.copy()
    tree.running = True
    if not tree.active(leaf):
        return Sequel()
    tree.put_back(leaf, failed=failed)
    if failed and tree.attempts(leaf) >= state.request.max_attempts:
        return _after_giving_up(tree, leaf)
    return _before_the_next_try(state, side, tree, leaf, failed=failed)


def _after_giving_up(tree: TaskTree, leaf: int) -> Sequel:
    given_up = tree.give_up(leaf)
    if given_up is None:
        return Sequel(Next.RUN_FAILS)
    for each in given_up.put_back:
        tree.put_back(each, failed=False)
    tree.abandon(given_up.alternative)
    goal = tree.parent_of(given_up.alternative)
    assert goal is not None, "an alternative has an OR above it"
    under = tree.path_of(goal).rstrip("/") + "/"
    left = [int(each) for each in tree.eligible_leaves()]
    return Sequel(
        Next.INSTEAD, _names(tree, [e for e in left if tree.path_of(e).startswith(under)])
    )


def _before_the_next_try(
    state: RunState, side: RobotSide, tree: TaskTree, leaf: int, *, failed: bool
) -> Sequel:
    """Leaves with fewer failed attempts go first; alternatives may keep it from being tried.

    Where as many have failed elsewhere, too, that may come first, and be the end of it.
    """
    leaves = tree.eligible_leaves()
    able = leaves[able_mask(state, side, leaves)] if len(leaves) else np.empty(0, dtype=np.int64)
    others = [int(each) for each in able if int(each) != leaf]
    mine = tree.attempts(leaf)
    rivals = [each for each in others if _excludes(tree, each, leaf)]
    first = [each for each in others if tree.attempts(each) < mine and each not in rivals]
    if sooner := [each for each in rivals if tree.attempts(each) < mine]:
        # What else belongs to this alternative may be nearer, and decide for it.
        open_still = any(_excludes(tree, each, rival) for each in first for rival in sooner)
        return Sequel(Next.EITHER if open_still else Next.INSTEAD, _names(tree, sooner))
    if as_soon := [each for each in rivals if tree.attempts(each) == mine]:
        return Sequel(Next.EITHER, _names(tree, as_soon))
    if first:
        return Sequel(Next.OTHERS_FIRST, _names(tree, first))
    as_near = [each for each in others if failed and tree.attempts(each) == mine]
    return Sequel(Next.ANY_OF, _names(tree, as_near)) if as_near else Sequel()


def _excludes(tree: TaskTree, one: int, other: int) -> bool:
    """Whether two leaves lie under different alternatives of an OR."""
    above_one = _ancestors(tree, one)
    node = other
    while node not in above_one:
        parent = tree.parent_of(node)
        assert parent is not None, "all nodes are under the root"
        node = parent
    return tree.kind_of(node) is NodeKind.OR


def _ancestors(tree: TaskTree, node: int) -> set[int]:
    found: set[int] = set()
    above: int | None = node
    while above is not None:
        found.add(above)
        above = tree.parent_of(above)
    return found


def _names(tree: TaskTree, leaves: list[int]) -> tuple[str, ...]:
    return tuple(tree.leaf_definition(each).object or tree.name_of(each) for each in leaves[:4])
