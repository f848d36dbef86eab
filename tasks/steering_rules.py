"""What may be said of a node while its run goes on, and why not: the order of the tree decides."""

from collections.abc import Collection
from dataclasses import dataclass
from enum import StrEnum

from mend.tasks.autonomy import AutonomyLevel
from mend.tasks.definition import NodeKind
from mend.tasks.steering import Steering
from mend.tasks.task_tree import TaskTree


class SteeringAct(StrEnum):
    """What people may say of a node."""

    GO_ON = "go_on"
    """Begin a leaf that waits to be let go, once."""
    SET_BREAKPOINT = "set_breakpoint"
    """Wait before a leaf, or before the first one under a goal node."""
    REMOVE_BREAKPOINT = "remove_breakpoint"
    DO_NEXT = "do_next"
    """Begin a leaf before all others whose turn has come."""
    NOT_NEXT = "not_next"
    """Choose as ever after all."""
    TRY_AGAIN = "try_again"
    """Do a leaf that has failed, was left out or given up, as if it were new."""
    LEAVE_OUT = "leave_out"
    """Count a leaf as done without its being there."""
    DONE_BY_HAND = "done_by_hand"
    """Somebody has done a leaf: it is done once a robot sees it."""


@dataclass(frozen=True, slots=True)
class Steered:
    """What it depends on what may be said. `again`: the leaves that were done before."""

    tree: TaskTree
    steering: Steering
    left_out: Collection[int] = ()
    again: Collection[int] = ()
    gone_too_often: Collection[int] = ()


def why_refused(about: Steered, act: SteeringAct, node: int) -> str | None:
    """Why something cannot be said of a node now, and what would be right; None if it can."""
    tree, steering = about.tree, about.steering
    name = f"'{tree.name_of(node)}'"
    match act:
        case SteeringAct.SET_BREAKPOINT:
            return _no_breakpoint(tree, steering, node)
        case SteeringAct.REMOVE_BREAKPOINT:
            there = node in steering.breakpoints
            return None if there else f"there is no breakpoint before {name}: nothing to remove"
        case SteeringAct.NOT_NEXT:
            preferred = steering.next is not None and steering.next[0] == node
            return None if preferred else f"nobody has asked for {name} next"
    if tree.kind_of(node) is not NodeKind.BEHAVIOR:
        return f"{name} is no leaf: choose one of the leaves under it"
    if act is SteeringAct.TRY_AGAIN:
        return _not_again(about, node)
    if (why := why_not_its_turn(tree, node)) is not None:
        return why
    if act is SteeringAct.GO_ON:
        held = steering.hold_on(node, about.again)
        return f"nothing holds {name} up: it begins by itself" if held is None else None
    if act is SteeringAct.DO_NEXT:
        return _not_next(about, node)
    return None if tree.running else "the run is paused: let it go on first"


def why_level_is_refused(steering: Steering, level: AutonomyLevel) -> str | None:
    """Why a level cannot be set; None if it can."""
    return f"the level is '{level}' already" if steering.level is level else None


def why_not_its_turn(tree: TaskTree, leaf: int) -> str | None:
    """Why a leaf may not begin in the order of the tree, and what has to be first; None if it may.

    Whether the run is paused makes no difference.
    """
    name = f"'{tree.name_of(leaf)}'"
    if tree.done(leaf):
        return f"{name} is done already"
    if (owner := tree.owner(leaf)) is not None:
        return f"{name} is being done by {owner}: wait until it is done or put back"
    if tree.abandoned(leaf):
        return f"{name} belongs to an alternative that was given up: let it be tried again first"
    node: int | None = leaf
    while node is not None:
        if (first := tree.comes_first(node)) is not None:
            return f"'{tree.name_of(first)}' comes before {name}: that has to be done first"
        if (instead := _chosen_instead(tree, node)) is not None:
            return (
                f"'{tree.name_of(instead)}' was chosen instead of {name}, and only one of the "
                "alternatives is done"
            )
        node = tree.parent_of(node)
    return None


def _chosen_instead(tree: TaskTree, node: int) -> int | None:
    parent = tree.parent_of(node)
    if parent is None or tree.kind_of(parent) is not NodeKind.OR:
        return None
    committed = tree.committed(parent)
    return None if committed in (None, node) else committed


MOST_BREAKPOINTS = 100
"""Each is gone through at every choice of a robot."""


def _no_breakpoint(tree: TaskTree, steering: Steering, node: int) -> str | None:
    name = f"'{tree.name_of(node)}'"
    if len(steering.breakpoints) >= MOST_BREAKPOINTS and node not in steering.breakpoints:
        return f"there are {MOST_BREAKPOINTS} breakpoints already: remove one of them first"
    if node in steering.breakpoints:
        return (
            f"there is a breakpoint before {name} already, set by {steering.breakpoints[node].by}"
        )
    if tree.done(node):
        return f"{name} is done already: a breakpoint stands before what is still to begin"
    if tree.touched(node):
        instead = (
            "one of the leaves under it"
            if tree.kind_of(node) is not NodeKind.BEHAVIOR
            else ("what comes after it")
        )
        return f"{name} has begun already: set the breakpoint before {instead}"
    if tree.abandoned(node):
        return f"{name} was given up: nothing would ever wait before it"
    return None


def _not_next(about: Steered, leaf: int) -> str | None:
    tree, steering = about.tree, about.steering
    if steering.next is not None and steering.next[0] == leaf:
        return f"'{tree.name_of(leaf)}' is next already, as {steering.next[1].by} has asked"
    if steering.hold_on(leaf, about.again) is not None:
        return f"'{tree.name_of(leaf)}' waits to be let go: let it go on instead"
    return None


def _not_again(about: Steered, leaf: int) -> str | None:
    tree = about.tree
    name = f"'{tree.name_of(leaf)}'"
    if (owner := tree.owner(leaf)) is not None:
        return f"{name} is being done by {owner}: wait until it is done or put back"
    if tree.done(leaf):
        return _not_put_in(about, leaf)
    if tree.abandoned(leaf):
        # Whatever is committed now stays so: an alternative is no alternative any more.
        return _why_not_reopened(tree, leaf)
    if tree.attempts(leaf) == 0 and leaf not in about.gone_too_often:
        return f"{name} has not failed: there is nothing to try again"
    return None


def _not_put_in(about: Steered, leaf: int) -> str | None:
    """Why what counts as done cannot be tried again."""
    tree = about.tree
    name = f"'{tree.name_of(leaf)}'"
    if leaf not in about.left_out:
        return f"{name} is done, and was not left out: there is nothing to try again"
    found = tree.what_to_take_back(leaf)
    after = next(iter((*found.put_back, *reversed(found.taken_back[:-1]))), None)
    if after is not None:
        return f"'{tree.name_of(after)}' comes after {name} and has begun: it is too late for that"
    return None


def _why_not_reopened(tree: TaskTree, leaf: int) -> str | None:
    node: int | None = leaf
    while node is not None:
        if (instead := _chosen_instead(tree, node)) is not None:
            return (
                f"'{tree.name_of(instead)}' was chosen instead of '{tree.name_of(leaf)}', and only "
                "one of the alternatives is done"
            )
        node = tree.parent_of(node)
    return None
