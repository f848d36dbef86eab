"""The transcript tells every event so that a person can follow the run."""

from datetime import UTC, datetime
from pathlib import Path
from typing import Any, get_args
from uuid import UUID

import pytest
from languages_of_console import untold

from mend.dialogue.evidence import Change
from mend.dialogue.script import CloseReason, Help
from mend.robots.link.messages import Detection
from mend.server.access.roles import Role
from mend.server.journal import events as ev
from mend.server.transcript import Transcript
from mend.server.transcript_line import Line, Tone, grouped
from mend.server.transcript_words import finished_text, told_missing
from mend.tasks.autonomy import AutonomyLevel
from mend.tasks.intervention import Act, Intervention
from mend.tasks.resolution import Resolution
from mend.tasks.scene import Pose

RECORDED = Path(__file__).parent / "recorded" / "eket_paper.jsonl"
RUN, OTHER = UUID(int=1), UUID(int=2)
EVENT: dict[str, Any] = {"time": 12.34, "wall_time": datetime(2026, 1, 2, tzinfo=UTC), "run": RUN}
NODE = {**EVENT, "node": "/1/0", "name": "pink_bar"}
DIALOGUE = {**NODE, "dialogue": OTHER, "robot": "pr2", "issue": "dropped", "object": "pink_bar"}


def started(robots: list[str]) -> ev.RunStarted:
    return ev.RunStarted(
        **EVENT,
        tree_name="eket",
        tree={},
        scene={},
        world="tabletop",
        robots=robots,
        seed=7,
        speed="max",
        scenario=None,
        options={},
    )


def node_started(*potentials: float, attempt: int = 1) -> ev.NodeStarted:
    names = ["pink_bar", "yellow_bar", "blue_leg", "green_leg", "top"]
    return ev.NodeStarted(
        **NODE,
        robot="pr2",
        boot="b",
        execution=OTHER,
        attempt=attempt,
        candidates=[
            ev.Candidate(node=f"/1/{i}", name=names[i], level=1, potential=each, attempts=0)
            for i, each in enumerate(potentials)
        ],
    )


def told(event: ev.Event, robots: list[str] | None = None) -> list[str]:
    transcript = Transcript()
    transcript.lines(started(robots or ["pr2"]))
    return [line.opening + line.text for line in transcript.lines(event)]


def test_robot_speaks_its_prompts_and_the_helper_the_answers() -> None:
    ask = ev.Prompt(
        **DIALOGUE, prompt=OTHER, version=1, kind="ask", text="Shall I try again?", deadline=42.0
    )
    answer = ev.Answered(**DIALOGUE, prompt=OTHER, version=1, answer="no", helper="script")
    assert told(ask) == ["robot: Shall I try again?"]
    assert told(answer) == ["helper (script): no"]


def test_a_repeated_question_says_so_and_to_whom() -> None:
    ask = ev.Prompt(
        **DIALOGUE, prompt=OTHER, version=2, kind="ask", text="Shall I?", deadline=42.0, to="anna"
    )
    assert told(ask) == ["robot: Shall I? (asked again) (to anna)"]


def test_several_robots_are_called_by_their_ids() -> None:
    say = ev.Prompt(**DIALOGUE, prompt=OTHER, version=1, kind="say", text="Thank you.")
    assert told(say, robots=["pr2", "arm"]) == ["pr2: Thank you."]


def test_a_choice_names_the_best_rivals_and_counts_the_others() -> None:
    assert told(node_started(3.0)) == ["robot starts pink_bar"]
    assert told(node_started(3.0, 2.5, attempt=2)) == [
        "robot starts pink_bar, attempt 2 (potential 3.00, before yellow_bar 2.50)"
    ]
    assert told(node_started(3.0, 2.5, 2.0, 1.5, 1.0))[0].endswith(
        "before yellow_bar 2.50, blue_leg 2.00, green_leg 1.50 and 1 more)"
    )


def test_a_rival_with_failed_attempts_is_told_with_them() -> None:
    started = node_started(1.0, 2.5)
    tried = started.candidates[1].model_copy(update={"attempts": 2})
    event = started.model_copy(update={"candidates": [started.candidates[0], tried]})
    assert told(event) == [
        "robot starts pink_bar (potential 1.00, before yellow_bar 2.50 after 2 failed)"
    ]


def test_steps_of_one_execution_share_a_thread_and_other_lines_have_none() -> None:
    step = ev.StepStarted(**NODE, robot="pr2", execution=OTHER, step=3, step_name="close_gripper")
    assert Transcript().lines(step) == [
        Line(12.34, "pink_bar", "3 close gripper", Tone.STEP, thread=str(OTHER))
    ]
    assert Transcript().lines(node_started(1.0))[0].thread is None


def test_only_neighbours_of_one_thread_are_joined() -> None:
    def line(text: str, thread: str | None) -> Line:
        return Line(1.0, "a", text, Tone.STEP, thread)

    lines = [line("1", "x"), line("2", "x"), line("3", None), line("4", None), line("5", "x")]
    assert [[each.text for each in group] for group in grouped(lines)] == [
        ["1", "2"],
        ["3"],
        ["4"],
        ["5"],
    ]
    assert list(grouped([])) == []


def test_an_issue_says_where_and_why() -> None:
    detection = Detection(camera="forearm", explanation="no blob of pink_bar")
    raised = ev.IssueRaised(
        **NODE,
        robot="pr2",
        issue="dropped",
        object="pink_bar",
        place=None,
        execution=OTHER,
        step=5,
        interrupts=True,
        detection=detection,
    )
    assert told(raised) == ["issue: dropped pink_bar in step 5 (no blob of pink_bar)"]
    before = raised.model_copy(update={"step": 0, "detection": None, "issue": "missing"})
    assert told(before) == ["issue: missing pink_bar while it looks and plans"]


def test_a_vain_intervention_says_why() -> None:
    steal = Intervention(act=Act.STEAL, object="pink_bar", manner="pull")
    done = ev.InterventionDone(
        **EVENT,
        act="steal",
        object="pink_bar",
        intervention=steal,
        by="api",
        ok=False,
        detail="the gripper is empty",
    )
    assert told(done) == [
        "person (api) pulls pink_bar out of the gripper: in vain, the gripper is empty"
    ]


def test_who_clears_the_way_of_a_part_puts_that_aside() -> None:
    aside = Intervention(act=Act.RELEASE, object="pink_bar")
    event = ev.InterventionDone(
        **EVENT, act="release", object="pink_bar", intervention=aside, by="helper"
    )
    assert told(event) == ["person (helper) puts pink_bar aside"]


@pytest.mark.parametrize("act", Act)
def test_every_act_has_words(act: Act) -> None:
    without = {
        Act.BLOCK: "robot",
        Act.RELEASE: "robot",
        Act.COVER: "camera",
        Act.UNCOVER: "camera",
        Act.CHARGE: "robot",
        Act.BAR: "between F1/hall and F1/101",
        Act.CLEAR: "between F1/hall and F1/101",
        Act.SEND_PERSON: "to come",
        Act.MISDIRECT: "in lift",
    }
    object_name = None if act in without else "pink_bar"
    to = Pose(x=0.5, y=0.0) if act is Act.MOVE else None
    between = ("F1/hall", "F1/101") if act in (Act.BAR, Act.CLEAR) else None
    elevator = "lift" if act is Act.MISDIRECT else None
    intervention = Intervention(
        act=act, object=object_name, to=to, between=between, elevator=elevator
    )
    event = ev.InterventionDone(
        **EVENT, act=str(act), object=object_name, intervention=intervention, by="scenario"
    )
    (text,) = told(event)
    assert text.startswith("person (scenario) ")
    assert (object_name or without[act]) in text


@pytest.mark.parametrize("help_", Help)
def test_every_promise_is_looked_for_seen_or_not(help_: Help) -> None:
    awaited = ev.HelpAwaited(**DIALOGUE, help=help_, helper="script", until=40.0)
    (looks,), (sees,), (misses,) = (
        told(event)
        for event in (
            awaited,
            ev.HelpVerified(**DIALOGUE, help=help_),
            ev.HelpNotSeen(**DIALOGUE, help=help_),
        )
    )
    felt = help_ in (Help.PUT_IN, Help.TAKE_OUT, Help.CHARGE)
    assert looks.startswith("robot waits to feel " if felt else "robot looks for ")
    assert looks.endswith(" until 40.0 s")
    verb = "feel" if felt else "see"
    assert sees.startswith(f"robot {verb}s ")
    assert misses == sees.replace(f"{verb}s", f"does not {verb}")


@pytest.mark.parametrize("change", Change)
def test_whatever_has_changed_is_told_and_a_way_round_is_no_clear_way(change: Change) -> None:
    (sees,) = told(ev.HelpVerified(**DIALOGUE, help=Help.CLEAR_WAY, change=change))
    assert sees.startswith("robot sees ")
    assert ("the way clear" in sees) == (change is not Change.LED_ROUND)


@pytest.mark.parametrize("resolution", Resolution)
def test_every_resolution_is_named_and_explained(resolution: Resolution) -> None:
    (text,) = told(ev.Resolved(**DIALOGUE, resolution=resolution, helped=True))
    assert text.startswith(f"resolved by {resolution}: ")
    assert "pink_bar" in text


def test_a_dialogue_that_closes_resolved_adds_nothing_to_its_resolution() -> None:
    assert told(ev.DialogueClosed(**DIALOGUE, reason=CloseReason.RESOLVED)) == []


TOLD_OTHERWISE = (CloseReason.RESOLVED, CloseReason.LEFT_OUT)


@pytest.mark.parametrize("reason", [each for each in CloseReason if each not in TOLD_OTHERWISE])
def test_a_dialogue_that_ends_otherwise_says_so(reason: CloseReason) -> None:
    assert len(told(ev.DialogueClosed(**DIALOGUE, reason=reason))) == 1


def test_a_failed_attempt_is_told_apart_from_a_free_one() -> None:
    free = ev.NodeReset(
        **NODE, robot="pr2", reason="the robot will try again", failed_attempt=False
    )
    failed = free.model_copy(update={"reason": "nobody helped", "failed_attempt": True})
    assert told(free) == ["pink_bar is put back: the robot will try again"]
    assert told(failed) == ["pink_bar is put back, a failed attempt: nobody helped"]


def test_what_was_left_out_is_told_with_who_said_so() -> None:
    missing = [
        ev.MissingPart(node=f"/{i}", name=name, object=name, place=f"{name}_place", left_out_by=by)
        for i, (name, by) in enumerate([("top", "ann"), ("leg", "bob"), ("bar", "ann")])
    ]
    assert told(ev.RunFinished(**EVENT, missing=missing)) == [
        "top is not at top_place, as ann said",
        "leg is not at leg_place, as bob said",
        "bar is not at bar_place, as ann said",
        "the run has finished: the task is done without top and bar, as ann said "
        "and without leg, as bob said",
    ]


def test_what_an_older_mend_missed_is_told_without_a_helper() -> None:
    part = ev.MissingPart(node="/0", name="top", object="top", place="top_place")
    assert told(ev.RunFinished(**EVENT, missing=[part])) == [
        "top is not at top_place",
        "the run has finished: the task is done without top",
    ]


def test_a_leaf_that_is_done_no_longer_says_why() -> None:
    undone = ev.NodeUndone(**NODE, robot="pr2", reason="it is no longer at its place")
    assert told(undone) == ["pink_bar is done no longer: it is no longer at its place"]


def test_a_leaf_that_is_left_out_and_then_seen_is_told() -> None:
    left_out = ev.NodeLeftOut(**NODE, robot="pr2", helper="ann")
    assert told(left_out) == ["pink_bar is left out, as ann said"]
    assert told(ev.NodeReturned(**NODE, robot="pr2")) == [
        "robot sees pink_bar, which was left out, at its place"
    ]


def test_a_run_that_fails_or_is_aborted_says_why() -> None:
    assert told(ev.RunFailed(**EVENT, reason="'top' could not be done")) == [
        "the run has failed: 'top' could not be done"
    ]
    assert told(ev.RunAborted(**EVENT)) == ["the run was aborted: by a person"]


def test_who_paused_or_aborted_a_run_is_told_by_name() -> None:
    olga = ev.Author(principal="olga", role=Role.OPERATOR, address="10.0.0.7")
    nameless = ev.Author(principal="token", role=Role.ADMIN)
    assert told(ev.RunPaused(**EVENT, author=olga)) == ["the run is paused by olga"]
    assert told(ev.RunResumed(**EVENT, author=nameless)) == ["the run goes on"]
    assert told(ev.RunAborted(**EVENT, author=olga)) == ["the run was aborted: by olga"]
    assert told(ev.RunAborted(**EVENT, author=nameless)) == ["the run was aborted: by a person"]


def test_who_steers_a_run_and_why_is_told() -> None:
    said = {**NODE, "by": "ann", "reason": "the glue is wet"}
    assert told(ev.BreakpointSet(**said)) == [
        "ann sets a breakpoint before pink_bar (the glue is wet)"
    ]
    assert told(ev.LeafLetGo(**{**said, "reason": ""})) == ["ann lets pink_bar go on"]
    assert told(ev.AutonomySet(**EVENT, level=AutonomyLevel.LOW, by="ann")) == [
        "ann sets the autonomy to low"
    ]
    left = ev.NodeLeftOut(**NODE, robot=None, helper="ann", reason="it is broken")
    assert told(left) == ["pink_bar is left out, as ann said (it is broken)"]


def test_before_what_a_robot_waits_is_told_with_who_wanted_it() -> None:
    held = {**NODE, "robot": "pr2", "level": AutonomyLevel.LOW}
    assert told(ev.LeafHeld(**held, breakpoint="/1", by="ann")) == [
        "robot waits before pink_bar: breakpoint set by ann"
    ]
    assert told(ev.LeafHeld(**held, breakpoint=None)) == [
        "robot waits before pink_bar: with autonomy low it asks first"
    ]


def test_every_event_type_has_a_line_of_its_own_or_is_told_by_others() -> None:
    union = get_args(ev.AnyEvent)[0]
    registered = Transcript.__dict__["lines"].dispatcher.registry
    assert set(get_args(union)) <= set(registered)


def test_something_that_is_no_event_of_a_run_is_refused() -> None:
    with pytest.raises(TypeError, match="expected an event of the journal, got Event"):
        Transcript().lines(ev.Event(**EVENT))


def test_a_recorded_run_reads_in_order_from_beginning_to_end() -> None:
    transcript = Transcript()
    lines = [
        line
        for text in RECORDED.read_text().splitlines()
        for line in transcript.lines(ev.any_event.validate_json(text))
    ]
    assert [line.time_s for line in lines] == sorted(line.time_s for line in lines)
    assert lines[0].tone is Tone.RUN
    assert lines[-1].tone is Tone.FINISHED
    assert {line.speaker for line in lines if line.tone is Tone.SAID} == {"robot"}


def test_a_leaf_without_an_object_is_told_as_left_out_and_its_item_once() -> None:
    collected = ev.MissingPart(
        node="/0", name="collect", object="mail", place="F1-101", left_out_by="anna", nowhere=True
    )
    handed_over = collected.model_copy(update={"node": "/1", "name": "hand_over"})
    assert told_missing(collected) == "collect was left out, as anna said"
    assert finished_text([collected, handed_over]) == "the task is done without mail, as anna said"
    scripted = collected.model_copy(update={"left_out_by": "script"})
    told = [finished_text([each]) for each in (collected, scripted)]
    assert told[1] == "the task is done without mail, as the script said"
    assert untold([*told, told_missing(scripted)]) == []
