"""No question waits for a helper who is busy while somebody who may answer it is idle."""

import asyncio
from collections.abc import AsyncIterator, Callable, Collection, Sequence
from contextlib import ExitStack
from uuid import UUID

import pytest
from answer_races import ONE_PART
from pretend_service import PretendService, pretend_service

from mend.server.dialogues.attendance import Attendance, Device, Presence
from mend.server.dialogues.escalation import EscalationPolicy
from mend.server.journal import events as ev
from mend.server.runtime.requests import RunRequest

FAULT = {"part_1": [("missed", 4)]}
THREE = EscalationPolicy(helpers=("ann", "ben", "cem"))


class Floor:
    """A service whose robots ask, one in each run, and wait as long as it takes."""

    def __init__(self, service: PretendService, attendance: Attendance) -> None:
        self.service = service
        self._attendance = attendance
        self._there: dict[str, ExitStack] = {}
        self._pages: dict[str, Device] = {}

    def comes(self, *helpers: str) -> None:
        for helper in helpers:
            self._there[helper] = ExitStack()
            attending = self._attendance.attending(helper)
            self._pages[helper] = self._there[helper].enter_context(attending)

    def says(self, helper: str, presence: Presence) -> None:
        self._attendance.says(helper, self._pages[helper], presence)

    def goes(self, helper: str) -> None:
        self._there.pop(helper).close()

    async def ask(self, **fields: object) -> ev.Prompt:
        """Have one more robot ask; its question as it is put first."""
        request = {"tree": "tree", "world": "tabletop", "speed": "max", **fields}
        run = await self.service.runtime.start_run(RunRequest.model_validate(request))
        return await self.put(lambda each: each.run == run.id)

    async def put(self, so: Callable[[ev.Prompt], bool]) -> ev.Prompt:
        """The first question that was put so, as soon as it is."""
        async with asyncio.timeout(60):
            with self.service.journal.subscribe(0, 100_000) as records:
                async for record in records:
                    event = ev.any_event.validate_json(record.text)
                    if isinstance(event, ev.Prompt) and event.kind == "ask" and so(event):
                        return event
        raise AssertionError("the journal ended")

    async def goes_on(self, question: ev.Prompt, to: str) -> ev.Prompt:
        """Wait until a question is put to another helper."""
        return await self.put(lambda each: each.dialogue == question.dialogue and each.to == to)

    async def refuse(self, question: ev.Prompt) -> list[str]:
        """Say no to all that is asked in a dialogue; by whom, each time."""
        asked, dialogues = list[str](), self.service.runtime.dialogues
        while (view := await dialogues.view(question.dialogue)).status == "open":
            assert view.prompt is not None
            asked.append(str(view.prompt.to))
            await dialogues.answer(view.dialogue, view.prompt.prompt, "no", asked[-1])
        return asked

    async def now_asked(self) -> dict[UUID, str]:
        """Whom each open question is put to."""
        views = await self.service.runtime.dialogues.page("open", 100, 0)
        return {each.dialogue: str(each.prompt.to) for each in views if each.prompt is not None}

    async def events(self, kind: type[ev.Event]) -> list[ev.Event]:
        return [each for each in await self.service.journal.read(0, 10_000) if type(each) is kind]


@pytest.fixture
async def floor() -> AsyncIterator[Floor]:
    attendance = Attendance()
    async with pretend_service(
        ONE_PART, FAULT, policy=THREE, attendance=attendance, patient=True
    ) as service:
        yield Floor(service, attendance)


async def test_questions_of_several_robots_are_put_to_several_helpers(floor: Floor) -> None:
    floor.comes("cem", "ben", "dan")
    asked = [(await floor.ask()).to for _ in range(6)]
    # Those who are here, in the order of the policy; then who is not, before any has two.
    assert asked == ["ben", "cem", "dan", "ann", "ben", "cem"]


async def test_a_question_goes_on_as_soon_as_somebody_else_is_idle(floor: Floor) -> None:
    floor.comes("ann", "ben", "cem")
    _, of_ben, of_cem, fourth, fifth = [await floor.ask() for _ in range(5)]
    assert (fourth.to, fifth.to) == ("ann", "ben")
    # What follows in a dialogue is asked of who has answered.
    assert set(await floor.refuse(of_cem)) == {"cem"}
    again = await floor.goes_on(fourth, "cem")
    assert again.prompt == fourth.prompt
    assert again.timeout_effect.startswith("I ask ")
    (told,) = await floor.events(ev.HandedOn)
    assert isinstance(told, ev.HandedOn)
    assert (told.helper, told.to, told.dialogue) == ("ann", "cem", fourth.dialogue)
    # Ben comes to the fifth himself once he is done with the other one.
    await floor.refuse(of_ben)
    assert (await floor.now_asked())[fifth.dialogue] == "ben"
    assert len(await floor.events(ev.HandedOn)) == 1


async def test_what_waits_for_who_is_on_another_goes_to_whoever_signs_in(floor: Floor) -> None:
    floor.comes("ann")
    first = await floor.ask()
    await floor.service.runtime.dialogues.claim(first.dialogue, "ann")
    floor.comes("ben", "cem")
    second, third = await floor.ask(), await floor.ask()
    assert (second.to, third.to) == ("ben", "cem")
    await floor.service.runtime.dialogues.claim(third.dialogue, "ben")
    floor.comes("dan")
    await floor.goes_on(second, "cem")


async def test_nobody_is_called_away_from_a_question_that_they_wanted_time_for(
    floor: Floor,
) -> None:
    floor.comes("ann", "ben", "cem")
    waiting = [await floor.ask() for _ in range(4)]
    assert [each.to for each in waiting] == ["ann", "ben", "cem", "ann"]
    await floor.service.runtime.dialogues.extend(waiting[3].dialogue, waiting[3].prompt, "ann")
    floor.comes("dan")
    assert await floor.events(ev.HandedOn) == []


async def test_what_waits_at_a_page_that_was_left_goes_to_who_is_here(floor: Floor) -> None:
    floor.comes("ann")
    first = await floor.ask()
    floor.comes("ben")
    assert await floor.events(ev.HandedOn) == []
    floor.says("ann", "away")
    await floor.goes_on(first, "ben")
    # Nobody is here who has nothing to do: the one who is away is called all the same.
    second = await floor.ask()
    assert second.to == "ann"
    floor.says("ann", "active")
    assert len(await floor.events(ev.HandedOn)) == 1


async def test_scripted_questions_keep_nobody_busy(floor: Floor) -> None:
    floor.comes("ann", "ben")
    await floor.ask(answers=["silence"] * 9)
    assert (await floor.ask()).to == "ann"


async def test_sixteen_robots_keep_five_helpers_busy_until_all_is_answered() -> None:
    """No deadline comes: robots wait as long as it takes."""
    names = ("ann", "ben", "cem", "dan", "eve")
    attendance, policy = Attendance(), EscalationPolicy(helpers=names[:2])
    async with pretend_service(
        ONE_PART, FAULT, policy=policy, attendance=attendance, patient=True
    ) as service:
        floor = Floor(service, attendance)
        floor.comes(*names)
        waiting = {each.dialogue: each for each in [await floor.ask() for _ in range(16)]}
        answered_by = set[str]()
        while waiting:
            asked = await busy(floor, waiting.keys(), names)
            # The one that was put last, so that others wait for who is not answering.
            dialogue = max(asked, key=lambda each: waiting[each].seq)
            answered_by.update(await floor.refuse(waiting.pop(dialogue)))
        assert answered_by == set(names)


async def busy(floor: Floor, waiting: Collection[UUID], names: Sequence[str]) -> dict[UUID, str]:
    """Wait until nobody is idle while several questions wait for one; whom each is put to."""
    async with asyncio.timeout(60):
        while True:
            asked = {key: to for key, to in (await floor.now_asked()).items() if key in waiting}
            if len(set(asked.values())) >= min(len(names), len(asked)):
                return asked
            await asyncio.sleep(0)
