"""What may be said of a node, and why not, by example."""

from collections.abc import Iterator

import numpy as np
import pytest
from languages_of_console import untold
from trees import and_, node_called, or_, running_tree, then

from mend.tasks.autonomy import AutonomyLevel
from mend.tasks.steering import Hold, Steering, Word
from mend.tasks.steering_rules import Steered, SteeringAct, why_level_is_refused, why_refused
from mend.tasks.task_tree import TaskTree

ANN = Word("ann")


def steered(tree: TaskTree, **more: object) -> Steered:
    return Steered(tree, Steering(tree), **more)  # type: ignore[arg-type]


def why(about: Steered, act: str, name: str) -> str | None:
    return why_refused(about, SteeringAct(act), node_called(about.tree, name))


def held(about: Steered) -> list[str]:
    leaves = about.tree.eligible_leaves()
    mask = about.steering.held_mask(leaves, about.again)
    one_by_one = [about.steering.hold_on(int(each), about.again) is not None for each in leaves]
    assert mask.tolist() == one_by_one
    return [about.tree.name_of(int(each)) for each in leaves[np.flatnonzero(mask)]]


@pytest.mark.parametrize("act", ["go_on", "do_next", "leave_out", "done_by_hand"])
def test_what_comes_later_in_a_then_waits_for_what_comes_first(act: str) -> None:
    about = steered(running_tree(then("a", and_("b", "c"))))
    assert why(about, act, "b") == "'a' comes before 'b': that has to be done first"


@pytest.mark.parametrize("act", ["do_next", "leave_out", "done_by_hand"])
def test_of_an_or_only_the_chosen_alternative_is_steered(act: str) -> None:
    about = steered(running_tree(or_("a", then("b", "c"))))
    about.tree.start(node_called(about.tree, "b"), "pr2")
    reason = "was chosen instead of 'a', and only one of the alternatives is done"
    assert why(about, act, "a") == f"'g2' {reason}"
    assert why(about, act, "b") == "'b' is being done by pr2: wait until it is done or put back"


def test_a_breakpoint_stands_before_what_has_not_begun() -> None:
    about = steered(running_tree(then("a", and_("b", "c"), "d")))
    tree, steering = about.tree, about.steering
    assert why(about, "set_breakpoint", "g2") is None
    steering.set_breakpoint(node_called(tree, "g2"), ANN)
    assert why(about, "set_breakpoint", "g2") == (
        "there is a breakpoint before 'g2' already, set by ann"
    )
    assert why(about, "remove_breakpoint", "d") == (
        "there is no breakpoint before 'd': nothing to remove"
    )
    tree.start(node_called(tree, "a"), "pr2")
    assert why(about, "set_breakpoint", "a") == (
        "'a' has begun already: set the breakpoint before what comes after it"
    )
    assert why(about, "set_breakpoint", "g0") == (
        "'g0' has begun already: set the breakpoint before one of the leaves under it"
    )
    tree.finish(node_called(tree, "a"))
    assert "is done already" in str(why(about, "set_breakpoint", "a"))


def test_a_breakpoint_before_a_goal_holds_until_its_first_leaf_has_begun() -> None:
    about = steered(running_tree(and_(and_("a", "b"), "c")))
    tree, steering = about.tree, about.steering
    above, a = node_called(tree, "g1"), node_called(tree, "a")
    steering.set_breakpoint(above, ANN)
    assert held(about) == ["a", "b"]
    assert steering.hold_on(a) == Hold(a, above)
    steering.release(a)
    assert held(about) == ["b"]
    tree.start(a, "pr2")
    steering.begun(a)
    assert held(about) == []
    tree.put_back(a, failed=True)
    assert held(about) == ["a", "b"]


def test_a_leaf_that_was_let_go_begins_once() -> None:
    about = steered(running_tree(and_("a", "b")))
    tree, steering = about.tree, about.steering
    a = node_called(tree, "a")
    assert why(about, "go_on", "a") == "nothing holds 'a' up: it begins by itself"
    steering.set_breakpoint(a, ANN)
    assert why(about, "go_on", "a") is None
    assert why(about, "do_next", "a") == "'a' waits to be let go: let it go on instead"
    steering.release(a)
    assert held(about) == []
    tree.start(a, "pr2")
    steering.begun(a)
    tree.put_back(a, failed=False)
    assert held(about) == ["a"]


def test_a_breakpoint_that_is_set_anew_holds_what_was_let_go() -> None:
    about = steered(running_tree(and_("a", "b")))
    about.steering.release(node_called(about.tree, "a"))
    about.steering.set_breakpoint(0, ANN)
    assert held(about) == ["a", "b"]


def test_levels_hold_leaves_by_what_they_need() -> None:
    about = steered(running_tree(and_("a", "b", "c")), again=[3])
    tree, steering = about.tree, about.steering
    tree.start(1, "pr2")
    tree.put_back(1, failed=True)
    found = {}
    for level in AutonomyLevel:
        steering.set_level(level)
        found[level] = held(about)
    assert found == {
        AutonomyLevel.OFF: ["a", "b", "c"],
        AutonomyLevel.LOW: ["a", "c"],
        AutonomyLevel.HIGH: [],
        AutonomyLevel.FULL: [],
    }
    assert why_level_is_refused(steering, AutonomyLevel.FULL) == "the level is 'full' already"


def test_what_has_not_failed_is_not_tried_again() -> None:
    about = steered(running_tree(and_("a", "b")))
    assert why(about, "try_again", "a") == ("'a' has not failed: there is nothing to try again")
    about.tree.start(1, "pr2")
    about.tree.put_back(1, failed=True)
    assert why(about, "try_again", "a") is None
    about.tree.try_again(1)
    assert about.tree.attempts(1) == 0


def test_what_was_left_out_is_tried_again_until_what_comes_after_it_has_begun() -> None:
    about = steered(running_tree(then("a", "b", "c")), left_out=[1])
    tree = about.tree
    tree.start(1, "ann")
    tree.finish(1)
    assert why(about, "try_again", "a") is None
    tree.start(2, "pr2")
    assert why(about, "try_again", "a") == (
        "'b' comes after 'a' and has begun: it is too late for that"
    )
    tree.finish(2)
    assert why(about, "try_again", "b") == (
        "'b' is done, and was not left out: there is nothing to try again"
    )


def test_an_alternative_that_was_given_up_is_taken_up_again_while_none_is_chosen() -> None:
    about = steered(running_tree(or_(then("a", or_("b", "c")), "d")))
    tree = about.tree
    tree.abandon(node_called(tree, "b"))
    tree.abandon(node_called(tree, "g1"))
    assert why(about, "do_next", "a") == (
        "'a' belongs to an alternative that was given up: let it be tried again first"
    )
    assert why(about, "try_again", "a") is None
    tree.try_again(node_called(tree, "a"))
    assert [tree.name_of(int(each)) for each in tree.eligible_leaves()] == ["a", "d"]
    assert tree.abandoned(node_called(tree, "b"))
    assert not tree.abandoned(node_called(tree, "c"))
    tree.abandon(node_called(tree, "g1"))
    tree.start(node_called(tree, "d"), "pr2")
    assert "'d' was chosen instead of 'a'" in str(why(about, "try_again", "a"))


def test_goal_nodes_take_breakpoints_alone() -> None:
    about = steered(running_tree(and_("a", "b")))
    assert [act for act in SteeringAct if why_refused(about, act, 0) is None] == ["set_breakpoint"]
    assert why(about, "leave_out", "g0") == ("'g0' is no leaf: choose one of the leaves under it")


def test_a_paused_run_takes_what_changes_nothing_in_its_tree() -> None:
    about = steered(running_tree(and_("a", "b")))
    about.tree.running = False
    assert why(about, "do_next", "a") is None
    assert why(about, "set_breakpoint", "a") is None
    assert why(about, "leave_out", "a") == "the run is paused: let it go on first"


def test_the_last_word_says_what_is_next() -> None:
    about = steered(running_tree(and_("a", "b")))
    steering = about.steering
    steering.prefer(1, ANN)
    assert why(about, "do_next", "a") == "'a' is next already, as ann has asked"
    steering.prefer(2, ANN)
    assert steering.preferred == 2
    assert why(about, "not_next", "a") == "nobody has asked for 'a' next"
    about.tree.start(2, "pr2")
    assert steering.preferred is None


def refused_of(about: Steered) -> Iterator[str]:
    for node in range(len(about.tree.nodes)):
        for act in SteeringAct:
            if (why := why_refused(about, act, node)) is not None:
                yield why


def test_every_refusal_is_in_the_languages_of_the_console() -> None:
    tree = running_tree(then("a", or_("b", "c"), and_("d", "e")))
    steering = Steering(tree)
    about = Steered(tree, steering)
    found = [*refused_of(about), str(why_level_is_refused(steering, steering.level))]
    steering.set_breakpoint(node_called(tree, "d"), ANN)
    steering.prefer(node_called(tree, "a"), ANN)
    for name in ("a", "b", "d"):
        tree.start(node_called(tree, name), "pr2")
        found += refused_of(about)
        tree.finish(node_called(tree, name))
        found += refused_of(about)
    tree.running = False
    found += refused_of(about)
    assert len(set(found)) > 40
    assert untold(sorted(set(found)), ["clauses", "refusals"]) == []
