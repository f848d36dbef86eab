"""Who is signed in to help and who is here, and what each helper has to do: of one moment."""

from collections.abc import Collection, Iterable, Sequence
from dataclasses import dataclass, replace
from uuid import UUID

from mend.server.dialogues.attendance import Attendance
from mend.server.runtime.dialogue_state import DialogueState
from mend.server.runtime.run_state import RunState
from mend.server.runtime.views import RunStatus


@dataclass(frozen=True, slots=True)
class WaitingQuestion:
    """A question that waits for people, and that nobody is on.

    `asked` has whom it was put to, one time after the other. `may_go_on`: whether it may be put to
    somebody else by now.
    """

    dialogue: UUID
    asked: Sequence[str | None]
    may_go_on: bool = True

    @property
    def helper(self) -> str | None:
        """Who is asked now; None is everybody."""
        return self.asked[-1]


@dataclass(frozen=True, slots=True)
class Duty:
    """`there` are those who are signed in and may answer, who came first first.

    `on` are the dialogues that somebody has claimed or promised help in, and `questions` the
    others, in the order in which they were put. `away` are those who are there and at no page of
    theirs, and `called` those who have a device that is called, signed in or not.
    """

    there: Sequence[str] = ()
    on: Sequence[tuple[UUID, str]] = ()
    questions: Sequence[WaitingQuestion] = ()
    away: Collection[str] = ()
    called: Collection[str] = ()

    @property
    def free(self) -> list[str]:
        """Who is there and on nothing, though something may be put to them."""
        busy = {helper for _, helper in self.on}
        return [each for each in self.there if each not in busy]

    @property
    def idle(self) -> list[str]:
        """Who is here, on nothing, and asked nothing."""
        asked = {each.helper for each in self.questions}
        return [each for each in self.free if each not in asked and each not in self.away]

    def rank(self, helper: str, dialogue: UUID | None = None) -> tuple[int, int]:
        """Where a helper stands among all: the least is asked first.

        Who has nothing before it is, and among those alike who is here, then who hears a call.
        """
        if helper in self.there and helper not in self.away:
            far = 0
        else:
            far = 1 if helper in self.there or helper in self.called else 2
        return self.before(helper, dialogue), far

    def before(self, helper: str, dialogue: UUID | None = None) -> int:
        """How many other things a helper is to do first; without a dialogue, before a new one."""
        count = len({each for each, by in self.on if by == helper and each != dialogue})
        for question in self.questions:
            if question.dialogue == dialogue:
                break
            count += question.helper == helper
        return count

    def without(self, dialogue: UUID) -> "Duty":
        """The same but for what is of one dialogue, which puts its next question."""
        on = [each for each in self.on if each[0] != dialogue]
        questions = [each for each in self.questions if each.dialogue != dialogue]
        return replace(self, on=on, questions=questions)


def duty_of(attendance: Attendance, runs: Iterable[RunState]) -> Duty:
    """The duty of those who are there, in what these runs ask of people."""
    open_dialogues = [
        (run, each) for run in runs for each in run.open_dialogues if not each.opened.scripted
    ]
    on = [(each.id, helper) for _, each in open_dialogues for helper in _helpers_on(each)]
    taken = {dialogue for dialogue, _ in on}
    waiting = [
        (ask.seq, WaitingQuestion(each.id, tuple(each.asked_of), _may_go_on(run, each)))
        for run, each in open_dialogues
        if (ask := each.open_ask) is not None and each.id not in taken
    ]
    waiting.sort(key=lambda each: each[0])
    return Duty(
        there=tuple(attendance.there),
        on=on,
        questions=[question for _, question in waiting],
        away=tuple(attendance.away),
        called=frozenset(attendance.called_by_push()),
    )


def _helpers_on(dialogue: DialogueState) -> list[str]:
    helpers = []
    if dialogue.claim is not None:
        helpers.append(dialogue.claim.helper)
    if dialogue.awaiting is not None:
        helpers.append(dialogue.awaiting.helper)
    return helpers


def _may_go_on(run: RunState, dialogue: DialogueState) -> bool:
    """Not where its robot does not wait, its run is paused, or somebody has wanted more time."""
    ask = dialogue.open_ask
    given_time = ask is not None and ask.prompt in dialogue.extensions
    return run.status is RunStatus.RUNNING and dialogue.raised.interrupts and not given_time
