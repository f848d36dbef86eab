"""A robot that drives: goes to places, stops before what is in its way, says so, and goes on."""

import math

import pytest
from cart_bench import PLACES, CartBench
from courtyard.cart import LIMITS, PERIOD_S, RADIUS_M, Cart
from courtyard.crowded import Crowded
from courtyard.patrol import Patrol
from hypothesis import given, settings
from hypothesis import strategies as st
from robot_bench import MODEL
from sampled import sample
from scripted_body import STARTS, ScriptedBody, catalogue

from mend.robots.arm.subsystem import ArmSubsystem
from mend.robots.base.behaviors.driving import NEAR_M, TURNED_RAD
from mend.robots.base.body import BasePose
from mend.robots.base.monitors import BaseView
from mend.robots.base.subsystem import BaseSubsystem
from mend.robots.base.ways import StraightWays
from mend.robots.catalogue import Catalogue
from mend.robots.execution.command_error import CommandError
from mend.robots.execution.monitor import for_view
from mend.robots.link.messages import (
    Finished,
    Holding,
    Interrupt,
    IssueDetected,
    Location,
    Look,
    Looked,
    Rejected,
    Resume,
    Resumed,
    SlowDown,
    Start,
    StepStarted,
    TakePicture,
)
from mend.robots.robot import Robot
from mend.tasks.frames import Frame
from mend.tasks.intervention import Act, Intervention
from mend.tasks.plugins import load_plugins
from mend.tasks.scene import Table

VISITOR_M = 0.25


def is_at(bench: CartBench, place: Location) -> bool:
    goal = BasePose(place.x, place.y, place.yaw)
    here = bench.cart.pose()
    return here.distance_m(goal) <= NEAR_M and here.turned_by_rad(goal) <= TURNED_RAD


def stand_in_the_way(bench: CartBench, ahead_m: float = 1.0) -> None:
    """One visitor does."""
    at, far_m = bench.cart.place, RADIUS_M + VISITOR_M + ahead_m
    x, y = at.x + far_m * math.cos(at.yaw), at.y + far_m * math.sin(at.yaw)
    bench.world.visitors = [(x, y, VISITOR_M)]


def bar_the_way(bench: CartBench) -> None:
    """Visitors stand all around it."""
    driving = bench.world.intervene(Intervention(act=Act.BLOCK))
    assert driving == "", "nobody gathers round who stands"


def gap_m(bench: CartBench) -> float:
    """Between the cart and the nearest visitor."""
    at = bench.cart.place
    gaps_m = [math.hypot(x - at.x, y - at.y) - radius for x, y, radius in bench.world.visitors]
    return min(gaps_m) - RADIUS_M


def test_it_says_that_it_reaches_for_nothing_and_keeps_clear_by_itself() -> None:
    hello = CartBench().robot.hello("1")
    assert (hello.reach, hello.room, hello.keeps_clear) == (None, None, True)
    assert "go_to" in hello.behaviors
    assert "pick_and_place" not in hello.behaviors


@pytest.mark.parametrize("place", PLACES)
def test_it_goes_to_a_place_and_faces_as_that_says(place: str) -> None:
    bench = CartBench()
    bench.start(place=place)
    bench.run()
    assert [each.type for each in bench.reports] == ["step_started", "finished"]
    assert bench.of(Finished) == [Finished(execution="e1")]
    assert is_at(bench, PLACES[place])


def test_a_target_that_the_command_gives_comes_before_the_place() -> None:
    bench = CartBench()
    target = Location(x=0.0, y=2.0, z=0.0, yaw=-1.0)
    start = Start(
        execution="e1", node="/0", behavior="go_to", parameters={"place": "near"}, target=target
    )
    bench.send(start)
    bench.run()
    assert is_at(bench, target)


def test_where_it_is_already_it_says_so_without_moving() -> None:
    bench = CartBench()
    bench.start(place="near")
    bench.run()
    before = bench.cart.place
    bench.start(place="near")
    bench.run()
    assert bench.of(Finished)[-1].found_in_place
    assert bench.cart.place == before


def test_it_goes_round_who_stands_in_its_way() -> None:
    bench = CartBench()
    bench.start(place="far")
    bench.run_for(0.5)
    stand_in_the_way(bench)
    while bench.robot.advance(PERIOD_S):
        assert gap_m(bench) > 0.0
    assert not bench.of(IssueDetected)
    assert is_at(bench, PLACES["far"])


def test_it_stops_where_its_way_is_barred_and_tells_of_it_after_a_while() -> None:
    bench = CartBench()
    bench.start(place="near")
    bench.run_for(0.5)
    bar_the_way(bench)
    issue = bench.run_until(IssueDetected)
    assert (issue.issue, issue.step, issue.interrupts, issue.jpeg) == ("blocked", 1, True, None)
    assert issue.detection is not None
    assert "in front of me for 5 s" in issue.detection.explanation
    bench.run()
    assert bench.of(Holding) == [Holding(execution="e1", at="neutral")]
    assert gap_m(bench) > 0.0


def test_a_base_that_comes_no_nearer_says_so(monkeypatch: pytest.MonkeyPatch) -> None:
    bench = CartBench()
    monkeypatch.setattr(bench.cart, "move", lambda _: None)
    bench.start(place="near")
    issue = bench.run_until(IssueDetected)
    assert (issue.issue, issue.interrupts) == ("blocked", True)
    assert issue.detection is not None
    short = "I am still 2.00 m off and turned by 0 degrees, and have come no nearer for a while"
    assert issue.detection.explanation == short
    bench.run()
    assert not bench.of(Finished)


def test_who_passes_by_is_waited_for_and_not_told_of() -> None:
    bench = CartBench()
    bench.start(place="near")
    bench.run_for(0.5)
    bar_the_way(bench)
    bench.run_for(3.0)
    assert not bench.cart.moving
    bench.world.visitors = []
    bench.run()
    assert not bench.of(IssueDetected)
    assert is_at(bench, PLACES["near"])


def test_it_looks_until_its_way_is_clear_and_goes_on_where_it_was() -> None:
    bench = CartBench()
    bench.start(place="near")
    bench.run_for(0.5)
    bar_the_way(bench)
    bench.run()
    bench.send(Look(expect="way_clear", within_s=2.0))
    bench.run()
    assert bench.of(Looked)[-1].fulfilled is False
    bench.world.visitors = []
    bench.send(Look(expect="way_clear", within_s=2.0))
    bench.run()
    assert bench.of(Looked)[-1].fulfilled is True
    bench.send(Resume(execution="e1"))
    bench.run()
    assert bench.of(Resumed) == [Resumed(execution="e1", step=1)]
    assert is_at(bench, PLACES["near"])


@settings(max_examples=sample(8, 60), deadline=None)
@given(
    x=st.floats(-1.0, 8.0),
    y=st.floats(-2.0, 8.0),
    after_s=st.floats(0.1, 6.0),
    ahead_m=st.floats(0.3, 2.0),
)
def test_it_never_touches_who_comes_into_its_way(
    x: float, y: float, after_s: float, ahead_m: float
) -> None:
    bench = CartBench()
    bench.send(
        Start(
            execution="e1",
            node="/0",
            behavior="go_to",
            parameters={"place": "near"},
            target=Location(x=x, y=y, z=0.0),
        )
    )
    bench.run_for(after_s)
    stand_in_the_way(bench, ahead_m)
    while bench.robot.advance(PERIOD_S):
        assert gap_m(bench) > 0.0
    assert bench.of(Finished) or bench.of(IssueDetected)


def test_an_interrupt_makes_it_brake_and_a_retreat_ends_it_where_it_stands() -> None:
    bench = CartBench()
    bench.start(place="near")
    bench.run_for(1.5)
    drove = bench.cart.place
    bench.send(Interrupt(retreat=False))
    assert not bench.of(Holding), "it still moves"
    bench.send(Resume(execution="e1"))
    bench.send(Interrupt(retreat=False))
    bench.run()
    assert not bench.cart.moving
    assert bench.of(Holding) == [Holding(execution="e1", at="neutral")]
    assert not bench.of(Resumed), "what was told before it stood is over"
    stood = bench.cart.place
    assert 0.0 < drove.distance_m(stood) <= LIMITS.speed_m_s**2 / (2 * LIMITS.acceleration_m_s2)
    bench.send(Interrupt(retreat=True))
    bench.run()
    assert bench.of(Holding)[-1] == Holding(execution="e1", at="neutral")
    assert bench.cart.place == stood
    bench.send(Resume(execution="e1"))
    assert "is not held" in bench.of(Rejected)[-1].reason


class Gates(StraightWays):
    """Ways through a gate that may be closed."""

    closed = False

    def path(self, here: BasePose, to: BasePose, *_: object) -> list[tuple[float, float]]:  # noqa: ARG002
        if self.closed:
            raise CommandError("the gate is closed, and there is no other way")
        return [(2.0, 2.0), (to.x, to.y)]


def test_it_takes_the_way_that_its_ways_give() -> None:
    bench = CartBench(ways=Gates())
    bench.start(place="far")
    nearest_m = math.inf
    while bench.robot.advance(PERIOD_S):
        nearest_m = min(nearest_m, bench.cart.pose().distance_m(BasePose(2.0, 2.0, 0.0)))
    assert nearest_m < 0.5
    assert is_at(bench, PLACES["far"])


def test_where_there_is_no_way_it_refuses_or_tells_of_it_with_the_reason() -> None:
    gates = Gates()
    bench = CartBench(ways=gates)
    bench.start(place="far")
    bench.run_for(1.0)
    bench.send(Interrupt(retreat=False))
    bench.run()
    gates.closed = True
    bench.send(Resume(execution="e1"))
    issue = bench.run_until(IssueDetected)
    assert issue.issue == "blocked"
    assert issue.detection is not None
    assert issue.detection.explanation == "the gate is closed, and there is no other way"
    bench.send(Look(expect="way_clear", within_s=0.0))
    bench.run()
    assert bench.of(Looked)[-1].fulfilled is False
    bench.send(Interrupt(retreat=True))
    bench.run()
    bench.start(place="far")
    assert bench.of(Rejected)[-1].reason == "the gate is closed, and there is no other way"


def test_it_slows_down_as_it_is_told() -> None:
    fast, slow = CartBench(), CartBench()
    slow.send(SlowDown(factor=0.5))
    for bench in (fast, slow):
        bench.start(place="far")
        bench.run()
    assert slow.robot.time_s() > 1.8 * fast.robot.time_s()


def test_steps_that_were_driven_before_a_hold_are_not_driven_again() -> None:
    bench = CartBench(behaviors={"patrol": Patrol})
    bench.start("patrol", stops=["near", "corner"], wait_s=0.0)
    while len(bench.of(StepStarted)) < 2:
        bench.run_for(0.5)
    bench.send(Interrupt(retreat=False))
    bench.send(Resume(execution="e1"))
    bench.run()
    assert bench.of(Resumed) == [Resumed(execution="e1", step=2)]
    assert [each.step for each in bench.of(StepStarted)] == [1, 2, 2]
    assert is_at(bench, PLACES["corner"])


def test_a_monitor_of_its_own_slows_it_down_where_it_is_crowded() -> None:
    bench = CartBench(monitors={"crowded": Crowded})
    bench.start(place="near")
    bench.world.visitors = [(-4.0, -2.3, 0.28)]
    bench.run()
    issues = [(each.issue, each.interrupts) for each in bench.of(IssueDetected)]
    assert issues == [("crowded", False)]
    assert is_at(bench, PLACES["near"])


@pytest.mark.parametrize(
    ("command", "reason"),
    [
        (Look(expect="at_place", object="cup", place="near"), "cannot look for 'at_place'"),
        (TakePicture(camera="head"), "camera 'head' is unknown"),
        (
            Start(execution="e", node="/0", behavior="pick_and_place", parameters={}),
            "behavior 'pick_and_place' is unknown",
        ),
        (
            Start(execution="e", node="/0", behavior="go_to", parameters={"place": "moon"}),
            "place 'moon' is unknown",
        ),
        (
            Start(execution="e", node="/0", behavior="go_to", parameters={}),
            "go_to: place: Field required",
        ),
    ],
)
def test_what_it_cannot_do_it_refuses_with_a_sentence(command, reason: str) -> None:
    bench = CartBench()
    bench.send(command)
    (rejected,) = bench.of(Rejected)
    assert reason in rejected.reason


def test_it_shows_where_its_base_is() -> None:
    bench = CartBench()
    bench.start(place="near")
    bench.run()
    poses = bench.robot.poses()
    assert poses.base[:2] == pytest.approx((2.0, 0.0), abs=NEAR_M)
    assert bench.robot.pose_layout().objects == []


def test_each_kind_of_body_has_its_own_monitors() -> None:
    monitors = load_plugins("mend.monitors")
    of_bases = {each.issue for each in for_view(monitors.values(), BaseView)}
    assert "blocked" in of_bases
    assert not of_bases & {"missed", "dropped", "missing", "undone", "unreachable", "blind"}


class Wagon(ScriptedBody):
    """An arm on a cart: one body, one clock."""

    def __init__(self) -> None:
        super().__init__(STARTS)
        self.cart = Cart(Frame(-4.0, -3.0), self.time_s, lambda _: [], self.advance_cycle)

    def advance_cycle(self) -> None:
        super().advance_cycle()
        self.cart.advance()


def test_a_robot_with_an_arm_and_a_base_does_what_either_can_in_turn() -> None:
    behaviors, monitors = load_plugins("mend.behaviors"), load_plugins("mend.monitors")
    body, reports = Wagon(), []
    arm = ArmSubsystem(body, MODEL, catalogue(), behaviors, monitors)
    base = BaseSubsystem(body.cart, Catalogue({}, PLACES, Table()), behaviors, monitors)
    robot = Robot("both", body, [arm, base])
    robot.attach(lambda report, *_: reports.append(report), lambda _: None)
    hello = robot.hello("1")
    assert {"go_to", "pick_and_place"} <= set(hello.behaviors)
    assert hello.reach is not None
    assert not hello.keeps_clear
    told = {
        "go_to": {"place": "near"},
        "pick_and_place": {"object": "pink_bar", "place": "left"},
    }
    for number, behavior in enumerate(["go_to", "pick_and_place", "go_to"]):
        start = Start(
            execution=f"e{number}", node="/0", behavior=behavior, parameters=told[behavior]
        )
        robot.handle(f"c{number}", start)
        while robot.advance(1.0):
            pass
    finished = [each for each in reports if isinstance(each, Finished)]
    assert [(each.execution, each.found_in_place) for each in finished] == [
        ("e0", False),
        ("e1", False),
        ("e2", True),
    ]
    robot.handle("look", Look())
    while robot.advance(1.0):
        pass
    assert "pink_bar" in reports[-1].objects
    assert robot.poses().base[:2] == pytest.approx((2.0, 0.0), abs=NEAR_M)
    assert len(robot.pose_layout().objects) == len(catalogue().parts)


def test_two_subsystems_with_one_behavior_are_refused() -> None:
    bench = CartBench()
    behaviors, monitors = load_plugins("mend.behaviors"), load_plugins("mend.monitors")
    bases = [BaseSubsystem(bench.cart, catalogue(), behaviors, monitors) for _ in range(2)]
    with pytest.raises(ValueError, match="no two have a behavior of one name"):
        Robot("twice", bench.cart, bases)
