"""From a conversation's turns to the events that journal them."""

from collections.abc import Callable, Sequence
from datetime import datetime
from typing import Any
from uuid import UUID, uuid4

from dialogue.script import Ask, AwaitHelp, Close, CloseReason, Say, Turn
from server.journal import events as ev
from tasks.resolution import Resolution


class DialogueEvents:
    """Makes the events of one dialogue; `stamp` gives the time, wall time and run of each."""

    def __init__(
        self,
        stamp: Callable[[], dict[str, Any]],
        dialogue: UUID,
        raised: ev.IssueRaised,
    ) -> None:
        self._stamp = stamp
        self._node = {"node": raised.node, "name": raised.name}
        self._issue = {"robot": raised.robot, "issue": raised.issue, "object": raised.object}
        self._dialogue = dialogue

    def _fields(self) -> dict[str, Any]:
        return {**self._stamp(), **self._node, **self._issue, "dialogue": self._dialogue}

    def opened(self) -> ev.DialogueOpened:
        return ev.DialogueOpened(**self._fields())

    def say(self, say: Say) -> ev.Prompt:
        return ev.Prompt(**self._fields(), prompt=uuid4(), version=1, kind="say", text=say.text)

    def ask(self, ask: Ask, deadline: float, to: str | None) -> ev.Prompt:
        return ev.Prompt(
            **self._fields(),
            prompt=uuid4(),
            version=1,
            kind="ask",
            text=ask.text,
            answers=[
                ev.AnswerOption(value="yes", effect=ask.yes_effect, final=ask.yes_final),
                ev.AnswerOption(value="no", effect=ask.no_effect, final=ask.no_final),
            ],
            deadline=deadline,
            to=to,
        )

    def repeat(self, asked: ev.Prompt, deadline: float, to: str | None) -> ev.Prompt:
        """The same question again, with the next version."""
        return asked.model_copy(
            update={
                **self._stamp(),
                "seq": 0,
                "version": asked.version + 1,
                "deadline": deadline,
                "to": to,
            }
        )

    def answered(self, asked: ev.Prompt, answer: str, helper: str) -> ev.Answered:
        return ev.Answered.model_validate(
            {
                **self._fields(),
                "prompt": asked.prompt,
                "version": asked.version,
                "answer": answer,
                "helper": helper,
            }
        )

    def extended(
        self, asked: ev.Prompt, deadline: float, extensions_left: int, helper: str
    ) -> ev.DeadlineExtended:
        return ev.DeadlineExtended(
            **self._fields(),
            prompt=asked.prompt,
            version=asked.version,
            deadline=deadline,
            extensions_left=extensions_left,
            helper=helper,
        )

    def escalated(self, channel: str, to: str) -> ev.Escalated:
        return ev.Escalated.model_validate({**self._fields(), "channel": channel, "to": to})

    def claimed(self, helper: str, until: datetime) -> ev.Claimed:
        return ev.Claimed(**self._fields(), helper=helper, lease_until=until)

    def released(self, helper: str, expired: bool) -> ev.Released:
        return ev.Released(**self._fields(), helper=helper, expired=expired)

    def help_verified(self, awaiting: ev.HelpAwaited) -> ev.HelpVerified:
        return ev.HelpVerified(**self._fields(), help=awaiting.help)

    def help_not_seen(self, awaiting: ev.HelpAwaited) -> ev.HelpNotSeen:
        return ev.HelpNotSeen(**self._fields(), help=awaiting.help)

    def aborted(self) -> ev.DialogueClosed:
        return ev.DialogueClosed(**self._fields(), reason=CloseReason.ABORTED)

    def of_turns(
        self,
        turns: Sequence[Turn],
        *,
        ask_deadline: float,
        to: str | None,
        help_until: float,
        helper: str,
        can_go_on: bool,
    ) -> list[ev.Event]:
        """The events of a conversation's turns.

        `can_go_on`: the robot still has the execution that a `robot_finish` would go on with;
        without it the leaf is put back instead.
        """
        events: list[ev.Event] = []
        for turn in turns:
            match turn:
                case Say():
                    events.append(self.say(turn))
                case Ask():
                    events.append(self.ask(turn, ask_deadline, to))
                case AwaitHelp():
                    events.append(
                        ev.HelpAwaited(
                            **self._fields(), help=turn.help, helper=helper, until=help_until
                        )
                    )
                case Close():
                    events.extend(self._close(turn, can_go_on))
        return events

    def _close(self, close: Close, can_go_on: bool) -> list[ev.Event]:
        events: list[ev.Event] = []
        if close.reason in (CloseReason.RESOLVED, CloseReason.WITHDRAWN):
            assert close.resolution is not None, "a resolved issue has a resolution"
            events.append(
                ev.Resolved(**self._fields(), resolution=close.resolution, helped=close.helped)
            )
        events.append(ev.DialogueClosed(**self._fields(), reason=close.reason))
        match close.resolution:
            case Resolution.HUMAN_FINISH:
                events.append(
                    ev.NodeDone(
                        **self._stamp(), **self._node, robot=self._issue["robot"], by="human"
                    )
                )
            case Resolution.ROBOT_RETRY | None:
                reason = {
                    CloseReason.GAVE_UP: "nobody helped",
                    CloseReason.WITHDRAWN: "it was put right",
                }.get(close.reason, "the robot will try again")
                events.append(self.reset(reason, failed=not close.helped))
            case Resolution.ROBOT_FINISH | Resolution.COLLAB_FINISH if not can_go_on:
                events.append(self.reset("the robot had lost what it was doing", failed=False))
        return events

    def reset(self, reason: str, *, failed: bool) -> ev.NodeReset:
        return ev.NodeReset(
            **self._stamp(),
            **self._node,
            robot=self._issue["robot"],
            reason=reason,
            failed_attempt=failed,
        )
