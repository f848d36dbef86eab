"""What clients see of sites."""

from datetime import datetime
from typing import Literal
from uuid import UUID

from mend.server.runtime.views import View
from mend.server.sites.requests import FleetOptions


class SiteRobot(View):
    """A robot of a site: what the scene calls it, and the run that has it."""

    robot: str
    stands: str
    connected: bool
    run: UUID | None


class SiteView(View):
    """An open site. `moved`: which part runs have left at which place.

    `fleet`: how its robots take requests; None where they take none.
    """

    id: UUID
    world: str
    scene: str
    seed: int
    speed: float | Literal["max"]
    opened: datetime
    robots: list[SiteRobot]
    moved: dict[str, str]
    fleet: FleetOptions | None = None
