"""Follows what legs do, by what robots say alone: where every thing is, and what became of it."""

from collections.abc import Iterable

from mend.fleet.dispatch.dispatcher import Dispatcher
from mend.fleet.dispatch.leg import Leg, LegEnd, LegOutcome
from mend.fleet.requests import Escort, LegAction, RequestStatus, Transport

FETCHES = (LegAction.COLLECT, LegAction.MEET)
BRINGS = (LegAction.HAND_OVER, LegAction.ESCORT)
MAY_FOLLOW = {
    "booked": {"waiting", "under_way", "cancelled", "failed"},
    "waiting": {"booked", "under_way", "cancelled", "failed"},
    "under_way": {"booked", "waiting", "returning", "done", "cancelled", "failed"},
    "returning": {"done", "cancelled", "failed"},
}


class DispatchLedger:
    """Where things are, kept without the dispatcher's own states."""

    def __init__(self) -> None:
        self.holder: dict[str, str] = {}
        self.lies: dict[str, str] = {}
        self.baskets: dict[str, str] = {}
        """Where that is the basket of a robot that has failed: whose."""
        self.loads: dict[str, float] = {}
        self.delivered: set[str] = set()
        self.returned: set[str] = set()
        self.lost: set[str] = set()
        self.fetched: set[str] = set()
        self.statuses: dict[str, str] = {}

    def ended(self, leg: Leg, end: LegEnd, largest: float, capacity: float, now_s: float) -> None:
        """A leg has ended; raises `AssertionError` where it cannot have like that."""
        name, robot = leg.booking, leg.robot
        what = f"{robot}: {leg.action} {name} at {leg.place}: {end.outcome}"
        if end.outcome is LegOutcome.ITEM_LOST and (name in self.holder or name in self.lies):
            self.gone(name)
            self.lost.add(name)
        if end.outcome is not LegOutcome.DONE:
            return
        assert name not in self.delivered | self.returned | self.lost | self.fetched, what
        if leg.action is LegAction.TAKE and name in self.holder:
            # It came back while its things were fetched, and people took this one out all the same.
            assert self.baskets.pop(name, None) == self.holder[name] != robot, what
            self.holder[name] = robot
        elif leg.action in FETCHES and name not in self.lies:
            assert name not in self.holder, what
            assert now_s >= leg.request.earliest_s - 1e-6, what
            load = leg.request.load if isinstance(leg.request, Transport) else largest
            self.holder[name], self.loads[name] = robot, load
        elif leg.action is LegAction.TAKE or leg.action in FETCHES:
            assert self.lies.pop(name, None) == leg.place, what
            self.baskets.pop(name, None)
            self.holder[name] = robot
        elif leg.action is LegAction.GIVE:
            assert self.holder.pop(name, None) == robot, what
            self.lies[name] = leg.place
            self.baskets.pop(name, None)
        elif leg.action in BRINGS:
            assert self.holder.pop(name, None) == robot, what
            assert isinstance(leg.request, Escort | Transport), what
            assert leg.place.endswith(leg.request.destination), what
            self.delivered.add(name)
        elif leg.action is LegAction.BRING_BACK:
            assert self.holder.pop(name, None) == robot, what
            self.returned.add(name)
        else:
            self.delivered.add(name)
        aboard = [self.loads[each] for each, who in self.holder.items() if who == robot]
        assert sum(aboard) <= capacity + 1e-9, f"{what}: {robot} carries {sum(aboard)}"

    def failed(self, robot: str, place: str, lost: Iterable[str], led: Iterable[str]) -> None:
        """What a robot had lies where it stands, or is lost; whom it led is in no basket."""
        for name in [name for name, who in self.holder.items() if who == robot]:
            del self.holder[name]
            if name in lost:
                self.lost.add(name)
                continue
            self.lies[name] = place
            if name not in led:
                self.baskets[name] = robot

    def back(self, robot: str) -> None:
        """A robot works again, with what nobody has fetched meanwhile."""
        for name in [name for name, who in self.baskets.items() if who == robot]:
            if self.lies.pop(name, None) is not None:
                self.holder[name] = robot

    def gone(self, name: str) -> None:
        """No robot has it, and it lies nowhere."""
        self.holder.pop(name, None)
        self.lies.pop(name, None)
        self.baskets.pop(name, None)


class WitnessedDispatcher(Dispatcher):
    """A dispatcher whose ledger hears what it is told of robots."""

    ledger: DispatchLedger

    def ended(self, leg: Leg, end: LegEnd, now_s: float) -> None:
        super().ended(leg, end, now_s)
        robots = {each.name: each.capacity for each in self.setting.robots}
        largest = max(robots.values())
        self.ledger.ended(leg, end, largest, robots[leg.robot], now_s)

    def robot_failed(
        self, robot: str, at: str | None, reason: str, now_s: float, *, lost: Iterable[str] = ()
    ) -> None:
        stranded = self.stranded()
        led = {view.name for view in self.views() if isinstance(view.request, Escort)}
        super().robot_failed(robot, at, reason, now_s, lost=lost)
        place = self.building.graph.places[self.fleet.robots[robot].place].name
        kept = {name: self.ledger.holder.pop(name) for name in stranded & self.ledger.holder.keys()}
        self.ledger.failed(robot, place, set(lost), led)
        self.ledger.holder.update(kept)

    def robot_back(self, robot: str, at: str, now_s: float) -> None:
        super().robot_back(robot, at, now_s)
        self.ledger.back(robot)

    def item_lost(self, name: str, reason: str, now_s: float) -> None:
        super().item_lost(name, reason, now_s)
        self.ledger.gone(name)
        self.ledger.lost.add(name)

    def fetched(self, name: str, now_s: float) -> None:
        super().fetched(name, now_s)
        self.ledger.gone(name)
        self.ledger.fetched.add(name)

    def stranded(self) -> set[str]:
        return {name for name, item in self.fleet.items.items() if item.state == "stranded"}

    def check(self) -> None:
        """Everything that must hold at any moment."""
        plan = self.fleet.plan()
        assert (plan is None) == (not any(r.works for r in self.fleet.robots.values()))
        ledger, items = self.ledger, self.fleet.items
        numbers = list(self.fleet.robots)
        for view in self.views():
            was, now = ledger.statuses.get(view.name), str(view.status)
            if was is None:
                assert now in ("booked", "refused", "under_way", "waiting"), view
            elif was != now:
                assert leads(was, now), f"{view.name} was {was} and is {now}"
            ledger.statuses[view.name] = now
            if view.status is RequestStatus.DONE:
                assert view.name in ledger.delivered, view
            if view.status in (RequestStatus.FAILED, RequestStatus.REFUSED, RequestStatus.WAITING):
                assert view.reason, view
            over = view.status in (RequestStatus.CANCELLED, RequestStatus.FAILED)
            if over and isinstance(view.request, Escort):
                # An escort that is given up leaves its person alone.
                ledger.gone(view.name)
        for name, who in ledger.holder.items():
            assert items[name].state in ("aboard", "stranded"), (name, items[name])
            assert numbers[items[name].robot or 0] == who, (name, who)
        for name in ledger.lies:
            assert items[name].state in ("left", "stranded"), (name, items[name])
        for name, who in ledger.baskets.items():
            if name in ledger.lies:
                assert items[name].held_by == numbers.index(who), (name, who)
        aboard = {name for name, item in items.items() if item.state == "aboard"}
        assert aboard <= ledger.holder.keys()
        for view in self.views():
            name, closed = view.name, view.status in ("done", "refused", "cancelled", "failed")
            if closed and (name in ledger.holder or name in ledger.lies):
                assert items[name].state == "stranded", view
                assert view.reason, view
                assert "for a person to take it" in view.reason, view


def leads(was: str, now: str) -> bool:
    """Whether there is a way of legal steps: several may have come at the same moment."""
    seen, ahead = {was}, [was]
    while ahead:
        for status in MAY_FOLLOW.get(ahead.pop(), ()):
            if status not in seen:
                seen.add(status)
                ahead.append(status)
    return now in seen
