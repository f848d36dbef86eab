"""The battery of one robot of a building: it drains with time and metres."""

from mend.documents.strict_model import StrictModel

IDLE_W = 60.0
DRIVE_J_PER_M = 120.0
CHARGER_W = 1500.0
_J_PER_WH = 3600.0


class BatterySnapshot(StrictModel):
    """What a battery is rebuilt from."""

    energy_j: float
    plugged: bool


class RobotBattery:
    """Implements `mend.robots.base.battery.Battery`; one of 0 Wh never runs out.

    `plugged`: somebody has plugged it in where it stands. `docked`: it stands at a charger.
    """

    def __init__(self, capacity_wh: float) -> None:
        self._capacity_j = capacity_wh * _J_PER_WH
        self._energy_j = self._capacity_j
        self.plugged = self.docked = False

    @property
    def endless(self) -> bool:
        """Whether it never runs out."""
        return self._capacity_j == 0.0

    @property
    def share(self) -> float:
        return 1.0 if self.endless else self._energy_j / self._capacity_j

    @property
    def charging(self) -> bool:
        return not self.endless and (self.plugged or self.docked)

    @property
    def empty(self) -> bool:
        """Whether it drives nothing any more."""
        return not self.endless and self._energy_j <= 0.0

    def pass_time(self, period_s: float, driven_m: float) -> None:
        """Some time has passed; who drives is no longer plugged in."""
        if driven_m > 0.0:
            self.plugged = False
        gained_w = (CHARGER_W if self.charging else 0.0) - IDLE_W
        energy_j = self._energy_j + gained_w * period_s - DRIVE_J_PER_M * driven_m
        self._energy_j = min(max(energy_j, 0.0), self._capacity_j)

    def stand(self, period_s: float, times: int) -> None:
        """Some periods have passed, one by one, without driving."""
        for _ in range(0 if self.endless else times):
            before_j = self._energy_j
            self.pass_time(period_s, 0.0)
            if self._energy_j == before_j:
                return

    def snapshot(self) -> BatterySnapshot:
        """What it is rebuilt from."""
        return BatterySnapshot(energy_j=self._energy_j, plugged=self.plugged)

    def restore(self, kept: BatterySnapshot) -> None:
        """Hold as much as then."""
        self._energy_j, self.plugged = kept.energy_j, kept.plugged
