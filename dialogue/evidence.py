"""What puts an issue right: the rule by which what is seen counts, and when a person is thanked.

The robot asks, and looks at once (the first look). A later look puts the issue right only if

- something that the script watches for is so now and was not so at the first look, or
- it is so now, and the object was seen to move since.

A state that was already so when the question was put tells nothing: a part that the robot has only
failed to hold is within its reach all the time. What the issue itself says not to be so (a missing
part within reach, a seen obstruction gone) is new even if it is so at the first look; but then the
robot may well have been wrong before, so that nobody is thanked for it who has not promised it
before that look. What a basket or a battery feels, and who stands near, it is not wrong about. What
was felt in its way is never put right by a camera: it takes a person's word and a look.

People may be quicker than the first look. What the robot knew before it is compared with as well:
whether it saw, as it drew back, that what its fingers had lost was not where it is at the first
look; and, where help was promised before that look, what the issue says not to be so, and where the
object was last seen if the robot had not begun to handle it. Where it knows none of these it cannot
say whether anybody has helped.

A camera may come to see again by itself, what it took for something in the way may be gone by
itself, and a robot may find out by itself where it is, so that nobody is thanked for any of these
who has not promised or told it.

Another way that leads round puts it right, also where the first look finds it; nobody has helped.

A person has helped if a change was seen that only a person can have made: the object appeared,
moved, or came between the fingers, the basket got heavier or lighter as was asked, current
came, who is escorted came near, or what was in the way is gone. A promise alone is not help, nor
is a look that sees no more than the first one did.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from enum import StrEnum

from mend.dialogue.script import Expectation

MOVED_M = 0.02
"""An object that is seen this far from where it was has been moved; cameras err by less."""

RAISED_M = 0.012
"""One that is seen so much higher or lower has toppled or was set upright; heights err by less."""

_BY_ITSELF = (Expectation.VIEW_CLEAR, Expectation.WAY_CLEAR, Expectation.LOCATED)

Point = tuple[float, float, float]


class Change(StrEnum):
    """What was seen to change since the question was put."""

    UNKNOWN = "unknown"
    """Nothing was seen before, so that nothing can be compared."""
    NONE = "none"
    APPEARED = "appeared"
    """The object was not to be seen, and now is."""
    MOVED = "moved"
    TOLD = "told"
    """Somebody said where the robot is, and what it sees agrees."""
    HANDED_OVER = "handed_over"
    """The object came between the fingers."""
    CLEARED = "cleared"
    """What was in the way, or hid the table from the camera, is gone."""
    LOADED = "loaded"
    """Something was put into the basket that was to be put in."""
    UNLOADED = "unloaded"
    """Something was taken out of the basket that was to be taken out."""
    CHARGED = "charged"
    """The robot was plugged in."""
    LED_ROUND = "led_round"
    """What is in the way still is, but another way leads round."""
    CAME = "came"
    """Whom the robot escorts has come to it."""

    @property
    def by_a_person(self) -> bool:
        """Whether only a person can have made it."""
        return self not in (Change.UNKNOWN, Change.NONE, Change.LED_ROUND)


_FELT = {
    Expectation.LOADED: Change.LOADED,
    Expectation.UNLOADED: Change.UNLOADED,
    Expectation.CHARGED: Change.CHARGED,
    Expectation.ACCOMPANIED: Change.CAME,
}


@dataclass(frozen=True, slots=True)
class LookOutcome:
    """What one look saw: what is so of what matters, and where the object is (None: unseen).

    `blind`: the camera showed nothing of the table, so that the look tells of nothing there.
    `brought`: whether the object was seen before not to be where it is now; None if that was not.
    """

    fulfilled: frozenset[Expectation]
    position: Point | None
    blind: bool = False
    brought: bool | None = None


NOWHERE = LookOutcome(frozenset(), None)
"""What sees the object nowhere, or not where it matters, and nothing of what does."""


@dataclass(frozen=True, slots=True)
class PutRight:
    """The issue is put right: by what is so now, and what was seen to change."""

    seen: Expectation
    change: Change


def change_between(first: LookOutcome | None, now: LookOutcome) -> Change:
    """What a look sees changed since the first one."""
    if Expectation.LED_ROUND in now.fulfilled:
        return Change.LED_ROUND
    if first is None:
        return Change.UNKNOWN
    cleared = now.fulfilled - first.fulfilled
    if Expectation.VIEW_CLEAR in cleared:
        return Change.CLEARED
    if first.blind:
        return Change.UNKNOWN
    if Expectation.WAY_CLEAR in cleared:
        return Change.CLEARED
    for felt, change in _FELT.items():
        if felt in cleared:
            return change
    if now.position is None:
        return Change.NONE
    if first.position is None:
        return Change.APPEARED
    return Change.MOVED if has_moved(first.position, now.position) else Change.NONE


def change_since(looks: Sequence[LookOutcome], now: LookOutcome) -> Change:
    """What a look sees changed since the earlier ones, told by the first that it differs from.

    What has come back to where it was at one of them has moved all the same.
    """
    changes = [change_between(each, now) for each in looks]
    made = [each for each in changes if each.by_a_person]
    return next(iter([*made, *changes]), Change.UNKNOWN)


def known_when_raised(
    expected: Expectation, denied: frozenset[Expectation], untouched_at: Point | None
) -> LookOutcome | None:
    """What an issue tells of what was `expected` when it was raised; None if nothing.

    `untouched_at`: where the object was seen then, if the robot had not begun to handle it.
    """
    if expected in denied:
        return LookOutcome(frozenset(), None, blind=expected is Expectation.VIEW_CLEAR)
    return None if untouched_at is None else LookOutcome(frozenset(), untouched_at)


def known_before(first: LookOutcome) -> LookOutcome | None:
    """What was known before the first look of where the object then was; None if nothing."""
    if first.brought is None:
        return None
    return NOWHERE if first.brought else replace(first, brought=None)


def brought_before(watched: Sequence[Expectation], first: LookOutcome) -> PutRight | None:
    """What is right at the first look, of an object that was seen not to be there before it."""
    return put_right(watched, NOWHERE, first) if first.brought else None


def put_right(
    watched: Sequence[Expectation], first: LookOutcome, now: LookOutcome
) -> PutRight | None:
    """What has put an issue right since the first look; `watched`: the most telling first."""
    if Expectation.LED_ROUND in (now.fulfilled - first.fulfilled).intersection(watched):
        return PutRight(Expectation.LED_ROUND, Change.LED_ROUND)
    change = change_between(first, now)
    moved = change in (Change.APPEARED, Change.MOVED)
    for each in watched:
        if each not in now.fulfilled:
            continue
        if each in _BY_ITSELF and each not in first.fulfilled:
            return PutRight(each, Change.NONE)
        if each is not Expectation.VIEW_CLEAR and (moved or each not in first.fulfilled):
            return PutRight(each, change)
    return None


def contradiction(
    watched: Sequence[Expectation], denied: frozenset[Expectation], first: LookOutcome
) -> PutRight | None:
    """What the first look saw that the issue itself denies.

    The robot may have been wrong, but for what it felt: that somebody has changed since.
    """
    if Expectation.LED_ROUND in first.fulfilled.intersection(watched):
        return PutRight(Expectation.LED_ROUND, Change.LED_ROUND)
    for each in watched:
        if each in denied & first.fulfilled:
            return PutRight(each, _FELT.get(each, Change.NONE))
    return None


def has_moved(before: Point, now: Point) -> bool:
    """Whether an object is seen elsewhere than it was, or has toppled or been set upright there."""
    return math.dist(before, now) > MOVED_M or abs(before[2] - now[2]) > RAISED_M
