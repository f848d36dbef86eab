"""What a building is kept as between two lives of its process."""

from mend.documents.strict_model import StrictModel
from mend.sim.building.belief import BeliefSnapshot
from mend.sim.building.elevator_bank import CabinSnapshot
from mend.sim.building.furniture import Row
from mend.sim.building.goods import ItemSnapshot, WishSnapshot
from mend.sim.building.guest import GuestSnapshot
from mend.sim.building.odometry import OdometerSnapshot
from mend.sim.building.robot_basket import BasketSnapshot
from mend.sim.building.robot_battery import BatterySnapshot
from mend.sim.building.walkers import WalkerSnapshot


class WorldSnapshot(StrictModel):
    """What a building is rebuilt from. Poses are floor, x, y, and of robots yaw."""

    time_s: float
    robots: list[tuple[str, float, float, float]]
    doors: dict[str, tuple[bool, float | None]]
    bystanders: list[tuple[str, float, float]]
    cabins: dict[str, CabinSnapshot]
    odometers: list[OdometerSnapshot]
    beliefs: list[BeliefSnapshot | None]
    # Older ones have none of these.
    barred: list[tuple[str, str]] = []
    items: dict[str, ItemSnapshot] = {}
    wishes: dict[int, WishSnapshot] = {}
    baskets: list[BasketSnapshot] = []
    batteries: list[BatterySnapshot] = []
    walkers: list[WalkerSnapshot] = []
    walkers_draws: str | None = None
    guests: dict[int, GuestSnapshot] = {}
    guests_draws: str | None = None
    companions: list[str] = []
    furniture: dict[str, list[Row]]
    furniture_moves_s: float
    carries_s: float | None
    draws: str
