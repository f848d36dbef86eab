"""A robot says what it saw, thanks for help that it saw, and finds out when it is wrong."""

from typing import Any

import pytest
from broken_constraints import broken_constraints
from pretend_service import pretend_service
from task_documents import definition_of

from mend.server.dialogues import answers as answering
from mend.server.dialogues.escalation import EscalationPolicy
from mend.server.journal import events as ev
from mend.server.runtime.views import RunStatus, RunView
from mend.sim.tabletop.layout import lay_out
from mend.tasks.resolution import Resolution

NAMES = [("part_1", "spot_1"), ("part_2", "spot_2")]
SCENE = lay_out(NAMES, seed=1)
LEAVES = [{"behavior": "pick_and_place", "object": part, "place": spot} for part, spot in NAMES]
OPERATED = EscalationPolicy(operators=("ops@example.org",))


async def run_with(
    kind: str,
    step: int,
    answers: Any,
    *,
    times: int = 9,
    goal: str = "then",
    person: Any = None,
    **robot: Any,
) -> tuple[RunView, list[ev.Event]]:
    """A run in which `part_1` runs into an issue of a kind so often."""
    faults = {"part_1": [(kind, step)] * times}
    async with pretend_service(
        definition_of({goal: LEAVES}), faults, scene=SCENE, policy=OPERATED, **robot
    ) as service:
        view, events = await service.run_to_end(answers=answers, person=person)
        alarms = [each for each in service.mails if isinstance(each, ev.SuspectedFalseAlarm)]
    assert [each.told for each in alarms] == [
        each.told for each in of_type(events, ev.SuspectedFalseAlarm)
    ]
    assert broken_constraints(events, {node.node: node.kind for node in view.nodes}) == []
    return view, events


def of_type(events: list[ev.Event], kind: type[Any]) -> list[Any]:
    return [each for each in events if isinstance(each, kind)]


def said(events: list[ev.Event]) -> list[str]:
    return [each.text for each in of_type(events, ev.Prompt) if each.version == 1]


@pytest.mark.parametrize("kind", ["missed", "dropped"])
async def test_a_part_that_never_left_withdraws_no_question(kind: str) -> None:
    view, events = await run_with(kind, 4, "none", wrong=True)
    assert view.status is RunStatus.FAILED
    assert {each.reason for each in of_type(events, ev.DialogueClosed)} == {"gave_up"}
    assert not any("Thank you" in each for each in said(events))
    assert not any(each.helped for each in of_type(events, ev.Resolved))
    failed = [each for each in of_type(events, ev.NodeReset) if each.failed_attempt]
    assert len(failed) == 3


async def test_a_robot_that_is_wrong_finds_out_and_the_operators_hear_of_it_once() -> None:
    _, events = await run_with("missed", 4, "none", wrong=True)
    [alarm] = of_type(events, ev.SuspectedFalseAlarm)
    assert (alarm.object, alarm.issue, alarm.times) == ("part_1", "missed", 2)
    assert alarm.told == ["ops@example.org"]
    asked = [each for each in said(events) if each.endswith("?")]
    assert asked == [
        "I missed the part 1. Will you put it back on the table?",
        "I missed the part 1. Will you put it back on the table?",
        "I have now failed three times to pick up the part 1. Will you place the part 1 yourself?",
    ]


@pytest.mark.parametrize(
    ("kind", "step", "robot"),
    [("undone", 1, {}), ("missing", 6, {"stubborn": True}), ("blind", 6, {"stubborn": True})],
)
async def test_what_is_seen_again_and_again_is_no_false_alarm(
    kind: str, step: int, robot: dict[str, Any]
) -> None:
    _, events = await run_with(kind, step, "none", wrong=True, **robot)
    again = [each.outlook.unchanged for each in of_type(events, ev.IssueRaised)]
    assert max(again) >= 2
    assert of_type(events, ev.FirstLook)[0].fulfilled
    assert of_type(events, ev.SuspectedFalseAlarm) == []


async def test_a_yes_without_a_change_is_no_help_and_the_attempt_has_failed() -> None:
    person = {"never": 1.0}
    faults = {"part_1": [("missed", 4)] * 9}
    async with pretend_service(
        definition_of({"then": LEAVES}), faults, scene=SCENE, wrong=True
    ) as service:
        _, events = await service.run_to_end(answers=["yes"] * 50, person=person)
    assert not any("Thank you" in each for each in said(events))
    assert not any(each.helped for each in of_type(events, ev.Resolved))
    assert said(events)[2] == (
        "I see the part 1 on the table, where I saw it after I asked: attempt 1 of 3 has failed. "
        "I try again (attempt 2 of 3)."
    )


async def test_nobody_is_thanked_for_handing_over_what_the_fingers_hold_already() -> None:
    _, events = await run_with("unreachable", 1, ["yes"] * 50, held="part_1")
    assert of_type(events, ev.FirstLook)[0].fulfilled == ["in_gripper"]
    assert not any("Thank you" in each for each in said(events))
    assert said(events)[2].startswith("I have the part 1 between my fingers.")
    assert not any(each.helped for each in of_type(events, ev.Resolved))


async def test_who_hands_it_over_is_thanked() -> None:
    _, events = await run_with("unreachable", 1, ["yes"], times=1)
    [resolved] = of_type(events, ev.Resolved)
    assert resolved.helped
    assert said(events)[-1] == "Thank you. I have the part 1 between my fingers. I go on."


async def test_a_helper_has_time_before_a_look_that_could_not_tell_help_from_none() -> None:
    _, events = await run_with("missed", 4, ["yes"] * 50, wrong=True)
    awaited = of_type(events, ev.HelpAwaited)[0]
    verified = of_type(events, ev.HelpVerified)[0]
    assert verified.time - awaited.time >= 10.0


async def test_who_answers_before_the_first_look_has_as_much_time(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(answering, "DEFAULT_DELAY_S", 0.0)
    _, events = await run_with("missed", 4, ["yes"] * 50, wrong=True, person={"never": 1.0})
    looked, awaited = of_type(events, ev.FirstLook)[0], of_type(events, ev.HelpAwaited)[0]
    assert events.index(awaited) < events.index(looked)
    assert looked.fulfilled == ["in_reach"]
    assert of_type(events, ev.HelpVerified)[0].time - awaited.time >= 10.0
    assert not any(each.helped for each in of_type(events, ev.Resolved))


async def test_who_promises_before_the_first_look_and_does_it_is_thanked(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(answering, "DEFAULT_DELAY_S", 0.0)
    _, events = await run_with("dropped", 4, ["yes"], times=1, person={"delay_s": 0.0})
    looked, awaited = of_type(events, ev.FirstLook)[0], of_type(events, ev.HelpAwaited)[0]
    done = of_type(events, ev.InterventionDone)[0]
    assert events.index(awaited) < events.index(looked) < events.index(done)
    assert of_type(events, ev.Resolved)[0].helped


@pytest.mark.parametrize("answers", ["none", ["yes"]])
async def test_who_puts_it_right_before_the_first_look_is_thanked(
    answers: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(answering, "DEFAULT_DELAY_S", 0.0)
    person = {"never": 1.0}
    _, events = await run_with(
        "dropped", 4, answers, times=1, person=person, wrong=True, brought=True
    )
    [resolved] = of_type(events, ev.Resolved)
    assert (resolved.resolution, resolved.helped) == (Resolution.ROBOT_RETRY, True)
    assert "Thank you." in said(events)[-1]
    assert not any(each.failed_attempt for each in of_type(events, ev.NodeReset))


async def test_where_nobody_can_say_who_put_it_there_nobody_says_so(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(answering, "DEFAULT_DELAY_S", 0.0)
    _, events = await run_with(
        "dropped", 4, ["yes"], times=1, person={"never": 1.0}, wrong=True, brought=None
    )
    assert not any(each.helped for each in of_type(events, ev.Resolved))
    assert said(events)[2] == (
        "I see the part 1 within my reach now. I try again (still attempt 1 of 3)."
    )
    [reset] = of_type(events, ev.NodeReset)
    assert (reset.failed_attempt, reset.reason) == (
        False,
        "nobody can say whether anybody has helped",
    )


async def test_nobody_can_say_that_again_and_again(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(answering, "DEFAULT_DELAY_S", 0.0)
    person = {"never": 1.0}
    view, events = await run_with(
        "dropped", 4, ["yes"] * 50, person=person, wrong=True, brought=None
    )
    assert view.status is RunStatus.FAILED
    resets = [each.failed_attempt for each in of_type(events, ev.NodeReset)]
    assert resets == [False, True, True, True]


async def test_operators_hear_of_a_robot_that_is_wrong_also_where_no_is_said_at_once(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(answering, "DEFAULT_DELAY_S", 0.0)
    _, events = await run_with("missed", 4, ["no"] * 50, wrong=True)
    assert of_type(events, ev.FirstLook) == []
    [alarm] = of_type(events, ev.SuspectedFalseAlarm)
    assert (alarm.object, alarm.issue, alarm.times) == ("part_1", "missed", 2)


@pytest.mark.parametrize("delay_s", [0.0, 5.0])
async def test_what_is_seen_out_of_reach_is_no_false_alarm(
    delay_s: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(answering, "DEFAULT_DELAY_S", delay_s)
    _, events = await run_with("unreachable", 0, ["no"] * 50)
    raised = of_type(events, ev.IssueRaised)
    assert [each.outlook.unchanged for each in raised] == [1, 2, 3]
    assert all(each.last_seen is not None for each in raised)
    assert [bool(each.fulfilled) for each in of_type(events, ev.FirstLook)] in ([], [False] * 3)
    assert of_type(events, ev.SuspectedFalseAlarm) == []


async def test_other_leaves_go_first_after_a_failure_of_the_robots_own() -> None:
    _, events = await run_with("missed", 4, "none", times=1, goal="and", wrong=True)
    started = [each.name for each in of_type(events, ev.NodeStarted)]
    assert started == ["part_1", "part_2", "part_1"]
    assert said(events)[1] == (
        "I heard no answer. I go on with the part 2 first, then I try again (attempt 2 of 3)."
    )


async def test_a_leaf_that_has_failed_as_often_may_go_first() -> None:
    faults = {part: [("missed", 4)] * 9 for part, _ in NAMES}
    tree = definition_of({"and": LEAVES})
    async with pretend_service(tree, faults, scene=SCENE, policy=OPERATED, wrong=True) as service:
        _, events = await service.run_to_end(answers="none", max_attempts=2)
    effects = [each.timeout_effect for each in of_type(events, ev.Prompt) if each.version == 1]
    assert "I go on with the part 2 first, then I try again (attempt 2 of 2)" in effects[0]
    assert "or I go on with the part 1 before that" in effects[2]


async def test_what_was_felt_is_withdrawn_by_no_look() -> None:
    _, events = await run_with("blocked", 6, "none", times=1, felt=True)
    assert [each.reason for each in of_type(events, ev.DialogueClosed)] == ["gave_up"]


async def test_what_was_felt_takes_a_word_and_a_look_and_is_believed_once() -> None:
    _, events = await run_with("blocked", 6, ["yes"] * 50, felt=True, stubborn=True)
    resolved = of_type(events, ev.Resolved)
    assert [(each.resolution, each.helped) for each in resolved[:2]] == [
        (Resolution.ROBOT_FINISH, False),
        (Resolution.ROBOT_RETRY, False),
    ]
    assert len(of_type(events, ev.SuspectedFalseAlarm)) == 1
    assert "Thank you" not in said(events)[2]


async def test_a_seen_obstruction_that_is_gone_is_thanked_for() -> None:
    _, events = await run_with("blocked", 6, ["yes"], times=1)
    [resolved] = of_type(events, ev.Resolved)
    assert (resolved.resolution, resolved.helped) == (Resolution.ROBOT_FINISH, True)
    assert said(events)[-1] == "Thank you. I see my way free. I go on."


async def test_a_part_is_left_out_as_a_helper_said() -> None:
    answers = ["no", "no", "no", "no", "yes"]
    view, events = await run_with("missed", 4, answers, wrong=True, hidden_at_place={"part_1"})
    assert view.status is RunStatus.FINISHED
    [left] = of_type(events, ev.NodeLeftOut)
    assert (left.node, left.helper) == ("/0", "script")
    assert view.result is not None
    assert [(each.object, each.left_out_by) for each in view.result.missing] == [
        ("part_1", "script")
    ]


@pytest.mark.parametrize(
    ("answers", "by"), [("none", "robot"), (["no"], "robot"), (["yes"], "both")]
)
async def test_placing_is_the_work_of_both_only_if_somebody_says_so(answers: Any, by: str) -> None:
    _, events = await run_with("positioning", 5, answers, times=1)
    done = of_type(events, ev.NodeDone)[0]
    assert (done.name, done.by) == ("part_1", by)
    assert [each.helped for each in of_type(events, ev.Resolved)] in ([], [by == "both"])


async def test_every_question_says_what_silence_leads_to() -> None:
    _, events = await run_with("missed", 4, "none")
    asks = [each for each in of_type(events, ev.Prompt) if each.kind == "ask"]
    told = [each.timeout_effect for each in asks[:3]]
    failed = "Attempt 1 of 3 has failed, and I try again (attempt 2 of 3)."
    assert told == [
        f"I ask again; if nobody answers at all: {failed}",
        f"I write to the operators; if nobody answers at all: {failed}",
        failed,
    ]
    assert asks[-1].timeout_effect == (
        "Attempt 3 of 3 has failed, and the task ends here, unfinished."
    )


@pytest.mark.parametrize("delay_s", [20.0, 40.0, 59.0])
async def test_who_takes_longer_than_the_deadline_is_heard_when_asked_again(
    delay_s: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(answering, "DEFAULT_DELAY_S", delay_s)
    policy = EscalationPolicy(repeats=1, answer_within_s=30.0)
    faults = {"part_1": [("missed", 4)]}
    async with pretend_service(
        definition_of({"then": LEAVES}), faults, scene=SCENE, policy=policy
    ) as service:
        view, events = await service.run_to_end(answers=["yes"] * 9)
    assert view.status is RunStatus.FINISHED
    asked, answered = of_type(events, ev.Prompt)[0], of_type(events, ev.Answered)[0]
    assert answered.time == pytest.approx(asked.time + delay_s, abs=0.1)
    assert [each.helped for each in of_type(events, ev.Resolved)] == [True]


@pytest.mark.parametrize(("delay_s", "by"), [(0.5, "both"), (1.5, "both"), (30.0, "robot")])
async def test_a_script_may_say_yes_until_the_gripper_opens(
    delay_s: float, by: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(answering, "DEFAULT_DELAY_S", delay_s)
    _, events = await run_with("positioning", 5, ["yes"] * 9, times=1)
    assert of_type(events, ev.NodeDone)[0].by == by
    [closed] = of_type(events, ev.DialogueClosed)
    release = next(each for each in of_type(events, ev.StepStarted) if each.phase == "release")
    assert events.index(closed) < events.index(release)
    assert closed.reason == ("resolved" if by == "both" else "aborted")
