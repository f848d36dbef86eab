"""What a fleet knows: it is in the journal before anybody hears of it."""

import asyncio
from collections.abc import AsyncIterator, Callable, Mapping, Sequence
from contextlib import asynccontextmanager
from typing import ParamSpec, TypeVar

from mend.errors import NotFoundError
from mend.fleet.dispatch.dispatcher import Dispatcher
from mend.server.fleets.closed_ways import ClosedWays
from mend.server.fleets.fleet_news import FleetNews
from mend.server.fleets.fleet_record import Errand, FleetRecord
from mend.server.fleets.fleets import KIND
from mend.server.fleets.place_names import PlaceNames
from mend.server.journal import events as ev
from mend.server.journal.journal import Document, Entry, Journal
from mend.server.sites.site import Site

P = ParamSpec("P")
T = TypeVar("T")


class FleetBook:
    """The state of one fleet, which one at a time changes while it holds `at_once`.

    `changed` is set whenever there may be something to do for it. `errands`: those under way;
    `held_cabins`: the elevators in whose cabins robots stay, by robot.
    """

    def __init__(
        self,
        site: Site,
        dispatcher: Dispatcher,
        places: PlaceNames,
        news: FleetNews,
        journal: Journal,
        errands: Callable[[], tuple[Errand, ...]],
        held_cabins: Callable[[], Mapping[str, str]],
        kept: FleetRecord | None,
    ) -> None:
        """`kept`: what was known beside the dispatcher when the service stopped."""
        self.dispatcher, self.places, self.news = dispatcher, places, news
        self._site, self._journal = site, journal
        self._errands, self._held_cabins = errands, held_cabins
        self.at_once = asyncio.Lock()
        self.changed = asyncio.Event()
        self.closed_ways = ClosedWays(dispatcher, () if kept is None else kept.closed_ways)
        self.out_of_service = {} if kept is None else dict(kept.out_of_service)
        """The robots that somebody has taken out, and why."""
        self._kept: FleetRecord | None = None
        self._noted: list[ev.Event] = []

    # --- What it knows ------------------------------------------------------------------------

    @property
    def now_s(self) -> float:
        """The site's clock, as far as it is known.

        It goes back only where the world does, which began again from when it was kept last.
        """
        return max(self.dispatcher.now_s, self._site.world.time.latest_s)

    @property
    def shown_s(self) -> float:
        """The site's clock for who watches it: robots tell of it more often than plans need it."""
        return max(self.now_s, self._site.shown_s)

    def at(self, robot: str) -> str:
        """The place that a robot is nearest to, as far as is known."""
        where = self._site.whereabouts(robot)
        place = None if where is None else self.places.nearest(*where)
        known = self.dispatcher.fleet.robots[robot].place
        return place or self.dispatcher.building.graph.places[known].name

    def met_at(self, robot: str) -> str:
        """Where others are brought what a robot has that does not get on: it may bar its place."""
        where = self._site.whereabouts(robot)
        place = None if where is None else self.places.beside(*where)
        return place or self.at(robot)

    def require_robot(self, robot: str) -> None:
        """Raises `NotFoundError` for a robot that it does not have."""
        if robot not in self.dispatcher.fleet.robots:
            known = ", ".join(self.dispatcher.fleet.robots)
            raise NotFoundError(f"this fleet has no robot '{robot}'; it has {known}")

    async def in_thread(self, work: Callable[P, T], *args: P.args, **kwargs: P.kwargs) -> T:
        """Have the dispatcher do something that may take long, for who holds `at_once`.

        Also who is to stop meanwhile waits until it is done, as nobody else may change anything
        before.
        """
        doing = asyncio.ensure_future(asyncio.to_thread(work, *args, **kwargs))
        try:
            return await asyncio.shield(doing)
        except asyncio.CancelledError:
            await asyncio.wait({doing})
            raise

    # --- What is written down -----------------------------------------------------------------

    def note(self, event: ev.Event) -> None:
        """Something that is to be in the journal with what comes of it."""
        self._noted.append(event)

    @asynccontextmanager
    async def told(self, author: ev.Author | None = None, asked: str = "") -> AsyncIterator[None]:
        """Journal what comes of it, before anybody hears of it."""
        async with self.at_once:
            try:
                yield
            finally:
                # Also what was refused is known from then on.
                await self.keep(author, asked.split("/", 1)[0])
                self.changed.set()

    async def keep(self, author: ev.Author | None = None, asked: str = "") -> None:
        """Write down what has changed. Waits as long as the journal cannot be written."""
        noted, self._noted = self._noted, []
        events, record, text = await self.in_thread(self._written, noted, author, asked)
        if text is None:
            return
        document = Document(KIND, str(self._site.id), text)
        await self._journal.append(Entry(events=events, document=document), patient=True)
        self._kept = record

    def _written(
        self, noted: Sequence[ev.Event], author: ev.Author | None, asked: str
    ) -> tuple[list[ev.Event], FleetRecord, str | None]:
        """What is new, and all that is known, with its text; without where nothing has changed."""
        events = [*noted, *self.news.since(author, asked)]
        record = FleetRecord(
            dispatcher=self.dispatcher.snapshot(),
            out_of_service=self.out_of_service,
            errands=self._errands(),
            closed_ways=self.closed_ways.kept(),
            held_cabins=dict(self._held_cabins()),
        )
        changed = bool(events) or record != self._kept
        return events, record, record.model_dump_json() if changed else None
