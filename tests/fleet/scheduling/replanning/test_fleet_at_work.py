"""A fleet at work through any events: plans pass the checker, nothing is lost or brought twice."""

from math import inf

from fleet_ledger import Ledger
from hypothesis import HealthCheck, settings
from hypothesis import strategies as st
from hypothesis.stateful import RuleBasedStateMachine, invariant, precondition, rule
from small_building import fleet_in_building

from mend.fleet.scheduling.problem import Item, Visit, Window
from mend.fleet.scheduling.replanning.events import (
    Cancelled,
    DoorClosed,
    Event,
    NewItem,
    RobotBack,
    RobotDelayed,
    RobotFailed,
    WayBlocked,
    WayOpen,
)
from mend.fleet.scheduling.replanning.item_state import ItemState

gaps = st.sampled_from((0.0, 1.0, 7.5, 20.0, 60.0))
numbers = st.integers(0, 10_000)


class FleetAtWork(RuleBasedStateMachine):
    """Draws events that make sense; the ledger follows by the log alone."""

    def __init__(self) -> None:
        super().__init__()
        self.fleet, graph = fleet_in_building()
        self.ways = [(way.a, way.b) for way in graph.ways]
        self.places = [place.name for place in graph.places]
        self.offices = [n for n, name in enumerate(self.places) if name.startswith("office")]
        self.ledger = Ledger()
        self.closed: list[tuple[str, str]] = []
        self.count = 0

    def happen(self, event: Event, gap_s: float) -> None:
        now_s = self.fleet.now_s + gap_s
        self.fleet.advance(now_s)
        self.ledger.follow(self.fleet)
        cost_free = self.fleet.apply(event, now_s)
        for why in (*cost_free.refused.values(), *cost_free.put_off.values()):
            assert why
            assert "\n" not in why

    def robots(self, *, work: bool) -> list[str]:
        return [name for name, robot in self.fleet.robots.items() if robot.works is work]

    def to_cancel(self) -> list[str]:
        items = self.fleet.items.items()
        return [name for name, item in items if item.open and not item.returns]

    @rule(
        gap_s=gaps, origin=numbers, step=st.integers(1, 9), patience=st.sampled_from((90, 900, inf))
    )
    def new_item(self, gap_s: float, origin: int, step: int, patience: float) -> None:
        self.count += 1
        count, now_s = len(self.offices), self.fleet.now_s + gap_s
        place, target = self.offices[origin % count], self.offices[(origin + step) % count]
        delivery = Visit(target, Window(0.0, now_s + patience), now_s + patience / 2)
        item = Item(f"new{self.count}", 1.0, Visit(place, service_s=4.0), delivery)
        self.happen(NewItem(item), gap_s)

    @precondition(lambda self: self.to_cancel())
    @rule(gap_s=gaps, which=numbers)
    def cancel(self, gap_s: float, which: int) -> None:
        self.fleet.advance(self.fleet.now_s + gap_s)
        names = self.to_cancel()
        if names:
            self.happen(Cancelled(names[which % len(names)]), 0.0)

    @precondition(lambda self: self.robots(work=True))
    @rule(gap_s=gaps, which=numbers, by_s=st.sampled_from((0.5, 15.0, 400.0)))
    def delay(self, gap_s: float, which: int, by_s: float) -> None:
        names = self.robots(work=True)
        self.happen(RobotDelayed(names[which % len(names)], by_s), gap_s)

    @precondition(lambda self: self.robots(work=True))
    @rule(gap_s=gaps, which=numbers, loses=st.booleans())
    def fail(self, gap_s: float, which: int, loses: bool) -> None:
        names = self.robots(work=True)
        name = names[which % len(names)]
        self.fleet.advance(self.fleet.now_s + gap_s)
        self.ledger.follow(self.fleet)
        aboard = [item for item, who in self.ledger.holder.items() if who == name]
        lost = frozenset(aboard[:1]) if loses else frozenset()
        self.happen(RobotFailed(name, lost), 0.0)
        self.ledger.failed(name)
        for item in lost:
            del self.ledger.baskets[item]
        for item in aboard:
            state = ItemState.LOST if item in lost else ItemState.LEFT
            assert self.fleet.items[item].state is state

    @precondition(lambda self: self.robots(work=False))
    @rule(gap_s=gaps, which=numbers, where=numbers)
    def come_back(self, gap_s: float, which: int, where: int) -> None:
        names = self.robots(work=False)
        place, name = self.places[where % len(self.places)], names[which % len(names)]
        self.fleet.advance(self.fleet.now_s + gap_s)
        self.ledger.follow(self.fleet)
        self.happen(RobotBack(name, place), 0.0)
        self.ledger.back(name)

    @rule(gap_s=gaps, which=numbers, for_a_while=st.booleans())
    def close(self, gap_s: float, which: int, for_a_while: bool) -> None:
        way = self.ways[which % len(self.ways)]
        if for_a_while:
            self.happen(DoorClosed(way, 45.0), gap_s)
        else:
            self.closed.append(way)
            self.happen(WayBlocked(way), gap_s)

    @precondition(lambda self: self.closed)
    @rule(gap_s=gaps)
    def open_again(self, gap_s: float) -> None:
        self.happen(WayOpen(self.closed.pop()), gap_s)

    @invariant()
    def plan_passes_the_checker(self) -> None:
        plan = self.fleet.plan()
        assert (plan is None) == (not self.robots(work=True))

    @invariant()
    def nothing_is_lost(self) -> None:
        self.ledger.follow(self.fleet)
        planned = {stop.item for stops in self.fleet.stops().values() for stop in stops}
        for name, item in self.fleet.items.items():
            assert (name in planned) == (item.open and item.put_off is None)
            holder = self.ledger.holder.get(name)
            assert (item.state is ItemState.ABOARD) == (holder is not None)
            if holder is not None:
                assert item.robot == list(self.fleet.robots).index(holder)
            assert (name in self.ledger.delivered) >= (item.state is ItemState.DELIVERED)

    def teardown(self) -> None:
        """In the end everything that has a place in the plan is where it belongs."""
        planned = [n for n, item in self.fleet.items.items() if item.open and not item.put_off]
        if self.robots(work=True):
            self.fleet.advance(self.fleet.now_s + 100_000.0)
            self.ledger.follow(self.fleet)
            assert set(planned) <= self.ledger.delivered


FleetAtWork.TestCase.settings = settings(
    deadline=None,
    max_examples=12,
    stateful_step_count=30,
    suppress_health_check=[HealthCheck.too_slow],
)
TestFleetAtWork = FleetAtWork.TestCase


def test_what_had_no_place_in_time_and_then_has_one_is_told_to_be_late() -> None:
    """Found by drawing: two long delays at once, and an item that is put off in between."""
    drawn = FleetAtWork()
    drawn.delay(gap_s=0.0, which=0, by_s=0.5)
    drawn.delay(gap_s=0.0, which=3, by_s=0.5)
    drawn.new_item(gap_s=20.0, origin=709, step=5, patience=900)
    drawn.new_item(gap_s=7.5, origin=1607, step=6, patience=900)
    drawn.delay(gap_s=60.0, which=1694, by_s=0.5)
    drawn.new_item(gap_s=60.0, origin=346, step=1, patience=90)
    drawn.delay(gap_s=0.0, which=0, by_s=0.5)
    drawn.new_item(gap_s=60.0, origin=861, step=7, patience=inf)
    drawn.new_item(gap_s=7.5, origin=856, step=6, patience=900)
    drawn.new_item(gap_s=0.0, origin=0, step=1, patience=90)
    drawn.new_item(gap_s=60.0, origin=0, step=1, patience=90)
    drawn.delay(gap_s=20.0, which=0, by_s=0.5)
    drawn.delay(gap_s=0.0, which=0, by_s=0.5)
    drawn.new_item(gap_s=7.5, origin=0, step=1, patience=90)
    drawn.delay(gap_s=0.0, which=0, by_s=400.0)
    robot = drawn.robots(work=True)[0]
    outcome = drawn.fleet.apply(RobotDelayed(robot, 400.0), drawn.fleet.now_s)
    assert "new5" in outcome.late
    drawn.plan_passes_the_checker()
    drawn.nothing_is_lost()
    drawn.teardown()
