"""What the journal keeps of a site's fleet, from which it goes on after a restart."""

from uuid import UUID

from mend.documents.strict_model import StrictModel
from mend.fleet.dispatch.leg import Finding
from mend.fleet.dispatch.snapshot import DispatcherSnapshot
from mend.fleet.requests import PlaceName


class Errand(StrictModel):
    """A robot that carries out no leg goes to a place, in a run of its own; `charges` there."""

    robot: str
    place: PlaceName
    run: UUID
    charges: bool = False


class ToldWay(StrictModel):
    """What was found of the way between two places, and who said so: a robot, or a person."""

    finding: Finding
    between: tuple[PlaceName, PlaceName]
    by: str | None

    @property
    def is_door(self) -> bool:
        """Whether it is a door that was found closed there."""
        return self.finding is Finding.DOOR_CLOSED


class FleetRecord(StrictModel):
    """A fleet at work; `out_of_service`: the robots that somebody has taken out, and why.

    `errands` and `closed_ways` are those that there are now; `held_cabins`: the elevators in whose
    cabins robots stay, by robot.
    """

    dispatcher: DispatcherSnapshot
    out_of_service: dict[str, str]
    errands: tuple[Errand, ...] = ()
    closed_ways: tuple[ToldWay, ...] = ()
    held_cabins: dict[str, str] = {}
