"""From a conversation's turns to the events that journal them."""

from collections.abc import Callable, Sequence
from datetime import datetime
from typing import Any, Protocol
from uuid import UUID, uuid4

from mend.dialogue.evidence import Change, LookOutcome
from mend.dialogue.script import Ask, AwaitHelp, Close, CloseReason, Help, Remark, Turn, Way
from mend.dialogue.worded import joined
from mend.server.journal import events as ev
from mend.server.runtime.unseen_help import Unseen
from mend.server.runtime.wordings import wordings_of
from mend.tasks.resolution import Resolution


class Promised(Protocol):
    """Help that somebody has promised, and who that was."""

    @property
    def help(self) -> Help: ...

    @property
    def helper(self) -> str: ...


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
        self.dialogue = dialogue

    def _fields(self) -> dict[str, Any]:
        return {**self._stamp(), **self._node, **self._issue, "dialogue": self.dialogue}

    def opened(self, *, scripted: bool) -> ev.DialogueOpened:
        return ev.DialogueOpened(**self._fields(), scripted=scripted)

    def say(self, say: Remark) -> ev.Prompt:
        return ev.Prompt(
            **self._fields(),
            prompt=uuid4(),
            version=1,
            kind="say",
            text=say.text,
            wordings=wordings_of(say.text),
        )

    def ask(self, ask: Ask, deadline: float, to: str | None, if_silent: str) -> ev.Prompt:
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
            timeout_effect=if_silent,
            to=to,
            headline=ask.headline,
            ways=[_option(way) for way in ask.ways],
            wordings=wordings_of(*_texts_of(ask), if_silent),
        )

    def repeat(
        self, asked: ev.Prompt, ask: Ask, deadline: float, to: str | None, if_silent: str
    ) -> ev.Prompt:
        """The same question again, with the next version; `ask` words it as things are now."""
        fields = self.ask(ask, deadline, to, if_silent)
        return fields.model_copy(update={"prompt": asked.prompt, "version": asked.version + 1})

    def answered(
        self, asked: ev.Prompt, answer: str, helper: str, author: ev.Author | None
    ) -> ev.Answered:
        return ev.Answered.model_validate(
            {
                **self._fields(),
                "prompt": asked.prompt,
                "version": asked.version,
                "answer": answer,
                "helper": helper,
                "author": author,
            }
        )

    def extended(
        self,
        asked: ev.Prompt,
        deadline: float,
        extensions_left: int,
        helper: str,
        author: ev.Author | None,
    ) -> ev.DeadlineExtended:
        return ev.DeadlineExtended(
            **self._fields(),
            prompt=asked.prompt,
            version=asked.version,
            deadline=deadline,
            extensions_left=extensions_left,
            helper=helper,
            author=author,
        )

    def escalated(self, channel: str, to: str) -> ev.Escalated:
        return ev.Escalated.model_validate({**self._fields(), "channel": channel, "to": to})

    def handed_on(self, helper: str, to: str) -> ev.HandedOn:
        return ev.HandedOn(**self._fields(), helper=helper, to=to)

    def claimed(self, helper: str, until: datetime, author: ev.Author | None) -> ev.Claimed:
        return ev.Claimed(**self._fields(), helper=helper, lease_until=until, author=author)

    def released(self, helper: str, expired: bool, author: ev.Author | None = None) -> ev.Released:
        return ev.Released(**self._fields(), helper=helper, expired=expired, author=author)

    def first_look(self, look: LookOutcome) -> ev.FirstLook:
        return ev.FirstLook(
            **self._fields(),
            fulfilled=sorted(look.fulfilled),
            position=look.position,
            blind=look.blind,
            brought=look.brought,
        )

    def looked_anew(self, look: LookOutcome) -> ev.LookedAnew:
        return ev.LookedAnew(
            **self._fields(), fulfilled=sorted(look.fulfilled), position=look.position
        )

    def suspected_false_alarm(
        self, times: int, explanation: str, told: list[str]
    ) -> ev.SuspectedFalseAlarm:
        return ev.SuspectedFalseAlarm(
            **self._stamp(),
            **self._node,
            **self._issue,
            times=times,
            explanation=explanation,
            told=told,
        )

    def help_verified(
        self, awaiting: ev.HelpAwaited, change: Change, *, at_place: bool
    ) -> ev.HelpVerified:
        return ev.HelpVerified(
            **self._fields(), help=awaiting.help, change=change, at_place=at_place
        )

    def help_reported(
        self, awaiting: ev.HelpAwaited, helper: str, author: ev.Author | None
    ) -> ev.HelpReported:
        return ev.HelpReported(**self._fields(), help=awaiting.help, helper=helper, author=author)

    def promise_taken_back(
        self, awaiting: Promised, author: ev.Author | None
    ) -> ev.PromiseTakenBack:
        fields = {**self._fields(), "help": awaiting.help, "helper": awaiting.helper}
        return ev.PromiseTakenBack(**fields, author=author)

    def help_not_seen(self, awaiting: ev.HelpAwaited, unseen: Unseen) -> ev.HelpNotSeen:
        return ev.HelpNotSeen(**self._fields(), **_told(awaiting, unseen))

    def help_not_seen_yet(self, awaiting: ev.HelpAwaited, unseen: Unseen) -> ev.HelpNotSeenYet:
        told = _told(awaiting, unseen)
        return ev.HelpNotSeenYet(**self._fields(), **told, sight=unseen.sight)

    def aborted(self) -> ev.DialogueClosed:
        return ev.DialogueClosed(**self._fields(), reason=CloseReason.ABORTED)

    def of_turns(
        self,
        turns: Sequence[Turn],
        *,
        ask_deadline: float,
        if_silent: str,
        to: str | None,
        help_until: float,
        helper: str,
        stopped: str | None,
    ) -> list[ev.Event]:
        """The events of a conversation's turns.

        `if_silent` says what the run does before it takes silence for an answer. `stopped`: why the
        robot cannot go on with what it was doing, as a `robot_finish` would have it; the leaf is
        then put back instead.
        """
        events: list[ev.Event] = []
        for turn in turns:
            match turn:
                case Remark():
                    events.append(self.say(turn))
                case Ask():
                    effect = joined(if_silent, turn.timeout_effect)
                    events.append(self.ask(turn, ask_deadline, to, effect))
                case AwaitHelp():
                    events.append(
                        ev.HelpAwaited(
                            **self._fields(),
                            help=turn.help,
                            guess=turn.guess,
                            helper=helper,
                            until=help_until,
                        )
                    )
                case Close():
                    events.extend(self._close(turn, helper, stopped))
        return events

    def _close(self, close: Close, helper: str, stopped: str | None) -> list[ev.Event]:
        events: list[ev.Event] = []
        if close.reason in (CloseReason.RESOLVED, CloseReason.WITHDRAWN):
            assert close.resolution is not None, "a resolved issue has a resolution"
            events.append(
                ev.Resolved(**self._fields(), resolution=close.resolution, helped=close.helped)
            )
        events.append(ev.DialogueClosed(**self._fields(), reason=close.reason))
        match close:
            case Close(reason=CloseReason.LEFT_OUT):
                robot = self._issue["robot"]
                left = ev.NodeLeftOut(**self._stamp(), **self._node, robot=robot, helper=helper)
                events.append(left)
            case Close(resolution=Resolution.HUMAN_FINISH):
                robot = self._issue["robot"]
                done = ev.NodeDone(**self._stamp(), **self._node, robot=robot, by="human")
                events.append(done)
            case Close(resolution=Resolution.ROBOT_RETRY):
                events.append(self.reset(_why_put_back(close), failed=close.failed))
            case Close(resolution=Resolution.ROBOT_FINISH | Resolution.COLLAB_FINISH):
                if stopped is not None:
                    events.append(self.reset(stopped, failed=False))
        return events

    def reset(self, reason: str, *, failed: bool) -> ev.NodeReset:
        return ev.NodeReset(
            **self._stamp(),
            **self._node,
            robot=self._issue["robot"],
            reason=reason,
            failed_attempt=failed,
        )


def _option(way: Way) -> ev.WayOption:
    return ev.WayOption(
        way=way.name,
        deed=way.deed,
        label=way.label,
        effect=way.effect,
        answers=list(way.answers),
        final=way.final,
    )


def _texts_of(ask: Ask) -> tuple[str, ...]:
    """All that is said of a question, but for what silence does."""
    ways = (text for way in ask.ways for text in (way.deed, way.label, way.effect))
    return (ask.text, ask.headline, ask.yes_effect, ask.no_effect, *ways)


def _told(awaiting: ev.HelpAwaited, unseen: Unseen) -> dict[str, Any]:
    return {
        "help": awaiting.help,
        "felt": unseen.felt,
        "blind": unseen.blind,
        "picture": unseen.picture,
        "detection": unseen.detection,
    }


def _why_put_back(close: Close) -> str:
    if close.reason is CloseReason.GAVE_UP:
        return "no help was seen"
    if close.helped and close.failed:
        return "it has failed after help too often"
    if close.helped:
        return "somebody has helped" if close.reason is CloseReason.RESOLVED else "it was put right"
    if not close.failed:
        return "nobody can say whether anybody has helped"
    return "it has failed"
