"""What a look is compared with: with every one that was taken since the question was put."""

from collections.abc import Collection
from types import SimpleNamespace
from typing import Any
from uuid import UUID

import pytest

from mend.dialogue.evidence import Change, LookOutcome, PutRight
from mend.dialogue.script import Expectation, Help
from mend.robots.link.messages import Sighting
from mend.server.runtime.dialogue_looks import DialogueLooks

HERE, THERE = (0.5, 0.1), (0.5, 0.3)


def about_cup(
    *,
    blind: bool = False,
    brought: bool | None = None,
    promised_first: bool = False,
    denied: Collection[Expectation] = (),
    step: int = 4,
    last_seen: tuple[float, float] = HERE,
) -> Any:
    """A dialogue whose first look saw the cup within reach, or nothing at all."""
    raised = SimpleNamespace(
        object="cup",
        place=None,
        detection=None,
        interrupts=True,
        step=step,
        last_seen=(*last_seen, 0.7),
    )
    outcome = LookOutcome(frozenset({Expectation.IN_REACH}), (*HERE, 0.7), brought=brought)
    if blind:
        outcome = LookOutcome(frozenset(), None, blind=True)
    first = SimpleNamespace(
        fulfilled=sorted(outcome.fulfilled),
        position=outcome.position,
        blind=outcome.blind,
        outcome=outcome,
    )
    right = (Expectation.IN_REACH,)
    watched = SimpleNamespace(
        watched_for=right,
        puts_right=right,
        denied=frozenset(denied),
        contradictable=frozenset(denied),
    )
    return SimpleNamespace(
        id=UUID(int=1),
        raised=raised,
        first_look=first,
        promised_first=promised_first,
        looked_anew=None,
        conversation=watched,
    )


def watch(looks: DialogueLooks, dialogue: Any, proxy: Any) -> None:
    """A look meanwhile that puts nothing right."""
    assert looks.put_right(dialogue, proxy, fulfilled=False) is None
    if (undone := looks.undone(dialogue, proxy, fulfilled=False)) is not None:
        dialogue.looked_anew = SimpleNamespace(fulfilled=[], position=undone.position)


def seeing(at: tuple[float, float], *, blind: str | None = None) -> Any:
    cup = Sighting(x=at[0], y=at[1], z=0.7, yaw=0.0, time=1.0)
    return SimpleNamespace(
        seen={"cup": cup},
        there=frozenset(),
        held=None,
        blind=blind,
        led_round=False,
        brought=None,
    )


@pytest.mark.parametrize(
    ("by_and_by", "change"),
    [
        ([HERE], Change.NONE),
        ([THERE], Change.MOVED),
        # It was seen out of reach there, and was set upright there or brought back since.
        ([THERE, THERE], Change.MOVED),
        ([THERE, HERE], Change.MOVED),
    ],
)
def test_what_moved_since_the_question_has_moved_whenever_that_was(
    by_and_by: list[tuple[float, float]], change: Change
) -> None:
    context: Any = None
    looks, dialogue = DialogueLooks(context, None), about_cup()
    for at in by_and_by[:-1]:
        watch(looks, dialogue, seeing(at))
    assert looks.change_seen(dialogue, seeing(by_and_by[-1]), Help.PUT_BACK) is change


def test_a_first_look_in_the_dark_tells_of_no_place() -> None:
    context: Any = None
    first = DialogueLooks(context, None).first_look(
        about_cup(), seeing(HERE, blind="the picture is black"), fulfilled=False
    )
    assert first.blind
    assert first.position is None


def test_what_was_not_seen_when_it_was_dark_is_not_taken_for_moved_since() -> None:
    context: Any = None
    looks, dialogue = DialogueLooks(context, None), about_cup(blind=True)
    assert looks.change_seen(dialogue, seeing(THERE), Help.PUT_BACK) is Change.UNKNOWN
    assert looks.put_right(dialogue, seeing(THERE), fulfilled=True) is None


def test_once_the_camera_saw_again_what_it_saw_then_is_compared_with() -> None:
    context: Any = None
    looks, dialogue = DialogueLooks(context, None), about_cup(blind=True)
    assert looks.awaits_view(dialogue)
    dialogue.looked_anew = SimpleNamespace(fulfilled=[], position=None)
    assert not looks.awaits_view(dialogue)
    found = looks.put_right(dialogue, seeing(THERE), fulfilled=True)
    assert found == PutRight(Expectation.IN_REACH, Change.APPEARED)
    assert looks.change_seen(dialogue, seeing(THERE), Help.PUT_BACK) is Change.APPEARED


@pytest.mark.parametrize(
    ("known", "change"),
    [
        # It lay elsewhere as the arm drew back, or where it lies now, or that was not seen.
        ({"brought": True}, Change.APPEARED),
        ({"brought": False}, Change.NONE),
        ({"brought": None}, Change.NONE),
        ({"brought": False, "promised_first": True}, Change.NONE),
        ({"promised_first": True}, Change.UNKNOWN),
        # It was found nowhere, or seen out of reach, before the robot touched it.
        ({"promised_first": True, "denied": [Expectation.IN_REACH]}, Change.APPEARED),
        ({"promised_first": True, "step": 0, "last_seen": THERE}, Change.MOVED),
        ({"promised_first": True, "step": 0}, Change.NONE),
        ({"denied": [Expectation.IN_REACH]}, Change.NONE),
        ({"step": 0, "last_seen": THERE}, Change.NONE),
    ],
)
def test_help_before_the_first_look_is_told_by_what_was_known_before_it(
    known: dict[str, Any], change: Change
) -> None:
    context: Any = None
    dialogue = about_cup(**known)
    looks = DialogueLooks(context, None)
    assert looks.change_seen(dialogue, seeing(HERE), Help.PUT_BACK) is change
    # What changes later than that changes all the same.
    later = looks.change_seen(dialogue, seeing((0.3, 0.3)), Help.PUT_BACK)
    assert later.by_a_person


@pytest.mark.parametrize(
    ("brought", "right"),
    [(True, PutRight(Expectation.IN_REACH, Change.APPEARED)), (False, None), (None, None)],
)
def test_what_somebody_has_put_right_before_the_first_look_needs_no_answer(
    brought: bool | None, right: PutRight | None
) -> None:
    context: Any = None
    looks, dialogue, robot = DialogueLooks(context, None), about_cup(), seeing(HERE)
    robot.brought = brought
    first = looks.first_look(dialogue, robot, fulfilled=True)
    assert first.brought is brought
    assert looks.right_at_first(dialogue, first) == right


def test_darkness_meanwhile_is_nothing_to_compare_with() -> None:
    context: Any = None
    looks = DialogueLooks(context, None)
    dark = seeing(HERE, blind="the picture is black")
    assert looks.undone(about_cup(), dark, fulfilled=False) is None


@pytest.mark.parametrize(("said_at", "looked_at"), [(None, 12.0), (5.0, 5.0)])
def test_who_says_that_it_is_done_needs_no_more_time_for_it(
    said_at: float | None, looked_at: float
) -> None:
    context: Any = None
    dialogue = about_cup()
    dialogue.reported = None if said_at is None else SimpleNamespace(time=said_at)
    awaiting: Any = SimpleNamespace(help=Help.PUT_BACK, time=2.0, until=32.0)
    assert DialogueLooks(context, None).help_looked_for_from(dialogue, awaiting) == looked_at
