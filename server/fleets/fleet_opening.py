"""Opening the fleet of a site: its robots, its plan, and what was kept of it."""

from collections.abc import Callable
from datetime import datetime
from typing import Protocol

from mend.fleet.dispatch.dispatcher import Dispatcher
from mend.fleet.dispatch.setting import FleetSetting, Policy, ServiceRobot
from mend.fleet.dispatch.warming_up import warm_up
from mend.maps.building.building import Building
from mend.server.fleets.fleet_at_work import FleetAtWork
from mend.server.fleets.fleet_record import FleetRecord
from mend.server.fleets.place_names import PlaceNames
from mend.server.fleets.runs import Runs
from mend.server.journal.journal import Journal
from mend.server.sites.requests import FleetOptions
from mend.server.sites.site import Site
from mend.server.sites.site_record import SiteRecord
from mend.sim.building.scene_checks import bases_of
from mend.sim.building.setting import building_of

__all__ = ["FleetOpener", "open_fleet", "warm_up"]

KEPT = 200
"""So many closed requests, and changes of the plan, are known with the open ones."""


class FleetOpener(Protocol):
    """Opens a fleet, as it was `kept`; without, with nothing to do."""

    def __call__(
        self,
        site: Site,
        record: SiteRecord,
        kept: str | None,
        runs: Runs,
        journal: Journal,
        utc_now: Callable[[], datetime],
        most_open: int,
    ) -> FleetAtWork:
        """Raises `ValidationError` for what was kept and cannot be read."""
        ...


def open_fleet(
    site: Site,
    record: SiteRecord,
    kept: str | None,
    runs: Runs,
    journal: Journal,
    utc_now: Callable[[], datetime],
    most_open: int,
) -> FleetAtWork:
    """A `FleetOpener`."""
    assert record.fleet is not None, "it takes requests"
    building = building_of(record.scene)
    setting = _setting(record, record.fleet, building)
    was = None if kept is None else FleetRecord.model_validate_json(kept)
    dispatcher = (
        Dispatcher(building, setting)
        if was is None
        else Dispatcher.restored(building, setting, was.dispatcher)
    )
    places = PlaceNames(building, record.scene)
    pace = None if record.speed == "max" else record.speed
    return FleetAtWork(
        site,
        dispatcher,
        places,
        record.fleet,
        runs,
        journal,
        pace,
        utc_now,
        was,
        most_open=most_open,
    )


def _transfer_place(building: Building, places: PlaceNames, name: str) -> str:
    """Raises `NotFoundError`, or `WrongInputError` where no robot is sent."""
    places.in_scene(name)
    return building.find(name)


def _setting(record: SiteRecord, options: FleetOptions, building: Building) -> FleetSetting:
    places = PlaceNames(building, record.scene)
    robots = []
    for robot, base in zip(record.robots, bases_of(record.scene), strict=True):
        start = places.nearest(base.x, base.y, base.z)
        assert start is not None, "the scene was checked: it stands on a floor"
        robots.append(ServiceRobot(name=robot, start=start, capacity=options.capacity))
    return FleetSetting(
        robots=tuple(robots),
        transfer_places=tuple(
            _transfer_place(building, places, e) for e in options.transfer_places
        ),
        policy=Policy(kept=KEPT),
    )
