"""A runtime without robots whose dialogues follow the real scripts; a test says what is seen."""

from collections.abc import Sequence
from dataclasses import dataclass, field
from datetime import UTC, datetime
from typing import Any, Literal
from uuid import UUID, uuid4

import cv2
import numpy as np
from fake_runs import FakeRuns

from mend.dialogue.evidence import Change
from mend.dialogue.outlook import Outlook
from mend.dialogue.registry import load_scripts
from mend.dialogue.script import Ask, Sight
from mend.errors import ConflictError
from mend.robots.link.messages import Detection
from mend.server.camera_picture import CameraPicture
from mend.server.errors import LostRaceError
from mend.server.journal import events as ev
from mend.server.journal.journal import Entry, Journal
from mend.server.runtime.dialogue_events import DialogueEvents
from mend.server.runtime.dialogue_state import rehearse
from mend.server.runtime.views import AwaitedHelp, DialogueView, PromptView, UnseenHelpView

USUAL_DEADLINE_S = 60.0
WIDTH_PX, HEIGHT_PX = 320, 240
DETECTION = Detection(
    camera="forearm",
    size_px=(WIDTH_PX // 2, HEIGHT_PX // 2),
    center=(40.0, 80.0),
    expected=(80.0, 60.0),
    tolerance_px=12.0,
    area_px=150,
    explanation="yellow_bar is not where it must be between the fingers",
)
SEEN_NOW = Detection(
    camera="head",
    size_px=(WIDTH_PX, HEIGHT_PX),
    center=(60.0, 150.0),
    expected=(200.0, 120.0),
    tolerance_px=24.0,
    area_px=400,
)


@dataclass
class Played:
    """One dialogue: its script's calls so far, and the question that is open."""

    raised: ev.IssueRaised
    make: DialogueEvents
    calls: list[str] = field(default_factory=list)
    asked: ev.Prompt | None = None
    helper: str = ""


class PlayedDialogues(FakeRuns):
    """A `RunService` in which an issue opens the dialogue that it would open on a robot."""

    def __init__(self, journal: Journal) -> None:
        super().__init__(journal)
        self._scripts = load_scripts()
        self._played: dict[UUID, Played] = {}
        self._won: dict[UUID, str] = {}
        self.deadline_s = USUAL_DEADLINE_S
        self.to: str | None = None
        """Whom questions are put to, from now on."""

    async def leave_nothing(self) -> None:
        """Close whatever is open, so that nothing of it is there for the next test."""
        for dialogue in [each.dialogue for each in self._dialogues.values()]:
            if self.dialogue_now(dialogue).status == "open":
                await self.call(dialogue, "abort")
        self.photographed.clear()
        self.deadline_s = USUAL_DEADLINE_S
        self.to = None

    async def open(self, run: UUID, kind: str, part: str = "yellow_bar", **otherwise: Any) -> UUID:
        """A robot detects a fault of `kind`, with a picture and a clip; the dialogue's id.

        `otherwise`: what the event has of the issue other than the usual.
        """
        pictures = [uuid4() for _ in range(4)]
        raised = ev.IssueRaised(
            **_stamp(run),
            node="/0",
            name=part,
            robot="pr2-0a1b2c3d",
            issue=kind,
            object=part,
            place=f"{part}_place",
            execution=uuid4(),
            step=5,
            interrupts=True,
            detection=DETECTION,
            picture=pictures[-1],
        ).model_copy(update=otherwise)
        dialogue = uuid4()
        played = Played(raised, DialogueEvents(lambda: _stamp(run), dialogue, raised))
        self._played[dialogue] = played
        self._dialogues[dialogue] = _view(dialogue, raised)
        if raised.place is not None:
            self.places[dialogue] = raised.place
        clip = ev.ClipRecorded(
            **_stamp(run),
            **raised.model_dump(include={"node", "name", "robot", "issue", "execution"}),
            dialogue=dialogue,
            pictures=[
                ev.ClipPicture(time=0.2 * number, picture=picture)
                for number, picture in enumerate(pictures[:-1])
            ],
        )
        jpegs = {each: _jpeg(number) for number, each in enumerate(pictures)}
        await self._journal.append(Entry(events=(raised,), pictures=jpegs))
        self._change(dialogue, clip=clip.pictures)
        await self._go_on(dialogue, "open", [played.make.opened(scripted=False)])
        await self.commit(clip)
        return dialogue

    async def answer(
        self,
        dialogue: UUID,
        prompt: UUID,
        answer: Literal["yes", "no"],
        helper: str,
        author: ev.Author | None = None,
    ) -> ev.Answered:
        asked = self._asked(dialogue, prompt)
        return await self._take(dialogue, asked, answer, helper, author)

    async def choose(
        self,
        dialogue: UUID,
        prompt: UUID,
        way: str,
        helper: str,
        author: ev.Author | None = None,
    ) -> ev.Answered:
        asked = self._asked(dialogue, prompt)
        chosen = next((each for each in asked.ways if each.way == way), None)
        if chosen is None:
            raise ConflictError(f"'{way}' is no way to answer this question")
        for answer in chosen.answers:
            answered = await self._take(dialogue, asked, answer, helper, author)
            asked = self._played[dialogue].asked or asked
        return answered

    def _asked(self, dialogue: UUID, prompt: UUID) -> ev.Prompt:
        self.dialogue_now(dialogue)
        if prompt in self._won:
            raise LostRaceError(prompt, self._won[prompt])
        asked = self._played[dialogue].asked
        if asked is None or asked.prompt != prompt:
            raise ConflictError("this prompt does not wait for an answer")
        return asked

    async def _take(
        self,
        dialogue: UUID,
        asked: ev.Prompt,
        answer: Literal["yes", "no"],
        helper: str,
        author: ev.Author | None,
    ) -> ev.Answered:
        played = self._played[dialogue]
        self._won[asked.prompt] = played.helper = helper
        answered = played.make.answered(asked, answer, helper, author)
        committed = await self._go_on(dialogue, answer, [answered])
        assert isinstance(committed[0], ev.Answered)
        return committed[0]

    async def see(self, dialogue: UUID, *, fulfilled: bool = True) -> None:
        """The robot sees the promised help, or has waited for it in vain."""
        played = self._played[dialogue]
        awaited = self.dialogue_now(dialogue).help
        assert awaited is not None, "no help is awaited"
        of = _of(dialogue, played.raised)
        if fulfilled:
            verified = ev.HelpVerified(**of, help=awaited.help, change=Change.MOVED)
            await self._go_on(dialogue, f"seen:{Change.MOVED}", [verified])
        else:
            await self._go_on(dialogue, "not_seen", [ev.HelpNotSeen(**of, help=awaited.help)])

    async def said_done(
        self, dialogue: UUID, helper: str, author: ev.Author | None = None
    ) -> ev.HelpReported:
        self._played[dialogue].calls.append("said_done")
        return await super().said_done(dialogue, helper, author)

    async def see_not_yet(self, dialogue: UUID) -> None:
        """The robot has looked at a helper's word, and does not see the help yet."""
        played, awaited = self._played[dialogue], self.awaited(dialogue)
        picture = uuid4()
        unseen = ev.HelpNotSeenYet(
            **_of(dialogue, played.raised),
            help=awaited.help,
            sight=Sight.UNMOVED,
            picture=picture,
            detection=SEEN_NOW,
        )
        await self._journal.append(Entry(pictures={picture: _jpeg(3)}))
        view = UnseenHelpView(time=unseen.time, picture=picture, detection=SEEN_NOW)
        still = awaited.model_copy(update={"reported_by": None})
        await self._go_on(dialogue, "not_yet::unmoved", [unseen])
        self._change(dialogue, unseen_help=view, help=still, awaiting="help")

    async def take_back(
        self, dialogue: UUID, helper: str, author: ev.Author | None = None
    ) -> ev.PromiseTakenBack:
        awaited = self.awaited(dialogue)
        if awaited.helper != helper:
            raise ConflictError(f"{awaited.helper} has promised this")
        taken_back = self._played[dialogue].make.promise_taken_back(awaited, author)
        committed = await self._go_on(dialogue, "take_back", [taken_back])
        assert isinstance(committed[0], ev.PromiseTakenBack)
        return committed[0]

    async def came_of(self, dialogue: UUID) -> list[ev.Event]:
        """All that was journaled since a dialogue was opened."""
        events = await self._journal.read(0, 100_000, self._played[dialogue].raised.run)
        opened = (each for each in events if isinstance(each, ev.DialogueOpened))
        first = next(each.seq for each in opened if each.dialogue == dialogue)
        return [each for each in events if each.seq >= first]

    async def picture(self, run: UUID, camera: str, robot: str | None = None) -> CameraPicture:
        await super().picture(run, camera, robot)
        return CameraPicture(_jpeg(2))

    async def call(self, dialogue: UUID, call: str) -> None:
        """Anything else that moves a conversation on: `silence`, `put_right:...`, `abort`."""
        await self._go_on(dialogue, call, [])

    async def ask_again(self, dialogue: UUID) -> None:
        """Nobody answered in time: the same question with a new deadline."""
        played = self._played[dialogue]
        assert played.asked is not None, "nothing is asked"
        script = self._scripts[played.raised.issue]
        turns = rehearse(script, played.raised, played.calls, Outlook())
        ask = next(each for each in turns if isinstance(each, Ask))
        again = played.make.repeat(played.asked, ask, self._deadline(), self.to, ask.timeout_effect)
        await self._commit(dialogue, [again])

    async def release_expired(self, dialogue: UUID, helper: str) -> None:
        """A helper's lease has run out."""
        raised = self._played[dialogue].raised
        await self.commit(ev.Released(**_of(dialogue, raised), helper=helper, expired=True))
        self._change(dialogue, claimed_by=None, claimed_until=None)

    async def finish_leaf(self, dialogue: UUID) -> None:
        """The robot is through with what the dialogue was about."""
        raised = self._played[dialogue].raised
        await self.commit(
            ev.NodeDone(
                **_stamp(raised.run),
                node=raised.node,
                name=raised.name,
                robot=raised.robot,
                by="both",
            )
        )

    async def _go_on(
        self, dialogue: UUID, call: str, before: Sequence[ev.Event]
    ) -> Sequence[ev.Event]:
        played = self._played[dialogue]
        played.calls.append(call)
        raised = played.raised
        outlook = raised.outlook or Outlook()
        turns = rehearse(self._scripts[raised.issue], raised, played.calls, outlook)
        events = played.make.of_turns(
            turns,
            ask_deadline=self._deadline(),
            if_silent="",
            to=self.to,
            help_until=self._deadline(),
            helper=played.helper,
            stopped=None,
        )
        if call == "abort":
            events = [played.make.aborted()]
        return await self._commit(dialogue, [*before, *events])

    async def _commit(self, dialogue: UUID, events: Sequence[ev.Event]) -> Sequence[ev.Event]:
        for event in events:
            self._note(dialogue, event)
        return await self.commit(*events)

    def _note(self, dialogue: UUID, event: ev.Event) -> None:
        played = self._played[dialogue]
        match event:
            case ev.Prompt():
                played.asked = event if event.kind == "ask" else None
                fields = event.model_dump(include=set(PromptView.model_fields))
                prompt = PromptView(**fields, within_s=self.deadline_s, extensions_left=10)
                awaiting = "answer" if event.kind == "ask" else None
                self._change(dialogue, prompt=prompt, awaiting=awaiting, help=None)
            case ev.HelpAwaited(help=help_, helper=helper, until=until):
                awaited = AwaitedHelp(help=help_, helper=helper, until=until)
                self._change(dialogue, awaiting="help", help=awaited)
            case ev.Answered(helper=helper):
                played.asked = None
                self._change(dialogue, awaiting=None, answered_by=helper)
            case ev.DialogueClosed(reason=reason):
                played.asked = None
                self._change(dialogue, status="closed", reason=reason, awaiting=None)

    def _deadline(self) -> float:
        return _TIME_S + self.deadline_s


_TIME_S = 1.0


def _stamp(run: UUID) -> dict[str, Any]:
    return {"time": _TIME_S, "wall_time": datetime.now(UTC), "run": run}


def _of(dialogue: UUID, raised: ev.IssueRaised) -> dict[str, Any]:
    fields = raised.model_dump(include={"node", "name", "robot", "issue", "object"})
    return {**_stamp(raised.run), **fields, "dialogue": dialogue}


def _view(dialogue: UUID, raised: ev.IssueRaised) -> DialogueView:
    fields = raised.model_dump(include={"run", "node", "name", "robot", "issue", "object"})
    return DialogueView(
        **fields,
        dialogue=dialogue,
        status="open",
        reason=None,
        prompt=None,
        awaiting=None,
        answered_by=None,
        claimed_by=None,
        claimed_until=None,
        picture=raised.picture,
        detection=raised.detection,
    )


def _jpeg(number: int) -> bytes:
    bgr = np.full((HEIGHT_PX, WIDTH_PX, 3), 90 + 20 * number, np.uint8)
    ok, data = cv2.imencode(".jpg", bgr)
    assert ok, "a grey picture can be a JPEG"
    return data.tobytes()
