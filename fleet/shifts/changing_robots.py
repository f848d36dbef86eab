"""Transports that a fleet brings sooner if a thing changes robots on its way."""

from collections.abc import Callable, Sequence

from mend.errors import RefusalError
from mend.fleet.dispatch.dispatcher import Dispatcher
from mend.fleet.dispatch.setting import FleetSetting
from mend.fleet.requests import LegAction, Transport
from mend.maps.building.building import Building

_TRIES = 120


def changing_robots(
    building: Building, setting: FleetSetting, draw: Callable[[], Sequence[Transport]]
) -> tuple[Sequence[Transport], bool]:
    """The first transports drawn in whose plan a thing changes robots, or else the last drawn.

    With them whether one does. They are asked for one after the other at the beginning, and robots
    set out at once.
    """
    drawn: Sequence[Transport] = ()
    for _ in range(_TRIES):
        drawn = draw()
        if _changes_robots(building, setting, drawn):
            return drawn, True
    return drawn, False


def _changes_robots(
    building: Building, setting: FleetSetting, transports: Sequence[Transport]
) -> bool:
    dispatcher = Dispatcher(building, setting)
    for each in transports:
        try:
            dispatcher.submit(each, 0.0)
        except RefusalError:
            return False
        while legs := dispatcher.legs_to_begin(0.0):
            dispatcher.began(legs[0], 0.0)
    return any(
        action is LegAction.GIVE for stops in dispatcher.stops().values() for _, action in stops
    )
