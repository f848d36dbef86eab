"""Calls the devices of those who are asked, from what the journal tells; and calls them off."""

import re
from collections.abc import Callable, Iterable
from typing import Literal, Protocol
from uuid import UUID, uuid5

from mend.errors import RefusalError
from mend.server.background import Endless
from mend.server.journal import events as ev
from mend.server.journal.journal import Journal, JournalClosedError
from mend.server.journal.subscriptions import PrunedEventsError, SubscriptionOverflowError
from mend.server.push.messages import (
    CallMessage,
    RobotLostMessage,
    WithdrawnMessage,
    sentences_with_room,
    shortened,
)
from mend.server.push.outbox import Letter
from mend.server.push.subscription import PushSubscription
from mend.server.push.subscriptions import PushSubscriptions
from mend.server.runtime.views import DialogueView, PromptView, RunSummary
from mend.tasks.resolution import Resolution

TYPE = re.compile(r'"type":"(\w+)"')

HELD_S = 60.0
"""So long a call to hold something now is of use."""

WITHDRAWN_S = 600.0
"""So long it is worth telling a device that it is needed no more."""

LOST_S = 600.0
"""So long a robot that is gone is worth calling about; who comes later sees it."""

OPEN_AT_ONCE = 1000

ENDS_HOLDING = ("node_done", "node_reset", "node_left_out")
ENDS_RUN = ("run_finished", "run_failed", "run_aborted")
TOLD = frozenset(
    {"prompt", "answered", "claimed", "released", "resolved", "dialogue_closed"}
    | {"robot_lost", "robot_back"} | set(ENDS_HOLDING) | set(ENDS_RUN)
)  # fmt: skip
"""The types of events that change who is called."""


class Dialogues(Protocol):
    """Where the dialogue of an event is found, as it is now."""

    async def page(
        self, status: Literal["open", "closed"] | None, limit: int, offset: int
    ) -> list[DialogueView]: ...

    async def view(self, dialogue: UUID) -> DialogueView: ...


class Runs(Protocol):
    """Where a run is found, as it is now."""

    async def run_summary(self, run: UUID) -> RunSummary: ...

    def lost_robots(self) -> Iterable[tuple[UUID, str]]: ...


class Letters(Protocol):
    """Where letters are put; `mend.server.push.outbox.Outbox`."""

    def put(self, device: PushSubscription, letter: Letter) -> None: ...


class Calling:
    """Who is called about what. Nobody is where a script answers.

    A device is called when its helper is asked, and again when that is repeated; it is called off
    when somebody is on it, another helper is asked, it was answered, or needs no answer any more.
    """

    def __init__(
        self,
        journal: Journal,
        dialogues: Dialogues,
        runs: Runs,
        subscriptions: PushSubscriptions,
        letters: Letters,
        monotonic: Callable[[], float],
    ) -> None:
        self._journal = journal
        self._dialogues = dialogues
        self._runs = runs
        self._subscriptions = subscriptions
        self._letters = letters
        self._monotonic = monotonic
        self._called: dict[UUID, set[str]] = {}
        self._held: dict[UUID, tuple[UUID, str]] = {}
        self._lost: dict[tuple[UUID, str], UUID] = {}
        self._endless = Endless("calling helpers", monotonic)

    async def recover(self) -> None:
        """Know of calls from before a restart, so that they can be called off."""
        for view in await self._dialogues.page("open", OPEN_AT_ONCE, 0):
            prompt = view.prompt
            if _is_asked(view) and prompt is not None:
                devices = self._subscriptions.of_helper(prompt.to)
                self._called[view.dialogue] = {each.id for each in devices}
        everybody = {each.id for each in self._subscriptions.of_helper(None)}
        for run, robot in self._runs.lost_robots():
            self._lost[run, robot] = call = _call_about(run, robot)
            self._called[call] = set(everybody)

    async def follow(self) -> None:
        """Take every event as it is committed, until the journal closes."""
        while True:
            with self._journal.subscribe(self._journal.head) as subscription:
                try:
                    async for record in subscription:
                        kind = TYPE.search(record.text)
                        if kind is not None and kind.group(1) in TOLD:
                            with self._endless.one_pass():
                                await self.take(ev.any_event.validate_json(record.text))
                except (SubscriptionOverflowError, PrunedEventsError):
                    # What was missed is asked again before long.
                    continue
                except JournalClosedError:
                    return
                return

    async def take(self, event: ev.Event) -> None:
        """Call, or call off, as an event says."""
        match event:
            case ev.Prompt(kind="ask", dialogue=dialogue):
                await self._ask(dialogue)
            case ev.Claimed(dialogue=dialogue, helper=helper):
                self._call_off(dialogue, event.robot, f"{helper} is on it.")
            case ev.Released(dialogue=dialogue):
                await self._ask(dialogue)
            case ev.Answered(dialogue=dialogue, helper=helper, answer=answer):
                self._call_off(dialogue, event.robot, f"{helper} answered {answer}.")
            case ev.Resolved(dialogue=dialogue, resolution=Resolution.COLLAB_FINISH):
                await self._hold(dialogue)
            case ev.DialogueClosed(dialogue=dialogue):
                if dialogue not in self._held:
                    self._call_off(dialogue, event.robot, "It is no longer needed.")
            case ev.NodeDone() | ev.NodeReset() | ev.NodeLeftOut():
                self._let_go(event.run, event.node)
            case ev.RobotLost(run=run, robot=robot):
                await self._miss(run, robot)
            case ev.RobotBack(run=run, robot=robot):
                self._miss_no_more(run, robot, "It is there again.")
            case ev.RunFinished() | ev.RunFailed() | ev.RunAborted():
                self._let_go(event.run, None)
                for run, robot in [each for each in self._lost if each[0] == event.run]:
                    self._miss_no_more(run, robot, "Its run is over.")

    async def _ask(self, dialogue: UUID) -> None:
        """Call whoever is asked now, and nobody else any more."""
        view = await self._view(dialogue)
        if view is None or not _is_asked(view) or view.prompt is None:
            return
        await self._subscriptions.let_go()
        to = view.prompt.to
        devices = self._subscriptions.of_helper(to)
        moved = self._called.get(dialogue, set()) - {each.id for each in devices}
        self._tell(moved, _withdrawn(view.dialogue, view.robot, f"{to} is asked now."), WITHDRAWN_S)
        within_s = view.prompt.within_s or HELD_S
        self._call(devices, _call(view, view.prompt, urgent=not view.interrupts), within_s)
        self._called[dialogue] = {each.id for each in devices}

    async def _hold(self, dialogue: UUID) -> None:
        """Call who has said that they help while the robot goes on."""
        view = await self._view(dialogue)
        if view is None or view.scripted or view.prompt is None or view.answered_by is None:
            return
        devices = self._subscriptions.of_helper(view.answered_by)
        self._call(devices, _call(view, view.prompt, urgent=True), HELD_S)
        self._called[dialogue] = {each.id for each in devices}
        self._held[dialogue] = view.run, view.node

    def _let_go(self, run: UUID, node: str | None) -> None:
        """Nothing is to be held any more: at one leaf, or (None) in the whole run."""
        for dialogue, (of, leaf) in list(self._held.items()):
            if of == run and node in (None, leaf):
                del self._held[dialogue]
                self._call_off(dialogue, "", "It is done.")

    async def _miss(self, run: UUID, robot: str) -> None:
        """Call everybody who helps about a robot that is gone, unless a script answers its run."""
        try:
            live = (await self._runs.run_summary(run)).live
        except RefusalError:
            return
        if not live or (run, robot) in self._lost:
            return
        await self._subscriptions.let_go()
        devices = self._subscriptions.of_helper(None)
        call = self._lost[run, robot] = _call_about(run, robot)
        self._call(devices, RobotLostMessage(dialogue=call, run=run, robot=robot), LOST_S)
        self._called[call] = {each.id for each in devices}

    def _miss_no_more(self, run: UUID, robot: str, why: str) -> None:
        call = self._lost.pop((run, robot), None)
        if call is not None:
            self._call_off(call, robot, why)

    def _call_off(self, dialogue: UUID, robot: str, why: str) -> None:
        called = self._called.pop(dialogue, set())
        self._tell(called, _withdrawn(dialogue, robot, why), WITHDRAWN_S)

    async def _view(self, dialogue: UUID) -> DialogueView | None:
        try:
            return await self._dialogues.view(dialogue)
        except RefusalError:
            return None

    def _tell(self, devices: Iterable[str], message: WithdrawnMessage, within_s: float) -> None:
        there = (self._subscriptions.get(each) for each in devices)
        self._call([each for each in there if each is not None], message, within_s)

    def _call(
        self,
        devices: Iterable[PushSubscription],
        message: CallMessage | RobotLostMessage | WithdrawnMessage,
        within_s: float,
    ) -> None:
        letter = Letter(message.dialogue.hex, message, self._monotonic() + within_s)
        for device in devices:
            self._letters.put(device, letter)


def _is_asked(view: DialogueView) -> bool:
    """Whether helpers are asked, and nobody is on it."""
    return view.awaiting == "answer" and not view.scripted and view.claimed_by is None


def _call_about(run: UUID, robot: str) -> UUID:
    """What a call about a lost robot goes by, the same after a restart of the service."""
    return uuid5(run, robot)


def _call(view: DialogueView, prompt: PromptView, *, urgent: bool) -> CallMessage:
    return CallMessage(
        dialogue=view.dialogue,
        run=view.run,
        robot=view.robot,
        text=shortened(prompt.text),
        sentences=sentences_with_room(prompt.text, prompt.wordings),
        urgent=urgent,
    )


def _withdrawn(dialogue: UUID, robot: str, why: str) -> WithdrawnMessage:
    return WithdrawnMessage(dialogue=dialogue, robot=robot, text=shortened(why))
