"""Questions that wait for who is busy or away go on to who is idle, whichever run they are of."""

from collections.abc import Callable, Iterable, Sequence

from mend.server.dialogues.attendance import Attendance
from mend.server.dialogues.duty import Duty, duty_of
from mend.server.dialogues.escalation import EscalationPolicy, handed_on
from mend.server.journal import events as ev
from mend.server.runtime.run import Run
from mend.server.runtime.run_state import RunState

_CHANGES_DUTY = (
    ev.Prompt, ev.Answered, ev.Claimed, ev.Released, ev.HelpAwaited, ev.HelpVerified,
    ev.HelpNotSeen, ev.PromiseTakenBack, ev.DialogueClosed, ev.RunResumed,
)  # fmt: skip
"""What changes what a helper has to do, or which questions may go on to another one."""


class HandingOn:
    """Watches who is there and what they have to do, over all runs that go on."""

    def __init__(
        self,
        policy: EscalationPolicy,
        attendance: Attendance,
        states: Callable[[], Iterable[RunState]],
        runs: Callable[[], Iterable[Run]],
    ) -> None:
        self._policy, self._attendance = policy, attendance
        self._states, self._runs = states, runs
        attendance.changed = self._hand_on

    def duty(self) -> Duty:
        """Who is there, and what they have to do by now."""
        return duty_of(self._attendance, self._states())

    def follow(self, events: Sequence[ev.Event]) -> None:
        """A run's state has followed these events."""
        if any(isinstance(each, _CHANGES_DUTY) for each in events):
            self._hand_on()

    def _hand_on(self) -> None:
        """Have every run look again whose question waits, while somebody else is here and idle."""
        if not self._policy.helpers:
            return
        wanted = handed_on(self._policy, self.duty()).keys()
        for run in tuple(self._runs()) if wanted else ():
            if any(each.id in wanted for each in run.context.state.open_dialogues):
                run.look_again()
