"""The judge of dialogues catches what is untrue, and passes what is true."""

import math
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from typing import Any
from uuid import UUID

import pytest
from dialogue_judge import DialogueJudge
from dialogue_record import Moment
from sample_events import RUN, WALL_TIME
from task_documents import definition_of
from untruths import Rest

from mend.dialogue import missing
from mend.dialogue.script import Help, HelpState
from mend.server.journal import events as ev
from mend.sim.tabletop.layout import lay_out
from mend.tasks.intervention import Act, Intervention
from mend.tasks.scene import Base, Scene

NAMES = [("part_1", "spot_1"), ("part_2", "spot_2")]
SCENE = lay_out(NAMES, seed=1)
LEAVES = [{"behavior": "pick_and_place", "object": part, "place": spot} for part, spot in NAMES]
DIALOGUE = UUID("22222222-2222-4222-8222-222222222222")


def start_of(part: str) -> Rest:
    pose = SCENE.objects[part].pose
    return Rest(pose.x, pose.y, SCENE.table.height if pose.z is None else pose.z)


def place_of(part: str) -> Rest:
    pose = SCENE.places[dict(NAMES)[part]].pose
    return Rest(pose.x, pose.y, SCENE.table.height if pose.z is None else pose.z)


STARTS = Moment({part: start_of(part) for part, _ in NAMES}, frozenset(), blocked=False)
GONE = replace(STARTS, resting={**STARTS.resting, "part_1": None})
PLACED = replace(STARTS, resting={**STARTS.resting, "part_1": place_of("part_1")})
FAR = replace(STARTS, resting={**STARTS.resting, "part_1": Rest(5.0, 5.0, SCENE.table.height)})
HELD = replace(STARTS, held=frozenset({"part_1"}))
BLOCKED = replace(STARTS, blocked=True)
TOPPLED = replace(
    STARTS, resting={**STARTS.resting, "part_1": replace(start_of("part_1"), lean_rad=1.57)}
)
CROWDED = replace(STARTS, resting={**STARTS.resting, "part_2": place_of("part_1")})


def not_seen_in_reach() -> str:
    """As the script of `missing` has it, so that the judge listens to what is really said."""
    state = missing.script.make(missing.script.parameters()).states[Help.PUT_BACK]
    assert isinstance(state, HelpState)
    return state.not_seen.replace("{object}", "part 1")


@dataclass
class Told:
    """A run that is told event by event, each with the world as it then is."""

    world: Moment = STARTS
    time_s: float = 0.0
    events: list[ev.Event] = field(default_factory=list)
    moments: list[Moment] = field(default_factory=list)

    def add(self, event: type[Any], /, **fields: Any) -> "Told":
        stamp: dict[str, Any] = {"time": self.time_s, "wall_time": WALL_TIME, "run": RUN}
        stamp["seq"] = len(self.events) + 1
        node: dict[str, Any] = {"node": "/0", "name": "part_1"}
        dialogue = {"dialogue": DIALOGUE, "robot": "robot", "issue": "missed", "object": "part_1"}
        known = stamp | node | dialogue
        given = {name: each for name, each in known.items() if name in event.model_fields}
        self.events.append(event.model_validate(given | fields))
        self.moments.append(self.world)
        return self

    def begin(
        self,
        scene: Scene = SCENE,
        world: str = "tabletop",
        robots: Sequence[str] = ("robot",),
        kind: str = "then",
    ) -> "Told":
        self.add(
            ev.RunStarted,
            tree_name="tree",
            tree=definition_of({kind: LEAVES}).model_dump(mode="json"),
            scene=scene.model_dump(mode="json"),
            world=world,
            robots=list(robots),
            seed=1,
            speed="max",
            scenario=None,
            options={},
        )
        return self.start()

    def start(self, node: str = "/0", name: str = "part_1") -> "Told":
        return self.add(
            ev.NodeStarted,
            node=node,
            name=name,
            boot="1",
            execution=RUN,
            attempt=1,
            candidates=[],
        )

    def alarm(self, issue: str = "missed") -> "Told":
        self.add(
            ev.IssueRaised,
            issue=issue,
            place="spot_1",
            execution=RUN,
            step=4,
            interrupts=True,
        )
        return self.add(ev.DialogueOpened, issue=issue)

    def say(self, text: str, *, issue: str = "missed", **fields: Any) -> "Told":
        asks = text.endswith("?")
        return self.add(
            ev.Prompt,
            issue=issue,
            prompt=RUN,
            version=1,
            kind="ask" if asks else "say",
            text=text,
            **fields,
        )

    def now(self, world: Moment, after_s: float = 0.0) -> "Told":
        self.world, self.time_s = world, self.time_s + after_s
        return self

    def deed(self, act: Act, part: str | None = "part_1", **fields: Any) -> "Told":
        place = "spot_1" if act is Act.PLACE else None
        done = Intervention(act=act, object=part, place=place)
        return self.add(
            ev.InterventionDone, act=act, object=part, intervention=done, by="helper", **fields
        )

    def reset(self, *, failed: bool) -> "Told":
        return self.add(ev.NodeReset, reason="", failed_attempt=failed)

    def close(self, reason: str = "gave_up") -> "Told":
        return self.add(ev.DialogueClosed, reason=reason)

    def wrong(self) -> list[str]:
        return [each.why for each in DialogueJudge(self.events, self.moments).judge()]


def told(
    world: Moment = STARTS,
    issue: str = "missed",
    scene: Scene = SCENE,
    robots: Sequence[str] = ("robot",),
) -> Told:
    """A run in which part_1 has just met an issue, while the world was so."""
    return Told().begin(scene, robots=robots).now(world, 10.0).alarm(issue)


@pytest.mark.parametrize(
    ("robots", "hidden"), [(("robot", "other"), False), (("other", "robot"), True)]
)
def test_of_several_robots_each_is_judged_by_what_its_own_camera_shows(
    robots: Sequence[str], hidden: bool
) -> None:
    x, y = SCENE.table.center
    tall = SCENE.objects["part_2"].model_copy(update={"size": (0.10, 0.10, 0.30)})
    bases = {"here": Base(x=0.0, y=0.0), "across": Base(x=2 * x, y=2 * y, yaw=math.pi)}
    objects = {**SCENE.objects, "part_2": tall}
    scene = SCENE.model_copy(update={"objects": objects, "robots": bases})
    part, table_z = start_of("part_1"), SCENE.table.height
    behind = replace(
        STARTS, resting={"part_1": part, "part_2": Rest(part.x + 0.12, part.y, table_z)}
    )
    judged = told(behind, "missing", scene, robots).say("I cannot find the part 1. Hm?").wrong()
    assert (judged == []) is hidden


@pytest.mark.parametrize("equal", [True, False])
def test_of_equal_parts_any_may_be_the_one_that_is_gone(equal: bool) -> None:
    like = SCENE.objects["part_1"] if equal else SCENE.objects["part_2"]
    second = like.model_copy(update={"pose": SCENE.objects["part_2"].pose})
    scene = SCENE.model_copy(update={"objects": {**SCENE.objects, "part_2": second}})
    other_gone = replace(STARTS, resting={**STARTS.resting, "part_2": None})
    judged = told(other_gone, "missing", scene).say("I cannot find the part 1. Hm?").wrong()
    assert (judged == []) is equal


def test_what_something_tall_hides_from_the_head_camera_need_not_be_seen() -> None:
    tall = SCENE.objects["part_2"].model_copy(update={"size": (0.05, 0.05, 0.4)})
    scene = SCENE.model_copy(update={"objects": {**SCENE.objects, "part_2": tall}})
    part = STARTS.resting["part_1"]
    assert part is not None
    # The camera looks from the side of the robot.
    for near_m, wrong in ((-0.06, []), (0.06, ["it lies on the table"])):
        beside = replace(part, x=part.x + near_m)
        world = replace(STARTS, resting={"part_1": part, "part_2": beside})
        assert told(world, "missing", scene).say("I cannot find the part 1. Hm?").wrong() == wrong


@pytest.mark.parametrize(
    ("world", "x", "y", "wrong"),
    [("tabletop", 0.5, -0.3, 1), ("workcell", 0.5, -0.3, 1), ("workcell", 0.99, 0.49, 0)],
)
def test_what_lies_beside_the_picture_need_not_be_seen(
    world: str, x: float, y: float, wrong: int
) -> None:
    """The PR2's camera does not show the left end of its table."""
    at = Rest(x, y, SCENE.table.height)
    moved = replace(STARTS, resting={**STARTS.resting, "part_1": at})
    run = Told().begin(SCENE, world).now(moved, 10.0).alarm("missing")
    assert len(run.say("I cannot find the part 1. Hm?").wrong()) == wrong


@pytest.mark.parametrize(
    ("text", "true", "untrue"),
    [
        ("I missed the part 1.", STARTS, HELD),
        ("I lost hold of the part 1.", GONE, HELD),
        ("I have the part 1 between my fingers.", HELD, STARTS),
        ("I do not see the part 1 between my fingers yet. Hm?", STARTS, HELD),
        ("I cannot find the part 1. Hm?", GONE, STARTS),
        ("I cannot reach the part 1. The part 1 has toppled over. Hm?", TOPPLED, STARTS),
        ("I cannot go on with the top. Can you clear the way?", BLOCKED, STARTS),
        ("I cannot go on with the top. Can you clear the way?", CROWDED, STARTS),
        (
            "I cannot go on with the top. Part 1 is in the arm's way. Can you clear the way?",
            STARTS,
            GONE,
        ),
        ("I felt something hold up my arm and stopped. Hm?", BLOCKED, STARTS),
        ("I do not see my way free yet. Hm?", BLOCKED, STARTS),
        ("I see nothing in my way now.", STARTS, BLOCKED),
        ("I see the part 1 at its place now.", PLACED, STARTS),
        ("I see the part 1 at its place now.", PLACED, GONE),
        ("I do not see the part 1 at its place yet. Hm?", STARTS, PLACED),
        ("The part 1 is not at its place. Hm?", GONE, PLACED),
        ("The part 1 is not at its place, and I see it nowhere. Hm?", GONE, STARTS),
        ("I have now seen once that the part 1 is not at its place.", GONE, PLACED),
        ("I see the part 1 within my reach now.", STARTS, GONE),
        ("I see the part 1. I go on.", STARTS, GONE),
        ("I see the part 1, where I saw it after I asked.", STARTS, HELD),
    ],
)
def test_what_is_said_of_the_world_is_compared_with_it(
    text: str, true: Moment, untrue: Moment
) -> None:
    assert told(true).say(text).wrong() == []
    assert len(told(untrue).say(text).wrong()) == 1


def test_what_has_lain_in_the_open_for_long_must_not_be_told_to_be_away() -> None:
    text = not_seen_in_reach()
    assert told(GONE).say(text).wrong() == []
    assert told(GONE).now(STARTS).deed(Act.PUT_BACK).now(STARTS, 0.5).say(text).wrong() == []
    assert told(GONE).now(STARTS).deed(Act.PUT_BACK).now(STARTS, 5.0).say(text).wrong() == [
        "it lies there"
    ]
    assert told(GONE).now(FAR).deed(Act.PUT_BACK).now(FAR, 5.0).say(text).wrong() == []


def test_what_is_seen_instead_of_help_is_compared_with_where_it_is() -> None:
    nowhere, unmoved, elsewhere = (
        "I do not see the part 1 where I can reach it yet. " + each
        for each in (
            "I do not see it at all. I keep watching.",
            "I see it where it was after I asked. I keep watching.",
            "I see it, but not there. I keep watching.",
        )
    )
    assert told(GONE).say(nowhere).wrong() == []
    lies = told(GONE).now(STARTS).deed(Act.PUT_BACK).now(STARTS, 5.0)
    assert lies.say("I do not see it at all.").wrong() == ["it lies there"]
    look: dict[str, Any] = {"fulfilled": [], "position": (5.0, 5.0, 0.7)}
    assert told(FAR).add(ev.FirstLook, **look).say(unmoved).wrong() == []
    moved = told(FAR).add(ev.FirstLook, **look).now(STARTS).say(unmoved).wrong()
    assert len(moved) == 1
    assert "it has moved" in moved[0]
    assert told(FAR).say(elsewhere).wrong() == []
    assert told(GONE).say(elsewhere).wrong() == ["it is not on the table"]


def test_who_says_to_look_before_it_goes_on_has_not_said_to_go_on() -> None:
    for text, wrong in (("I go on.", ["it was put back"]), ("I look again before I go on.", [])):
        run = told().say(text).add(ev.NodeReset, reason="no help was seen", failed_attempt=False)
        assert run.wrong() == wrong


def test_what_is_waited_for_is_not_said_to_be_so() -> None:
    assert told(BLOCKED).say("Please clear the way. I wait until I see it free.").wrong() == []
    assert told(BLOCKED).say("I see my way free. I go on.").wrong() != []


@pytest.mark.parametrize(("at", "may_be_hidden"), [("in_place", True), ("neutral", False)])
def test_what_the_arm_hides_may_be_told_not_to_be_seen(at: str, may_be_hidden: bool) -> None:
    run = told(PLACED).add(ev.RobotHolding, at=at)
    wrong = run.say("I do not see the part 1 at its place yet. Hm?").wrong()
    assert (wrong == []) is may_be_hidden


def test_thanks_need_a_deed_for_the_part_since_the_question_was_put() -> None:
    thanks = "Thank you. I see the part 1. I go on."
    assert told().say(thanks).wrong() == ["nobody has done anything"]
    assert told().deed(Act.PUT_BACK).say(thanks).wrong() == []
    assert told().deed(Act.PUT_BACK, ok=False).say(thanks).wrong() != []
    assert told().deed(Act.PUT_BACK, "part_2").say(thanks).wrong() != []
    assert Told().begin().deed(Act.PUT_BACK).alarm().say(thanks).wrong() != []


def test_what_is_far_from_the_way_is_not_in_it() -> None:
    said = "I cannot go on with the top. Part 2 is in the arm's way. Can you clear the way?"
    far = replace(STARTS, resting={**STARTS.resting, "part_2": Rest(5.0, 5.0, 0.7)})
    near = replace(STARTS, resting={**STARTS.resting, "part_2": place_of("part_1")})
    assert told(far).say(said).wrong() == ["part_2 stands nowhere near its way"]
    assert told(near).say(said).wrong() == []


def test_who_takes_away_what_crowded_its_place_has_helped_as_well() -> None:
    thanks = "Thank you. I see the part 1 at its place."
    assert told(CROWDED).deed(Act.PUT_BACK, "part_2").now(PLACED).say(thanks).wrong() == []
    assert told().deed(Act.PUT_BACK, "part_2").now(PLACED).say(thanks).wrong() != []
    still = replace(PLACED, resting={**PLACED.resting, "part_2": place_of("part_1")})
    assert told(CROWDED).deed(Act.PLACE, "part_2").now(still).say(thanks).wrong() != []


@pytest.mark.parametrize(("said", "times"), [("once", 1), ("twice", 2), ("three times", 3)])
def test_how_often_something_happened_is_counted(said: str, times: int) -> None:
    run = Told().begin()
    for _ in range(times):
        run.alarm()
    text = f"I have now failed {said} to pick up the part 1."
    assert run.say(text).wrong() == []
    assert run.alarm().say(text).wrong() == [f"it happened {times + 1} times"]


def test_the_next_attempt_is_counted_and_must_come() -> None:
    text = "I heard no answer. I try again (attempt 2 of 3)."
    true = told().say(text).close().reset(failed=True).start()
    assert true.wrong() == []
    never = told().say(text).close().reset(failed=True)
    assert never.wrong() == ["it was never tried again"]
    miscounted = told().reset(failed=True).start().say(text).close().reset(failed=True).start()
    assert miscounted.wrong() == ["2 attempts have failed"]


@pytest.mark.parametrize("kind", ["then", "or"])
def test_where_an_alternative_is_seen_undone_another_try_may_never_come(kind: str) -> None:
    text = "I heard no answer. I try again (attempt 2 of 3)."
    told = Told().begin(kind=kind).alarm().say(text).close().reset(failed=True)
    told.add(ev.NodeUndone, node="/1", name="part_2", reason="part_2 is no longer at spot_2")
    assert told.wrong() == ([] if kind == "or" else ["it was never tried again"])


def test_whichever_other_part_was_promised_may_come_instead_of_the_next_attempt() -> None:
    text = "I try again (attempt 2 of 3), or I take the part 8, the part 9 or another part instead."
    never = told().say(text).close().reset(failed=True)
    assert never.wrong() == ["it was never tried again"]
    assert never.start("/1", "part_2").wrong() == []
    only = text.replace(", the part 9 or another part", "")
    unsaid = told().say(only).close().reset(failed=True).start("/1", "part_2")
    assert unsaid.wrong() == ["it was never tried again"]


def test_what_answers_lead_to_names_the_attempt_that_it_is() -> None:
    option = ev.AnswerOption(value="yes", effect="You put it back; I pick it up (attempt 2 of 3).")
    first = told().say("Hm?", answers=[option])
    assert first.wrong() == ["0 attempts have failed"]
    second = told().reset(failed=True).start().alarm().say("Hm?", answers=[option])
    assert second.wrong() == []
    silent = told().say("Hm?", timeout_effect="I try again (attempt 2 of 3).")
    assert silent.wrong() == []


def test_what_was_said_to_go_first_has_to() -> None:
    text = "All right. I go on with the part 2 first, then I try again (attempt 2 of 3)."
    run = told().say(text).close().reset(failed=True)
    assert replace_events(run).start("/1", "part_2").start().wrong() == []
    assert replace_events(run).start().wrong() == ["it was tried again before that"]
    done = replace_events(run).start().add(ev.NodeDone, node="/0", name="part_1", by="found")
    assert done.wrong() == []


def test_what_goes_first_may_be_named_by_its_place_but_only_once() -> None:
    first = "the part 2 for the spot 2"
    text = f"All right. I go on with {first} first, then I try again (attempt 2 of 3)."
    run = told().say(text).close().reset(failed=True)
    assert replace_events(run).start("/1", "part_2").start().wrong() == []
    twice = told().say(text.replace(first, "the part 2 or the part 2")).close().reset(failed=True)
    assert twice.start("/1", "part_2").start().wrong() == ["one of them is named twice"]


def test_what_does_as_well_has_to_be_where_it_is_said_to_be() -> None:
    text = "The part 1 is at the spot 1 already, which does as well."
    assert replace(told(), world=PLACED).say(text).wrong() == []
    assert told().say(text).wrong() != []
    assert replace(told(), world=PLACED).say(text.replace("spot 1", "spot 2")).wrong() != []


def replace_events(run: Told) -> Told:
    return Told(run.world, run.time_s, list(run.events), list(run.moments))


def test_the_end_that_was_announced_has_to_come() -> None:
    text = "I heard no answer. The task ends here, unfinished."
    run = told().say(text).close().reset(failed=True)
    assert replace_events(run).add(ev.RunFailed, reason="it failed", node="/0").wrong() == []
    assert replace_events(run).start().wrong() == ["the task went on"]


def test_who_says_to_go_on_does() -> None:
    text = "I see my way free. I go on."
    assert told().say(text).add(ev.RobotResumed, step=5).wrong() == []
    assert told().say(text).reset(failed=True).wrong() == ["it was put back"]


def test_what_is_said_to_be_left_out_is() -> None:
    text = "All right. I leave the part 1 out."
    left = told().say(text).add(ev.NodeLeftOut, helper="script")
    assert left.wrong() == []
    assert told().say(text).reset(failed=True).wrong() == ["it was not left out"]


def test_silence_must_not_be_told_of_an_answer() -> None:
    text = "I heard no answer."
    asked = told().say("Shall I try again?")
    assert replace_events(asked).say(text).wrong() == []
    answered = asked.add(ev.Answered, prompt=RUN, version=1, answer="yes", helper="ann")
    assert answered.say(text).wrong() == ["somebody has answered"]


def test_help_is_told_only_where_somebody_helped() -> None:
    helped = {"resolution": "robot_retry", "helped": True}
    assert told().add(ev.Resolved, **helped).wrong() == ["nobody has helped"]
    assert told().deed(Act.PUT_BACK).add(ev.Resolved, **helped).wrong() == []
    both = {"resolution": "collab_finish", "helped": True}
    assert told().add(ev.Resolved, **both).wrong() == ["nobody has helped"]
    yes = told().add(ev.Answered, prompt=RUN, version=1, answer="yes", helper="ann")
    assert yes.add(ev.Resolved, **both).wrong() == []


def test_who_has_done_it_is_told_truly() -> None:
    def done(run: Told, by: str) -> list[str]:
        return run.now(PLACED).add(ev.NodeDone, by=by).wrong()

    assert done(Told().begin(), "robot") == []
    assert done(Told().begin(), "human") == ["no person put it there"]
    assert done(Told().begin().deed(Act.PLACE), "human") == []
    assert done(Told().begin(), "both") == ["no person was heard to help"]
    taken = {"node": "/1", "name": "part_2", "helper": "ann", "until": 60.0, "was_at": None}
    of_person = Told().begin().add(ev.NodeTaken, **taken)
    human = {"node": "/1", "name": "part_2", "by": "human"}
    assert "no person put it there" in of_person.add(ev.NodeDone, **human).wrong()
    run = Told().begin().now(STARTS).add(ev.NodeDone, by="robot")
    assert len(run.wrong()) == 1
    assert "m off" in run.wrong()[0]


def test_only_what_is_said_first_is_counted_as_a_sentence() -> None:
    run = told(GONE).say("I missed the part 1. Shall I try again?")
    again = run.events[-1].model_copy(update={"version": 2})
    judge = DialogueJudge([*run.events, again], [*run.moments, run.world])
    assert judge.judge() == []
    assert judge.sentences == 1


def test_of_parts_that_nobody_can_tell_apart_any_will_do() -> None:
    text = "I see the part 1 at its place now."
    there = replace(GONE, resting={"part_1": None, "part_2": place_of("part_1")})
    run = told(there)
    assert len(replace_events(run).say(text).wrong()) == 1
    alike = dict.fromkeys(SCENE.objects, SCENE.objects["part_1"])
    scene = SCENE.model_copy(update={"objects": alike}).model_dump(mode="json")
    run.events[0] = run.events[0].model_copy(update={"scene": scene})
    assert run.say(text).wrong() == []


def test_a_robot_in_the_dark_says_so_and_one_in_the_light_does_not() -> None:
    dark = replace(STARTS, dark=True)
    said = "I cannot see what is on the table. The picture is black. Can you clear the view?"
    assert told(dark).say(said).wrong() == []
    assert told().say(said).wrong() == ["nothing covers the camera"]
    request = "Please clear the view. I wait until I see what is on the table."
    assert told(dark).say(request).wrong() == []
    now = "I see what is on the table now. I go on."
    assert told(dark).say(now).wrong() == ["the camera is covered"]
    thanks = "Thank you. I see what is on the table. I go on."
    assert told(dark).say(thanks).wrong() != []
    assert told(dark).now(STARTS).deed(Act.UNCOVER, None).say(thanks).wrong() == []
