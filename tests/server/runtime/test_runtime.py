"""What a run does with faults, answers, silence and requests, over pretend robots."""

import asyncio
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from broken_constraints import broken_constraints
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from pretend_service import NoHardware, PretendService, PretendWorlds, pretend_service
from random_task import random_task
from sampled import sample
from task_documents import definition_of

from mend.errors import ConflictError, NotFoundError, UnreadableError, WrongInputError
from mend.server.dialogues.escalation import EscalationPolicy
from mend.server.errors import LostRaceError
from mend.server.journal import events as ev
from mend.server.journal.journal import Entry
from mend.server.journal.run_index import RunPage
from mend.server.runtime.presence import MAX_RESTARTS
from mend.server.runtime.requests import RunRequest
from mend.server.runtime.run_state import RunState
from mend.server.runtime.views import DialogueView, RunStatus, RunView
from mend.sim.tabletop.layout import lay_out
from mend.tasks.resolution import Resolution
from mend.tasks.scenario import Person

TWO_PARTS = definition_of(
    {
        "then": [
            {"behavior": "pick_and_place", "object": "part_1", "place": "spot_1"},
            {"behavior": "pick_and_place", "object": "part_2", "place": "spot_2"},
        ]
    }
)
EITHER_PART = definition_of(
    {
        "or": [
            {"behavior": "pick_and_place", "object": "part_1", "place": "spot"},
            {"behavior": "pick_and_place", "object": "part_2", "place": "spot"},
        ]
    }
)


def of_type(events: list[ev.Event], kind: type[ev.Event]) -> list[Any]:
    return [each for each in events if isinstance(each, kind)]


def check(view: RunView, events: list[ev.Event]) -> None:
    assert broken_constraints(events, {node.node: node.kind for node in view.nodes}) == []


async def test_a_task_without_faults_is_done_in_order() -> None:
    async with pretend_service(TWO_PARTS) as service:
        view, events = await service.run_to_end()
    assert view.status is RunStatus.FINISHED
    assert [each.name for each in of_type(events, ev.NodeDone)] == ["part_1", "part_2"]
    check(view, events)


@pytest.mark.parametrize(
    ("issue", "answers", "resolution", "done_by"),
    [
        ("missed", ["yes"], Resolution.ROBOT_RETRY, "robot"),
        ("missed", ["no", "yes"], Resolution.HUMAN_FINISH, "human"),
        ("missed", ["no", "no"], Resolution.ROBOT_RETRY, "robot"),
        ("dropped", ["yes"], Resolution.ROBOT_RETRY, "robot"),
        ("unreachable", ["yes"], Resolution.ROBOT_FINISH, "robot"),
        ("unreachable", ["no", "yes"], Resolution.HUMAN_FINISH, "human"),
        ("missing", ["yes"], Resolution.ROBOT_FINISH, "robot"),
        ("blocked", ["yes"], Resolution.ROBOT_FINISH, "robot"),
        ("positioning", ["yes"], Resolution.COLLAB_FINISH, "both"),
        ("positioning", ["no"], Resolution.ROBOT_FINISH, "robot"),
    ],
)
async def test_an_issue_is_resolved_as_it_was_answered(
    issue: str, answers: list[str], resolution: Resolution, done_by: str
) -> None:
    async with pretend_service(TWO_PARTS, {"part_1": [(issue, 4)]}) as service:
        view, events = await service.run_to_end(answers=answers)
    assert view.status is RunStatus.FINISHED
    assert [each.resolution for each in of_type(events, ev.Resolved)] == [resolution]
    done = next(each for each in of_type(events, ev.NodeDone) if each.name == "part_1")
    assert done.by == done_by
    check(view, events)


async def test_nobody_takes_a_finished_part_for_the_promised_one() -> None:
    faults = {"part_2": [("missed", 4)]}
    clumsy = Person(wrong_object=1.0)
    scene = lay_out([("part_1", "spot_1"), ("part_2", "spot_2")], seed=1)
    async with pretend_service(TWO_PARTS, faults, scene=scene) as service:
        _, events = await service.run_to_end(answers=["yes"], person=clumsy)
    deeds = of_type(events, ev.InterventionDone)
    assert [each.object for each in deeds if each.by == "helper"] == ["part_2"]


async def test_silence_fails_the_run_after_three_attempts_and_says_why() -> None:
    faults = {"part_1": [("missed", 4)] * 3}
    async with pretend_service(TWO_PARTS, faults) as service:
        view, events = await service.run_to_end(answers="none")
    assert view.status is RunStatus.FAILED
    assert view.result is not None
    assert view.result.node == "/0"
    assert "part_1" in view.result.reason
    assert len(of_type(events, ev.NodeStarted)) == 3
    assert {each.reason for each in of_type(events, ev.DialogueClosed)} == {"gave_up"}
    check(view, events)


async def test_a_hopeless_alternative_is_abandoned_for_the_other() -> None:
    faults = {"part_1": [("missed", 4)] * 3, "part_2": [("missed", 4)] * 2}
    async with pretend_service(EITHER_PART, faults) as service:
        view, events = await service.run_to_end(answers="none")
    assert view.status is RunStatus.FINISHED
    assert [each.node for each in of_type(events, ev.NodeAbandoned)] == ["/0"]
    assert [each.name for each in of_type(events, ev.NodeDone)] == ["part_2"]
    check(view, events)


async def test_an_unanswered_question_is_repeated_passed_on_and_mailed() -> None:
    policy = EscalationPolicy(helpers=("ann", "bob"), repeats=1, operators=("ops@example.org",))
    faults = {"part_1": [("missed", 4)]}
    async with pretend_service(TWO_PARTS, faults, policy=policy) as service:
        _, events = await service.run_to_end(answers=["silence", "silence", "silence", "yes"])
        mails = service.mails
    asks = [each for each in of_type(events, ev.Prompt) if each.kind == "ask"]
    assert [(each.version, each.to) for each in asks] == [
        (1, "ann"),
        (2, "ann"),
        (3, "bob"),
        (4, "bob"),
    ]
    assert len({each.prompt for each in asks}) == 1
    assert [each.to for each in of_type(events, ev.Escalated)] == ["bob", "ops@example.org"]
    assert len(mails) == 1


async def test_an_issue_without_a_script_is_a_failed_attempt() -> None:
    faults = {"part_1": [("slipping", 5)]}
    async with pretend_service(TWO_PARTS, faults, interrupting=("slipping",)) as service:
        view, events = await service.run_to_end(answers="none")
    assert view.status is RunStatus.FINISHED
    [reset] = of_type(events, ev.NodeReset)
    assert reset.failed_attempt
    assert "slipping" in reset.reason


async def test_a_leaf_that_no_robot_can_do_fails_the_run() -> None:
    async with pretend_service(TWO_PARTS, behaviors=("wave",)) as service:
        view, _ = await service.run_to_end()
    assert view.result is not None
    assert view.status is RunStatus.FAILED
    assert "no robot can do it" in view.result.reason


async def test_the_record_of_a_choice_has_every_candidate_best_first() -> None:
    async with pretend_service(EITHER_PART) as service:
        _, events = await service.run_to_end()
    [started] = of_type(events, ev.NodeStarted)
    assert [each.name for each in started.candidates] == ["part_1", "part_2"]
    assert started.candidates[0].potential > started.candidates[1].potential > 0


# --- Live helpers -----------------------------------------------------------------------------


async def open_question(service: PretendService, **fields: Any) -> DialogueView:
    request = {"tree": "tree", "world": "tabletop", "speed": "max", **fields}
    await service.runtime.start_run(RunRequest.model_validate(request))
    return await first_open_dialogue(service)


async def first_open_dialogue(service: PretendService) -> DialogueView:
    async with asyncio.timeout(60):
        while not (waiting := await service.runtime.dialogues.page("open", 100, 0)):  # noqa: ASYNC110
            await asyncio.sleep(0)
    return waiting[0]


def prompt_of(dialogue: DialogueView) -> Any:
    assert dialogue.prompt is not None
    return dialogue.prompt.prompt


# The second fault never comes due, so the run waits at its question for the test.
HELD = {"part_1": [("missed", 4)]}


@pytest.fixture
def deaf_watch(monkeypatch: pytest.MonkeyPatch) -> None:
    """Let no simulated time pass while a question is open: live helpers take their time."""
    from mend.server.runtime.dialogue_looks import DialogueLooks

    monkeypatch.setattr(DialogueLooks, "let_time_pass", lambda *_: None)


@pytest.mark.usefixtures("deaf_watch")
async def test_the_first_answer_wins_and_the_second_is_told_who_answered() -> None:
    async with pretend_service(TWO_PARTS, HELD) as service:
        dialogue = await open_question(service)
        answers = await asyncio.gather(
            *(
                service.runtime.dialogues.answer(
                    dialogue.dialogue, prompt_of(dialogue), "yes", name
                )
                for name in ("ann", "bob", "cem")
            ),
            return_exceptions=True,
        )
        won = [each for each in answers if isinstance(each, ev.Answered)]
        lost = [each for each in answers if isinstance(each, LostRaceError)]
    assert len(won) == 1
    assert [each.answered_by for each in lost] == [won[0].helper] * 2


@pytest.mark.usefixtures("deaf_watch")
async def test_an_unknown_prompt_is_refused_and_changes_nothing() -> None:
    async with pretend_service(TWO_PARTS, HELD) as service:
        dialogue = await open_question(service)
        head = service.journal.head
        with pytest.raises(NotFoundError):
            await service.runtime.dialogues.answer(
                dialogue.dialogue, dialogue.dialogue, "yes", "ann"
            )
        assert service.journal.head == head


@pytest.mark.usefixtures("deaf_watch")
async def test_a_claim_shows_and_does_not_keep_another_from_answering() -> None:
    async with pretend_service(TWO_PARTS, HELD) as service:
        dialogue = await open_question(service)
        claimed = await service.runtime.dialogues.claim(dialogue.dialogue, "ann")
        assert claimed.claimed_by == "ann"
        with pytest.raises(ConflictError, match="ann"):
            await service.runtime.dialogues.claim(dialogue.dialogue, "bob")
        answered = await service.runtime.dialogues.answer(
            dialogue.dialogue, prompt_of(dialogue), "yes", "bob"
        )
        assert answered.helper == "bob"
        assert (await service.runtime.dialogues.view(dialogue.dialogue)).claimed_by is None
        events = await service.journal.read(0, 1000, dialogue.run)
    released = [(each.helper, each.expired) for each in of_type(events, ev.Released)]
    assert released == [("ann", False)]


@pytest.mark.usefixtures("deaf_watch")
async def test_who_answers_after_the_winning_answer_ended_the_run_is_told_who_won() -> None:
    async with pretend_service(TWO_PARTS, HELD) as service:
        dialogue = await open_question(service)
        prompt = prompt_of(dialogue)
        await service.runtime.dialogues.answer(dialogue.dialogue, prompt, "yes", "ann")
        await service.runtime.abort(dialogue.run)
        await service.runtime.wait_for_end(dialogue.run)
        with pytest.raises(LostRaceError, match="ann"):
            await service.runtime.dialogues.answer(dialogue.dialogue, prompt, "no", "bob")


@pytest.mark.usefixtures("deaf_watch")
async def test_a_run_can_be_paused_resumed_and_aborted() -> None:
    async with pretend_service(TWO_PARTS, HELD) as service:
        dialogue = await open_question(service)
        runtime, run = service.runtime, dialogue.run
        with pytest.raises(ConflictError):
            await runtime.resume(run)
        assert (await runtime.pause(run)).status is RunStatus.PAUSED
        assert {each.activation_level for each in (await runtime.run(run)).nodes} == {0.0}
        assert (await runtime.resume(run)).status is RunStatus.RUNNING
        assert (await runtime.abort(run)).status is RunStatus.ABORTED
        await runtime.wait_for_end(run)
        assert (await runtime.dialogues.view(dialogue.dialogue)).reason == "aborted"
        for late in (runtime.pause, runtime.abort):
            with pytest.raises(ConflictError):
                await late(run)


async def test_live_robots_have_to_be_named_and_connected() -> None:
    async with pretend_service(TWO_PARTS) as service:
        request = RunRequest(tree="tree", world="live")
        with pytest.raises(WrongInputError, match="robots"):
            await service.runtime.start_run(request)
        with pytest.raises(NotFoundError, match="r2"):
            await service.runtime.start_run(request.model_copy(update={"robots": ["r2"]}))
        assert service.journal.head == 0


# --- Restarts ---------------------------------------------------------------------------------


@pytest.mark.usefixtures("deaf_watch")
async def test_after_a_restart_the_same_dialogue_is_still_open(tmp_path: Path) -> None:
    path = tmp_path / "journal.sqlite"
    async with pretend_service(TWO_PARTS, HELD, journal=path) as service:
        before = await open_question(service)
    async with pretend_service(TWO_PARTS, journal=path, boot=2) as service:
        await first_open_dialogue(service)
        after = await service.runtime.dialogues.view(before.dialogue)
        assert after.prompt == before.prompt
        assert after.status == "open"
        await service.runtime.dialogues.answer(before.dialogue, prompt_of(before), "yes", "ann")
        view = await service.runtime.wait_for_end(before.run)
        events = await service.journal.read(0, 10_000, before.run)
    assert view.status is RunStatus.FINISHED
    check(view, events)


# --- Faults of ours ---------------------------------------------------------------------------


async def test_a_fault_of_ours_fails_the_run_instead_of_hanging_it(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    def broken(*_: object) -> None:
        raise RuntimeError("no such thing")

    monkeypatch.setattr("mend.server.runtime.task_allocation.choose", broken)
    async with pretend_service(TWO_PARTS) as service:
        view, events = await asyncio.wait_for(service.run_to_end(), timeout=60)
    assert view.status is RunStatus.FAILED
    assert view.result is not None
    assert "a fault in Mend stopped it (RuntimeError: no such thing)" in view.result.reason
    check(view, events)


async def test_a_robot_that_cannot_be_started_again_fails_the_run(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    async def refuse(*_: object) -> None:
        raise WrongInputError("the world cannot run here")

    async with pretend_service(TWO_PARTS, HELD, deaf=True) as service:
        request = RunRequest(tree="tree", world="tabletop", speed="max")
        started = await service.runtime.start_run(request)
        await service.runtime.pause(started.id)
        monkeypatch.setattr(NoHardware, "restart", refuse)
        service.run_of(started).tell_lost(started.robots[0], "it was killed")
        view = await asyncio.wait_for(service.runtime.wait_for_end(started.id), timeout=60)
    assert view.status is RunStatus.FAILED
    assert view.result is not None
    assert view.result.reason == "it could not go on: the world cannot run here"


async def test_a_robot_that_never_begins_a_step_is_not_started_for_ever() -> None:
    async with pretend_service(TWO_PARTS, deaf=True) as service:
        request = RunRequest(tree="tree", world="tabletop", speed="max")
        started = await service.runtime.start_run(request)
        run = service.run_of(started)
        for _ in range(MAX_RESTARTS + 1):
            run.tell_lost(started.robots[0], "it was killed")
        view = await asyncio.wait_for(service.runtime.wait_for_end(started.id), timeout=60)
    assert view.result is not None
    assert "its process keeps ending: it was killed" in view.result.reason
    assert len(service.worlds.restarted) == 1 + MAX_RESTARTS


async def test_a_run_that_cannot_be_taken_up_fails_and_the_others_go_on(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = tmp_path / "journal.sqlite"
    request = RunRequest(tree="tree", world="tabletop", speed="max")
    async with pretend_service(TWO_PARTS, deaf=True, journal=path) as service:
        stuck = await service.runtime.start_run(request)
        other = await service.runtime.start_run(request)
    opened = PretendWorlds.open

    def refuse(worlds: PretendWorlds, state: RunState, run: Any) -> Any:
        if state.id == stuck.id:
            raise WrongInputError("the world is no longer there")
        return opened(worlds, state, run)

    monkeypatch.setattr(PretendWorlds, "open", refuse)
    async with pretend_service(TWO_PARTS, journal=path, boot=2) as service:
        failed = await service.runtime.run(stuck.id)
        finished = await service.runtime.wait_for_end(other.id)
    assert failed.status is RunStatus.FAILED
    assert failed.result is not None
    assert failed.result.reason == "it could not go on: the world is no longer there"
    assert finished.status is RunStatus.FINISHED


async def test_a_run_that_cannot_be_read_does_not_keep_the_service_from_starting(
    tmp_path: Path,
) -> None:
    path = tmp_path / "journal.sqlite"
    async with pretend_service(TWO_PARTS, journal=path) as service:
        view, events = await service.run_to_end()
        impossible = of_type(events, ev.NodeDone)[0].model_copy(update={"node": "/7"})
        await service.journal.append(Entry(events=[impossible]))
    async with pretend_service(TWO_PARTS, journal=path) as service:
        with pytest.raises(UnreadableError, match=r"\(node_done\) does not fit what came before"):
            await service.runtime.run(view.id)
        [listed] = await service.runtime.runs(RunPage())
        assert listed.status is RunStatus.UNREADABLE
        assert listed.result is not None
        assert "node_done" in listed.result.reason
        assert (await service.runtime.count_runs())[RunStatus.UNREADABLE] == 1
        again, _ = await service.run_to_end()
        assert again.status is RunStatus.FINISHED
        assert (await service.runtime.snapshot(None)).runs == []


@pytest.mark.usefixtures("deaf_watch")
async def test_a_refusal_that_nobody_waits_for_any_more_leaves_the_run_alone() -> None:
    async with pretend_service(TWO_PARTS, HELD) as service:
        dialogue = await open_question(service)
        run = service.run_of(await service.runtime.run(dialogue.run))
        asked = asyncio.create_task(run.request(run.resume))
        await asyncio.sleep(0)
        asked.cancel()
        await asyncio.gather(asked, return_exceptions=True)
        await service.runtime.dialogues.answer(dialogue.dialogue, prompt_of(dialogue), "yes", "ann")
        view = await service.runtime.wait_for_end(dialogue.run)
    assert view.status is RunStatus.FINISHED


async def test_a_snapshot_of_the_past_is_the_state_of_then() -> None:
    async with pretend_service(TWO_PARTS, HELD) as service:
        _, events = await service.run_to_end(answers=["no", "yes"])
        asked = next(e for e in events if isinstance(e, ev.Prompt) and e.kind == "ask")
        snapshot = await service.runtime.snapshot(asked.seq)
        before = await service.runtime.snapshot(asked.seq - 1)
        now = await service.runtime.snapshot(None)
    [run] = snapshot.runs
    assert run.status is RunStatus.RUNNING
    [dialogue] = snapshot.dialogues
    assert dialogue.prompt is not None
    assert (dialogue.prompt.prompt, dialogue.awaiting) == (asked.prompt, "answer")
    assert [each.awaiting for each in before.dialogues] == [None]
    assert now.runs == []
    assert now.seq == events[-1].seq


# --- Everything at once -----------------------------------------------------------------------

ISSUES = ["missed", "dropped", "unreachable", "positioning", "missing", "blocked"]


@pytest.mark.slow
@settings(max_examples=sample(30, 60), deadline=None, suppress_health_check=[HealthCheck.too_slow])
@given(
    seed=st.integers(0, 2**31 - 1),
    leaves=st.integers(1, 20),
    chance=st.floats(0, 0.8),
    answers=st.sampled_from(["random", "none"]),
)
def test_every_run_ends_and_keeps_every_constraint(
    seed: int, leaves: int, chance: float, answers: str
) -> None:
    rng = np.random.default_rng(seed)
    definition = definition_of(random_task(rng, leaves)["tree"])
    faults = {
        f"part_{part}": [
            (str(rng.choice(ISSUES)), int(rng.integers(1, 9))) for _ in range(rng.integers(1, 5))
        ]
        for part in range(1, leaves + 1)
        if rng.random() < chance
    }

    async def run() -> tuple[RunView, list[ev.Event]]:
        async with pretend_service(definition, faults) as service:
            return await asyncio.wait_for(
                service.run_to_end(answers=answers, seed=seed), timeout=60
            )

    view, events = asyncio.run(run())
    assert view.status in (RunStatus.FINISHED, RunStatus.FAILED)
    check(view, events)
