"""A dispatcher whose robots, requesters and building do what is drawn, watched by a ledger.

It is killed now and then and goes on from the text of its snapshot.
"""

from collections import Counter
from random import Random

from dispatch_happenings import MIX, THINGS, DispatchHappenings, drawn_fleet
from dispatch_ledger import DispatchLedger, WitnessedDispatcher

from mend.fleet.dispatch.discrete_execution import DiscreteExecution, LegTimes
from mend.fleet.dispatch.snapshot import DispatcherSnapshot
from mend.maps.building.building import PlaceKind
from mend.sim.building.trips import BuildingTrips

HARD = LegTimes(fails=0.1, loses=0.01)
OVER = frozenset({"done", "refused", "cancelled", "failed"})


class DispatchOrdeal:
    """One drawn building with its fleet; `events`: what has happened so far.

    Raises `AssertionError` at once where something is so that must not be.
    """

    def __init__(
        self,
        seed: int,
        *,
        floors: int = 2,
        rooms: int = 8,
        robots: int = 3,
        kills: float = 0.03,
        gap_s: float = 60.0,
    ) -> None:
        self.building, self.setting = drawn_fleet(seed, floors=floors, rooms=rooms, robots=robots)
        self.events: list[str] = []
        self.killed = 0
        self._chance, self._kills, self._gap_s = Random(seed), kills, gap_s
        self._ledger = DispatchLedger()
        dispatcher = WitnessedDispatcher(self.building, self.setting)
        dispatcher.ledger = self._ledger
        trips = BuildingTrips(self.building)
        self.execution = DiscreteExecution(
            dispatcher, trips, HARD, Random(seed + 1), watch=self._watch
        )
        mix = THINGS if seed % 2 else MIX
        self._happenings = DispatchHappenings(self.building, Random(seed + 2), mix=mix)

    @property
    def dispatcher(self) -> WitnessedDispatcher:
        """The dispatcher that is there now."""
        dispatcher = self.execution.dispatcher
        assert isinstance(dispatcher, WitnessedDispatcher)
        return dispatcher

    def happen(self, times: int) -> None:
        """So many things happen, one after the other, while robots work."""
        for _ in range(times):
            gap_s = self._chance.expovariate(1.0 / self._gap_s)
            self.execution.run_until(self.execution.now_s + gap_s)
            self._watch(self._happenings.happen(self.dispatcher, self.execution.now_s))

    def come_to_rest(self) -> Counter[str]:
        """Nothing more happens, all robots work: everything comes to its end. How it ended."""
        room = self.building.of_kind(PlaceKind.ROOM)[0]
        for name, robot in self.dispatcher.fleet.robots.items():
            if not robot.works:
                self.dispatcher.robot_back(name, room, self.execution.now_s)
        self.execution.run_until(self.execution.now_s + 2 * self.setting.policy.longest_s)
        views = self.dispatcher.views()
        left = [view for view in views if view.status not in OVER]
        assert not left, f"these wait for ever: {left}"
        assert self.dispatcher.legs_under_way() == []
        self.dispatcher.check()
        return Counter(self._ledger.statuses.values())

    def actions(self) -> Counter[str]:
        """What was done how often."""
        done = (each for each in self.execution.records if each.outcome == "done")
        return Counter(str(each.leg.action) for each in done)

    def _watch(self, what: str) -> None:
        self.events.append(f"{self.execution.now_s:.1f} {what}")
        self.dispatcher.check()
        if self._chance.random() < self._kills:
            self._kill()

    def _kill(self) -> None:
        self.killed += 1
        before = self.dispatcher.snapshot()
        kept = DispatcherSnapshot.model_validate_json(before.model_dump_json())
        again = WitnessedDispatcher.restored(self.building, self.setting, kept)
        assert isinstance(again, WitnessedDispatcher)
        assert again.snapshot() == before, "what was restored is not equal"
        again.ledger = self._ledger
        again.check()
        self.execution.dispatcher = again
