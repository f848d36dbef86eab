"""Follows a fleet at work by its log alone: where every item is, who has it, what became of it."""

from collections.abc import Sequence

from mend.fleet.scheduling.replanning.fleet_state import Done
from mend.fleet.scheduling.replanning.running_fleet import RunningFleet
from mend.fleet.scheduling.schedule import Action


class Ledger:
    """Where items are by what was done with them, kept without the fleet's own states."""

    def __init__(self) -> None:
        self.holder: dict[str, str] = {}
        self.baskets: dict[str, str] = {}
        """What lies in the basket of a robot that has failed: whose that is."""
        self.delivered: set[str] = set()
        self._read = 0

    def follow(self, fleet: RunningFleet) -> None:
        """Read what was done since the last time; raises `AssertionError` where it cannot be."""
        news: Sequence[Done] = fleet.log[self._read :]
        self._read = len(fleet.log)
        for done in news:
            what = f"{done.robot}: {done.action} {done.item} at {done.begin_s:g} s"
            assert done.item not in self.delivered, f"{what}, which was delivered before"
            if done.action in (Action.PICK, Action.TAKE):
                assert done.item not in self.holder, f"{what}, which another robot has"
                self.holder[done.item] = done.robot
                self.baskets.pop(done.item, None)
            else:
                assert self.holder.pop(done.item, None) == done.robot, f"{what}, but it has it not"
                if done.action is Action.DROP:
                    self.delivered.add(done.item)

    def failed(self, robot: str) -> None:
        """What a robot had lies where it stands, or is lost."""
        self.baskets |= {item: who for item, who in self.holder.items() if who == robot}
        self.holder = {item: who for item, who in self.holder.items() if who != robot}

    def back(self, robot: str) -> None:
        """It has again what nobody has fetched meanwhile."""
        kept = {item: who for item, who in self.baskets.items() if who == robot}
        self.holder |= kept
        self.baskets = {item: who for item, who in self.baskets.items() if item not in kept}
