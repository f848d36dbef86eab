"""What a robot's sentences claim, and how each claim is compared with what was so."""

import re
from collections.abc import Callable, Sequence

from dialogue_record import RunRecord

from mend.server.journal import events as ev

AT_PLACE_M = 0.04
"""Where a robot may say that a part is at its place: what it takes for that, and its error."""

CLEARLY_AT_PLACE_M = 0.01
"""A part this near its place, at its height, must not be told not to be there."""

UNMOVED_M = 0.04
"""What is said to be where it was may be so far off: what is taken for that, and both errors."""

LONG_ENOUGH_S = 2.0
"""What has lain for so long must have been seen."""

TOPPLED_RAD = 0.5
"""Only what leans more than this may have toppled."""

Check = Callable[[RunRecord, int, ev.Prompt, re.Match[str]], str | None]


def _thanks(record: RunRecord, index: int, event: ev.Prompt, _: re.Match[str]) -> str | None:
    return None if any(True for _ in record.deeds(index, event)) else "nobody has done anything"


def _at_place(record: RunRecord, index: int, event: ev.Prompt, _: re.Match[str]) -> str | None:
    off_m = max(record.offset(index, event.node, event.object))
    return None if off_m <= AT_PLACE_M else f"it is {off_m:.3f} m off"


def _there_already(record: RunRecord, index: int, _: ev.Prompt, said: re.Match[str]) -> str | None:
    off_m = record.offset_of_alternative(index, said[1], said[2])
    return None if off_m <= AT_PLACE_M else f"it is {off_m:.3f} m off"


def _not_at_place(record: RunRecord, index: int, event: ev.Prompt, _: re.Match[str]) -> str | None:
    off_m = max(record.offset(index, event.node, event.object))
    moment = record.moment(index)
    hidden = moment.blocked or moment.dark or record.arm_holds_in_place(index, event.robot)
    return None if off_m > CLEARLY_AT_PLACE_M or hidden else "it is there"


def _somewhere(record: RunRecord, index: int, event: ev.Prompt, _: re.Match[str]) -> str | None:
    return None if record.rests(index, event.object) else "it is not on the table"


def _nowhere(record: RunRecord, _: int, event: ev.Prompt, __: re.Match[str]) -> str | None:
    index = record.raised_at(event.node)
    moment = record.moment(index)
    # Of equal parts any may be the one that is gone.
    gone = any(moment.resting.get(each) is None for each in record.equals(event.object))
    hidden = moment.blocked or record.may_be_hidden(index, event.object, event.robot)
    return None if gone or hidden else "it lies on the table"


def _not_held(record: RunRecord, _: int, event: ev.Prompt, __: re.Match[str]) -> str | None:
    return (
        "the fingers hold it" if record.holds(record.at_issue(event.node), event.object) else None
    )


def _held(record: RunRecord, index: int, event: ev.Prompt, _: re.Match[str]) -> str | None:
    return (
        None if record.holds(record.moment(index), event.object) else "the fingers do not hold it"
    )


def _in_the_way(record: RunRecord, _: int, event: ev.Prompt, said: re.Match[str]) -> str | None:
    named = _part_named(record, event, said[1])
    if named is not None:
        there = record.stands_by(event.node, event.object or "", named)
        return None if there else f"{named} stands nowhere near its way"
    there = record.at_issue(event.node).blocked or record.crowded(event.node, event.object)
    covered = record.buried(record.raised_at(event.node), event.object)
    return None if there or covered else "nothing is in its way"


def _part_named(record: RunRecord, event: ev.Prompt, said: str | None) -> str | None:
    spoken = (said or "").lower()
    parts = record.at_issue(event.node).resting
    return next((each for each in parts if each.replace("_", " ").lower() == spoken), None)


def _held_up(record: RunRecord, _: int, event: ev.Prompt, __: re.Match[str]) -> str | None:
    # The arm may also be held up by parts that it runs into.
    there = record.at_issue(event.node).blocked or record.crowded(event.node, event.object)
    return None if there else "nothing held it up"


def _not_held_yet(record: RunRecord, index: int, event: ev.Prompt, _: re.Match[str]) -> str | None:
    return "the fingers hold it" if record.holds(record.moment(index), event.object) else None


def _handed_another(
    record: RunRecord, index: int, event: ev.Prompt, _: re.Match[str]
) -> str | None:
    since = record.since_opened(index, event)
    handed = [each for each in since if isinstance(each, ev.InterventionDone) and each.ok]
    another = any(each.act == "hand_over" and each.object != event.object for each in handed)
    return None if another else "nothing else was handed over"


def _not_in_reach(record: RunRecord, index: int, event: ev.Prompt, _: re.Match[str]) -> str | None:
    """What lies in the open, and not only since a moment ago, must not be told not to be there."""
    moment = record.moment(index)
    if moment.blocked or moment.dark or record.may_be_hidden(index, event.object, event.robot):
        return None
    if not record.is_surely_in_reach(index, event.object):
        return None
    return "it lies there" if record.lay_for_s(index, event.object) >= LONG_ENOUGH_S else None


def _not_seen_at_all(
    record: RunRecord, index: int, event: ev.Prompt, _: re.Match[str]
) -> str | None:
    moment = record.moment(index)
    if moment.blocked or moment.dark or record.may_be_hidden(index, event.object, event.robot):
        return None
    # Another one that looks the same may be taken for it.
    if len(record.equals(event.object)) > 1:
        return None
    return "it lies there" if record.lay_for_s(index, event.object) >= LONG_ENOUGH_S else None


def _where_it_was(record: RunRecord, index: int, event: ev.Prompt, _: re.Match[str]) -> str | None:
    if not record.rests(index, event.object):
        return "it is not on the table"
    moved_m = record.moved_since_first_look_m(index, event)
    return None if moved_m <= UNMOVED_M else f"it has moved by {moved_m:.3f} m"


def _toppled(record: RunRecord, _: int, event: ev.Prompt, __: re.Match[str]) -> str | None:
    rest = record.at_issue(event.node).resting.get(event.object or "")
    return None if rest is None or rest.lean_rad > TOPPLED_RAD else "it stands"


def _not_free(record: RunRecord, index: int, event: ev.Prompt, _: re.Match[str]) -> str | None:
    there = record.moment(index).blocked or record.crowded(event.node, event.object, index)
    return None if there else "nothing is in its way"


def _nobody_answered(
    record: RunRecord, index: int, event: ev.Prompt, _: re.Match[str]
) -> str | None:
    return "somebody has answered" if record.answered_last(index, event) else None


def _attempt_now(
    record: RunRecord, index: int, event: ev.Prompt, said: re.Match[str]
) -> str | None:
    failed = record.failed_before(index, event.node)
    return None if int(said[1]) == failed + 1 else f"{failed} attempts have failed"


def _way_free(record: RunRecord, index: int, _: ev.Prompt, __: re.Match[str]) -> str | None:
    return "somebody stands in the way" if record.moment(index).blocked else None


def _dark_at_issue(record: RunRecord, _: int, event: ev.Prompt, __: re.Match[str]) -> str | None:
    return None if record.at_issue(event.node).dark else "nothing covers the camera"


def _dark(record: RunRecord, index: int, _: ev.Prompt, __: re.Match[str]) -> str | None:
    return None if record.moment(index).dark else "nothing covers the camera"


def _light(record: RunRecord, index: int, _: ev.Prompt, __: re.Match[str]) -> str | None:
    return "the camera is covered" if record.moment(index).dark else None


COUNTS = {"once": 1, "twice": 2} | {
    f"{word} times": number
    for number, word in enumerate(
        ("three", "four", "five", "six", "seven", "eight", "nine"), start=3
    )
}


def _so_often(record: RunRecord, index: int, event: ev.Prompt, said: re.Match[str]) -> str | None:
    times = COUNTS.get(said[1]) or int(said[1].split()[0])
    really = record.issues_so_far(index, event)
    return None if times == really else f"it happened {really} times"


def _next_try(record: RunRecord, index: int, event: ev.Prompt, said: re.Match[str]) -> str | None:
    if event.kind == "ask":
        return None
    failed = record.failed_before(index, event.node)
    ends = next(each for each in record.following(index) if isinstance(each, ev.DialogueClosed))
    now_failed = sum(
        isinstance(each, ev.NodeReset) and each.node == event.node and each.failed_attempt
        for each in record.following(index)[: record.following(index).index(ends) + 3]
    )
    if int(said[1]) != failed + now_failed + 1:
        return f"{failed + now_failed} attempts have failed"
    later = record.following(index)
    again = any(isinstance(each, ev.NodeStarted) and each.node == event.node for each in later)
    ended = isinstance(later[-1], ev.RunFailed) and later[-1].node != event.node
    dropped = any(isinstance(each, ev.NodeAbandoned) for each in later)
    instead = re.search(r"or I take (.*?) instead", event.text)
    replaced = instead is not None and any(_is_begun(record, each, instead[1]) for each in later)
    # Where what an alternative had done is seen gone another one may be nearer.
    undone = any(
        isinstance(each, ev.NodeUndone) and record.are_alternatives_above(event.node, each.node)
        for each in later
    )
    kept = again or ended or dropped or replaced or undone
    return None if kept else "it was never tried again"


def _is_begun(record: RunRecord, event: ev.Event, names: str) -> bool:
    """Whether one of the parts of a sentence is begun with; of "another part" any will do."""
    if not isinstance(event, ev.NodeStarted):
        return False
    begun = {event.name.replace("_", " "), *record.spoken_names(event.node)}
    return "another part" in names or not begun.isdisjoint(_named(names))


def _named(names: str) -> list[str]:
    return re.findall(r"the (\w[\w ]*?)(?=,| or |$)", names)


def _named_once(_: RunRecord, __: int, ___: ev.Prompt, said: re.Match[str]) -> str | None:
    named = _named(said[1])
    return None if len(named) == len(set(named)) else "one of them is named twice"


def _then_with(record: RunRecord, index: int, event: ev.Prompt, said: re.Match[str]) -> str | None:
    """What is to go first, or instead, is begun before the leaf is begun again."""
    if event.kind == "ask" or "another part" in said[1] or " or I take" in event.text:
        return None
    later = record.following(index)
    for number, each in enumerate(later):
        if isinstance(each, ev.NodeStarted) and each.node == event.node:
            # What a camera did not show may turn out to have been done.
            found = any(
                isinstance(next_, ev.NodeDone) and next_.node == event.node and next_.by == "found"
                for next_ in later[number + 1 : number + 2]
            )
            return None if found else "it was tried again before that"
        if _is_begun(record, each, said[1]):
            return None
    return None


def _ends(record: RunRecord, index: int, event: ev.Prompt, _: re.Match[str]) -> str | None:
    if event.kind == "ask":
        return None
    last = record.following(index)[-1]
    ended = isinstance(last, ev.RunFailed) and last.node == event.node
    return None if ended else "the task went on"


def _goes_on(record: RunRecord, index: int, event: ev.Prompt, _: re.Match[str]) -> str | None:
    for each in record.following(index):
        if isinstance(each, ev.NodeReset) and each.node == event.node:
            # Nothing is built on what is seen gone, whatever was about to go on.
            return None if "no longer done" in each.reason else "it was put back"
        if isinstance(each, ev.RobotResumed | ev.RobotLost):
            return None
        if isinstance(each, ev.NodeDone | ev.IssueRaised) and each.node == event.node:
            return None
    return None


def _left_out(record: RunRecord, index: int, event: ev.Prompt, _: re.Match[str]) -> str | None:
    if event.kind == "ask":
        return None
    later = record.following(index)[:3]
    told = any(isinstance(each, ev.NodeLeftOut) and each.node == event.node for each in later)
    return None if told else "it was not left out"


_NEXT = r"I (?:go on with|take) (.*?) (?:first|instead)"

CHECKS: Sequence[tuple[str, Check]] = (
    (r"Thank you", _thanks),
    (r"I see the .* at its place", _at_place),
    (r"I do not see the .* at its place yet|[Tt]he .* is not at its place", _not_at_place),
    (r"I see the (?!.* at its place)", _somewhere),
    (r"I cannot see what is on the table", _dark_at_issue),
    (r"I do not see what is on the table yet", _dark),
    (r"(?<!until )I see what is on the table", _light),
    (r"The (.*) is at the (.*) already, which does as well", _there_already),
    (r"What I was handed does not look like", _handed_another),
    (r"I do not see the .* where I can reach it yet", _not_in_reach),
    (r"I do not see it at all", _not_seen_at_all),
    (r"I see it where it was after I asked", _where_it_was),
    (r"I see it, but not there", _somewhere),
    (r"has toppled over", _toppled),
    (r"I cannot find the|cannot find it|I see it nowhere", _nowhere),
    (r"I missed the|I lost hold of|failed .* to (pick up|hold)", _not_held),
    (r"I have the .* between my fingers", _held),
    (r"I do not see the .* between my fingers", _not_held_yet),
    (
        r"I cannot go on with the [^.]*\.(?: (.*?) is in the arm's way\.)?.*Can you clear",
        _in_the_way,
    ),
    (r"I felt something hold up my arm", _held_up),
    (r"(?<!until )I see my way free|I see nothing in my way", _way_free),
    (r"I do not see my way free|I still see or feel something", _not_free),
    (r"I heard no answer", _nobody_answered),
    (r"I have now [a-z ]*?\b(once|twice|\w+ times)", _so_often),
    (r"try again \(attempt (\d+) of \d+\)", _next_try),
    (_NEXT, _then_with),
    (_NEXT, _named_once),
    (r"[Tt]he task ends here", _ends),
    (r"(?<!before )I go on\.", _goes_on),
    (r"I leave the .* out", _left_out),
)
"""What in a sentence is compared with what; a sentence may be compared with several things."""

EFFECTS: Sequence[tuple[str, Check]] = (
    (r"(?<!again )\((?:still )?attempt (\d+) of \d+\)", _attempt_now),
    (r"again \(still attempt (\d+) of \d+\)", _attempt_now),
    (_NEXT, _named_once),
)
"""The same for what an answer, or none, is said to lead to."""
