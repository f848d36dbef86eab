"""Who has found which way blocked or which door closed, as long as plans keep off it."""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass

from mend.fleet.dispatch.dispatcher import Dispatcher
from mend.fleet.dispatch.leg import Finding, Found
from mend.server.fleets.fleet_record import ToldWay


@dataclass(frozen=True, slots=True)
class ClosedWay:
    """A way between two places that is closed to plans until `until_s` of the site's clock.

    `told`: what was found and by whom; None where that is not known any more.
    """

    between: tuple[str, str]
    until_s: float
    told: ToldWay | None


class ClosedWays:
    """What was told of the ways of one dispatcher's building."""

    def __init__(self, dispatcher: Dispatcher, told: Iterable[ToldWay]) -> None:
        self._dispatcher = dispatcher
        self._told = {frozenset(each.between): each for each in told}

    def note(self, found: Found, by: str | None) -> None:
        """What the dispatcher was told just now, and who said so."""
        a, b = (self._dispatcher.building.find(each) for each in found.between)
        told = ToldWay(finding=found.finding, between=(a, b), by=by)
        if found.finding is Finding.OPEN:
            self._told.pop(frozenset((a, b)), None)
        else:
            self._told[frozenset((a, b))] = told

    def kept(self) -> tuple[ToldWay, ...]:
        """What is to be known after a restart: of ways that have opened again nothing is."""
        closed = self._dispatcher.closed_until_s()
        return tuple(each for way, each in self._told.items() if way in closed)

    def now(self) -> Iterator[ClosedWay]:
        """The ways that are closed now."""
        for way, until_s in self._dispatcher.closed_until_s().items():
            a, b = sorted(way)
            yield ClosedWay((a, b), until_s, self._told.get(way))
