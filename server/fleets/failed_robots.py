"""Robots that work no more, and are carried or pushed elsewhere, or ride on to another floor."""

import math
from collections.abc import Callable, Iterator

from mend.fleet.dispatch.dispatcher import Dispatcher
from mend.tasks.potential import Point

MOVED_M = 1.0
"""Who is said to be so much farther off has been moved; less is nothing to go by."""


class FailedRobots:
    """Follows where those of one fleet stand, so that what they have is fetched there.

    `whereabouts`: where a robot says that it is; `met_at`: the place where others meet it.
    """

    def __init__(
        self,
        dispatcher: Dispatcher,
        whereabouts: Callable[[str], Point | None],
        met_at: Callable[[str], str],
    ) -> None:
        self._dispatcher, self._whereabouts, self._met_at = dispatcher, whereabouts, met_at
        self._stood: dict[str, Point] = {}

    def moved(self) -> Iterator[tuple[str, str]]:
        """Which robots are elsewhere than the plan has them, and at which place; each once."""
        places = self._dispatcher.building.graph.places
        for name, known in self._dispatcher.fleet.robots.items():
            here = self._whereabouts(name)
            if known.works or here is None:
                self._stood.pop(name, None)
                continue
            stood = self._stood.get(name)
            if stood is not None and math.dist(stood, here) < MOVED_M:
                continue
            self._stood[name] = here
            at = self._met_at(name)
            if at != places[known.place].name:
                yield name, at
