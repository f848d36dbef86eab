"""The open questions of all runs as helpers have them before them: the most urgent first.

Questions that may be answered alike stand together. A choice is safe for all of them at once where
nobody has to do anything for it, or where one deed does it for all.
"""

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from uuid import UUID

from mend.dialogue.outlook import Outlook
from mend.dialogue.script import Help
from mend.server.journal import events as ev
from mend.server.runtime.dialogue_state import DialogueState
from mend.server.runtime.run_state import RunState
from mend.server.runtime.views import (
    BatchWayView,
    QuestionBatchView,
    QuestionView,
    RunStatus,
)


@dataclass(frozen=True, slots=True)
class OpenQuestion:
    """A question that people are asked now.

    `number` counts up with every dialogue. `barred`: the site and the places between which the
    robot is held up, where that is what it asks about.
    """

    view: QuestionView
    issue: str
    ways: Sequence[ev.WayOption]
    number: int
    barred: tuple[UUID, frozenset[str]] | None = None

    @property
    def urgency(self) -> tuple[float, int]:
        left_s = self.view.left_s
        return (math.inf if left_s is None else round(left_s), self.number)

    @property
    def alike(self) -> tuple[str, ...]:
        """What questions have in common that can be answered alike."""
        if not self.ways:
            # Nobody can tell what an answer does to another one.
            return (str(self.view.prompt),)
        return (self.issue, *(each.way for each in self.ways))


def open_questions(runs: Iterable[tuple[RunState, float]]) -> list[OpenQuestion]:
    """Every question of these runs that people are asked now; each with the time of its clock."""
    return [
        _question(run, dialogue, prompt, now_s)
        for run, now_s in runs
        for dialogue in run.open_dialogues
        if not dialogue.opened.scripted and (prompt := dialogue.open_ask) is not None
    ]


def batches_of(questions: Sequence[OpenQuestion]) -> list[QuestionBatchView]:
    """Questions that may be answered alike together, where the most urgent of them stands."""
    together: dict[tuple[str, ...], list[OpenQuestion]] = {}
    for each in sorted(questions, key=lambda each: each.urgency):
        together.setdefault(each.alike, []).append(each)
    return [
        QuestionBatchView(
            issue=batch[0].issue,
            headline=_headline(batch),
            at_once=ways_for_all(batch),
            questions=[each.view for each in batch],
        )
        for batch in together.values()
    ]


def ways_for_all(batch: Sequence[OpenQuestion]) -> list[BatchWayView]:
    """The ways that may be chosen for all of a batch with one press."""
    if len(batch) < 2 or len({each.alike for each in batch}) > 1:
        return []
    barred = {each.barred for each in batch}
    one_obstacle = len(barred) == 1 and None not in barred
    return [
        BatchWayView(way=way.way, label=way.label)
        for way in batch[0].ways
        if "yes" not in way.answers or (one_obstacle and way.way == Help.CLEAR_WAY)
    ]


def _headline(batch: Sequence[OpenQuestion]) -> str:
    """What is asked in all of them, without the name by which they differ."""
    first = batch[0]
    if len({each.view.headline for each in batch}) == 1 or not first.ways:
        return first.view.headline
    return first.ways[0].label


def _question(
    run: RunState, dialogue: DialogueState, prompt: ev.Prompt, now_s: float
) -> OpenQuestion:
    opened, raised = dialogue.opened, dialogue.raised
    outlook = raised.outlook or Outlook()
    between = frozenset(raised.detection.between) if raised.detection is not None else frozenset()
    view = QuestionView(
        dialogue=dialogue.id,
        prompt=prompt.prompt,
        run=run.id,
        tree=run.started.tree_name,
        robot=opened.robot,
        name=opened.name,
        object=opened.object,
        place=raised.place,
        headline=prompt.headline or prompt.text,
        left_s=_left_s(run, prompt, now_s),
        opened=opened.wall_time,
        attempt=outlook.attempt,
        attempts=outlook.attempts,
        to=prompt.to,
        claimed_by=None if dialogue.claim is None else dialogue.claim.helper,
    )
    barred = (run.world_kept_as, between) if between else None
    return OpenQuestion(view, opened.issue, prompt.ways, opened.seq, barred)


def _left_s(run: RunState, prompt: ev.Prompt, now_s: float) -> float | None:
    """Seconds of the wall clock until nobody waits any more; None while that does not come."""
    if prompt.deadline is None or run.status is RunStatus.PAUSED:
        return None
    speed = run.started.speed
    # The clock of a run whose people are asked never goes faster than theirs.
    rate = 1.0 if speed == "max" else min(1.0, speed)
    return max(0.0, prompt.deadline - now_s) / rate
