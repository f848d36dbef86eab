"""Judges every sentence of a run's dialogues by where things really were when it was said.

The judge knows nothing of the runtime or the dialogues' code: it reads the journal's events, and
the states of the simulated world that were journaled beside them, as nobody in the run may.
"""

import math
import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from server.journal import events as ev
from server.journal.untruths import Rest
from tasks.scene import Scene

AT_PLACE_M = 0.04
"""Where a robot may say that a part is at its place: what it takes for that, and its error."""

CLEARLY_AT_PLACE_M = 0.01
"""A part this near its place, at its height, must not be told not to be there."""

GIVEN = frozenset({"place", "put_back", "hand_over", "move", "release"})
"""Deeds that may be help."""


@dataclass(frozen=True, slots=True)
class Moment:
    """The world at one event; a part is None in `resting` while somebody has taken it away."""

    resting: Mapping[str, Rest | None]
    held: str | None
    blocked: bool


@dataclass(frozen=True, slots=True)
class Untruth:
    """One thing that was said or told and was not so."""

    seq: int
    what: str
    why: str


class DialogueJudge:
    """Compares what one run says with its world; `moments[i]` is that of `events[i]`."""

    def __init__(self, events: Sequence[ev.Event], moments: Sequence[Moment]) -> None:
        started = events[0]
        assert isinstance(started, ev.RunStarted), "a run begins with run_started"
        self._events, self._moments = events, moments
        self._scene = Scene.model_validate(started.scene, strict=False)
        self._raised: dict[str, ev.IssueRaised] = {}
        self._place_of: dict[str, str | None] = {}
        self._opened: dict[Any, int] = {}
        self.sentences = 0

    def judge(self) -> list[Untruth]:
        """Everything untrue, in order."""
        return [
            Untruth(event.seq, what, why)
            for index, event in enumerate(self._events)
            for what, why in self._wrong_in(index, event)
        ]

    def _wrong_in(self, index: int, event: ev.Event) -> Iterator[tuple[str, str]]:
        match event:
            case ev.IssueRaised():
                self._raised[event.node] = event
                self._place_of[event.node] = event.place
            case ev.DialogueOpened():
                self._opened[event.dialogue] = index
            case ev.Prompt(version=1):
                self.sentences += 1
                for pattern, check in CHECKS:
                    found = re.search(pattern, event.text)
                    why = check(self, index, event, found) if found else None
                    if why:
                        yield event.text, why
            case ev.Resolved(helped=True):
                if not self._was_helped(index, event):
                    yield f"resolved {event.resolution}, helped", "nobody has helped"
            case ev.NodeDone():
                yield from self._wrong_doer(index, event)

    # --- What was so --------------------------------------------------------------------------

    def offset(self, index: int, node: str, name: str | None) -> tuple[float, float]:
        """How far a part is from its place (in the plane, in height), infinite if it is gone."""
        rest, place = self._moments[index].resting.get(name or ""), self._place_of.get(node)
        if rest is None or place is None or self._moments[index].held == name:
            return math.inf, math.inf
        pose = self._scene.places[place].pose
        height_m = self._scene.table.height if pose.z is None else pose.z
        return math.hypot(rest.x - pose.x, rest.y - pose.y), abs(rest.z - height_m)

    def rests(self, index: int, name: str | None) -> bool:
        """Whether a part lies anywhere."""
        moment = self._moments[index]
        return moment.resting.get(name or "") is not None and moment.held != name

    def moment(self, index: int) -> Moment:
        return self._moments[index]

    def at_issue(self, node: str) -> Moment:
        """The world when the issue of a leaf was raised last."""
        return self._moments[self._events.index(self._raised[node])]

    def crowded(self, node: str, name: str | None) -> bool:
        """Whether another part lies so near the place of a leaf that it may be in the way."""
        place = self._place_of.get(node)
        if place is None:
            return False
        pose, moment = self._scene.places[place].pose, self.at_issue(node)
        size = self._scene.objects[name].size if name in self._scene.objects else (0.1, 0.1, 0.1)
        return any(
            rest is not None
            and other != name
            and math.hypot(rest.x - pose.x, rest.y - pose.y)
            < (max(size[:2]) + max(self._scene.objects[other].size[:2])) / 2 + 0.06
            for other, rest in moment.resting.items()
        )

    def deeds(self, index: int, event: ev.DialogueEvent) -> Iterator[ev.InterventionDone]:
        """What people really did for a dialogue's object, or about the way, since it opened."""
        for each in self._events[self._opened[event.dialogue] : index]:
            if not isinstance(each, ev.InterventionDone) or not each.ok or each.act not in GIVEN:
                continue
            if each.object == event.object or each.act == "release":
                yield each

    def issues_so_far(self, index: int, event: ev.DialogueEvent) -> int:
        return sum(
            isinstance(each, ev.IssueRaised)
            and (each.node, each.issue) == (event.node, event.issue)
            for each in self._events[:index]
        )

    def following(self, index: int) -> Sequence[ev.Event]:
        return self._events[index + 1 :]

    def failed_before(self, index: int, node: str) -> int:
        return sum(
            isinstance(each, ev.NodeReset) and each.node == node and each.failed_attempt
            for each in self._events[:index]
        )

    # --- What events say ----------------------------------------------------------------------

    def _was_helped(self, index: int, event: ev.Resolved) -> bool:
        if event.resolution == "collab_finish":
            since = self._events[self._opened[event.dialogue] : index]
            return any(isinstance(each, ev.Answered) and each.answer == "yes" for each in since)
        return any(True for _ in self.deeds(index, event))

    def _wrong_doer(self, index: int, event: ev.NodeDone) -> Iterator[tuple[str, str]]:
        begun = max(
            i
            for i, each in enumerate(self._events[:index])
            if isinstance(each, ev.NodeStarted) and each.node == event.node
        )
        since = self._events[begun:index]
        deeds = [each for each in since if isinstance(each, ev.InterventionDone) and each.ok]
        brought = any(each.act in ("place", "move") for each in deeds)
        heard = any(
            isinstance(each, ev.Answered) and each.answer == "yes" and each.issue == "positioning"
            for each in since
        )
        if event.by == "human" and not brought:
            yield f"{event.name} is done by the human", "no person put it there"
        if event.by == "both" and not heard:
            yield f"{event.name} is done by both", "no person was heard to help"
        raised = self._raised.get(event.node)
        if raised is not None and raised.place is not None:
            aside_m, above_m = self.offset(index, event.node, raised.object)
            stolen = any(each.act == "steal" and each.object == raised.object for each in deeds)
            if max(aside_m, above_m) > AT_PLACE_M and not stolen:
                yield f"{event.name} is done", f"it is {max(aside_m, above_m):.3f} m off"


Check = Callable[[DialogueJudge, int, ev.Prompt, re.Match[str]], str | None]


def _thanks(judge: DialogueJudge, index: int, event: ev.Prompt, _: re.Match[str]) -> str | None:
    return None if any(True for _ in judge.deeds(index, event)) else "nobody has done anything"


def _at_place(judge: DialogueJudge, index: int, event: ev.Prompt, _: re.Match[str]) -> str | None:
    off_m = max(judge.offset(index, event.node, event.object))
    return None if off_m <= AT_PLACE_M else f"it is {off_m:.3f} m off"


def _not_at_place(
    judge: DialogueJudge, index: int, event: ev.Prompt, _: re.Match[str]
) -> str | None:
    off_m = max(judge.offset(index, event.node, event.object))
    hidden = judge.moment(index).blocked
    return None if off_m > CLEARLY_AT_PLACE_M or hidden else "it is there"


def _somewhere(judge: DialogueJudge, index: int, event: ev.Prompt, _: re.Match[str]) -> str | None:
    return None if judge.rests(index, event.object) else "it is not on the table"


def _nowhere(judge: DialogueJudge, _: int, event: ev.Prompt, __: re.Match[str]) -> str | None:
    moment = judge.at_issue(event.node)
    gone = moment.resting.get(event.object or "") is None
    hidden = moment.blocked
    return None if gone or hidden else "it lies on the table"


def _not_held(judge: DialogueJudge, _: int, event: ev.Prompt, __: re.Match[str]) -> str | None:
    return "the fingers hold it" if judge.at_issue(event.node).held == event.object else None


def _held(judge: DialogueJudge, index: int, event: ev.Prompt, _: re.Match[str]) -> str | None:
    return None if judge.moment(index).held == event.object else "the fingers do not hold it"


def _in_the_way(judge: DialogueJudge, _: int, event: ev.Prompt, __: re.Match[str]) -> str | None:
    there = judge.at_issue(event.node).blocked or judge.crowded(event.node, event.object)
    return None if there else "nothing is in its way"


def _held_up(judge: DialogueJudge, _: int, event: ev.Prompt, __: re.Match[str]) -> str | None:
    # The arm may also be held up by parts that it runs into.
    there = judge.at_issue(event.node).blocked or judge.crowded(event.node, event.object)
    return None if there else "nothing held it up"


def _way_free(judge: DialogueJudge, index: int, _: ev.Prompt, __: re.Match[str]) -> str | None:
    return "somebody stands in the way" if judge.moment(index).blocked else None


COUNTS = {"once": 1, "twice": 2} | {
    f"{word} times": number
    for number, word in enumerate(
        ("three", "four", "five", "six", "seven", "eight", "nine"), start=3
    )
}


def _so_often(
    judge: DialogueJudge, index: int, event: ev.Prompt, said: re.Match[str]
) -> str | None:
    times = COUNTS.get(said[1]) or int(said[1].split()[0])
    really = judge.issues_so_far(index, event)
    return None if times == really else f"it happened {really} times"


def _next_try(
    judge: DialogueJudge, index: int, event: ev.Prompt, said: re.Match[str]
) -> str | None:
    if event.kind == "ask":
        return None
    failed = judge.failed_before(index, event.node)
    ends = next(each for each in judge.following(index) if isinstance(each, ev.DialogueClosed))
    now_failed = sum(
        isinstance(each, ev.NodeReset) and each.node == event.node and each.failed_attempt
        for each in judge.following(index)[: judge.following(index).index(ends) + 3]
    )
    if int(said[1]) != failed + now_failed + 1:
        return f"{failed + now_failed} attempts have failed"
    later = judge.following(index)
    again = any(isinstance(each, ev.NodeStarted) and each.node == event.node for each in later)
    ended = isinstance(later[-1], ev.RunFailed) and later[-1].node != event.node
    dropped = any(isinstance(each, ev.NodeAbandoned) for each in later)
    return None if again or ended or dropped else "it was never tried again"


def _then_with(
    judge: DialogueJudge, index: int, event: ev.Prompt, said: re.Match[str]
) -> str | None:
    """What is to go first, or instead, is begun before the leaf is begun again."""
    if event.kind == "ask" or "another part" in said[1] or " or I take" in event.text:
        return None
    names = re.findall(r"the ([\w ]+?)(?=,| or |$)", said[1])
    for each in judge.following(index):
        if isinstance(each, ev.NodeStarted) and each.node == event.node:
            return "it was tried again before that"
        if isinstance(each, ev.NodeStarted) and each.name.replace("_", " ") in names:
            return None
    return None


def _ends(judge: DialogueJudge, index: int, event: ev.Prompt, _: re.Match[str]) -> str | None:
    if event.kind == "ask":
        return None
    last = judge.following(index)[-1]
    ended = isinstance(last, ev.RunFailed) and last.node == event.node
    return None if ended else "the task went on"


def _goes_on(judge: DialogueJudge, index: int, event: ev.Prompt, _: re.Match[str]) -> str | None:
    for each in judge.following(index):
        if isinstance(each, ev.NodeReset) and each.node == event.node:
            return "it was put back"
        if isinstance(each, ev.RobotResumed | ev.RobotLost):
            return None
        if isinstance(each, ev.NodeDone | ev.IssueRaised) and each.node == event.node:
            return None
    return None


def _left_out(judge: DialogueJudge, index: int, event: ev.Prompt, _: re.Match[str]) -> str | None:
    later = judge.following(index)[:3]
    told = any(isinstance(each, ev.NodeLeftOut) and each.node == event.node for each in later)
    return None if told else "it was not left out"


CHECKS: Sequence[tuple[str, Check]] = (
    (r"Thank you", _thanks),
    (r"I see the .* at its place", _at_place),
    (r"I do not see the .* at its place yet|^The .* is not at its place", _not_at_place),
    (r"I see the .* (within my reach|back on the table|on the table, but)", _somewhere),
    (r"I cannot find the|cannot find it", _nowhere),
    (r"I missed the|I lost hold of|failed .* to (pick up|hold)", _not_held),
    (r"I have the .* between my fingers", _held),
    (r"I see something in my way", _in_the_way),
    (r"I felt something hold up my arm", _held_up),
    (r"I see my way free|I see nothing in my way", _way_free),
    (r"I have now (?:failed|been stopped|looked|tried) (once|twice|\w+ times)", _so_often),
    (r"try again \(attempt (\d+) of \d+\)", _next_try),
    (r"I (?:go on with|take) (.*?) (?:first|instead)", _then_with),
    (r"[Tt]he task ends here", _ends),
    (r"I go on\.", _goes_on),
    (r"I leave the .* out", _left_out),
)
"""What in a sentence is compared with what; a sentence may be compared with several things."""
