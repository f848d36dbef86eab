"""What requesters ask of a fleet."""

import asyncio
from functools import cached_property

from mend.errors import ConflictError
from mend.fleet.asking.spoken_places import SpokenPlaces
from mend.fleet.dispatch.booking import Answer, AnyRequest, RequestView
from mend.fleet.requests import RequestKind
from mend.server.fleets.fleet_book import FleetBook
from mend.server.fleets.leg_task import doable_kinds, require_doable
from mend.server.fleets.request_refused import RequestRefusedError
from mend.server.journal import events as ev
from mend.tasks.plugins import load_plugins


class Requesters:
    """Books what is asked of one fleet, of which `most_open` requests may be open."""

    def __init__(self, book: FleetBook, most_open: int) -> None:
        self._book, self._most_open = book, most_open
        self._behaviors = load_plugins("mend.behaviors")
        self._one_by_one = asyncio.Lock()
        """One asks at a time, so that all others have to wait for one request at most."""

    @property
    def kinds(self) -> list[RequestKind]:
        """What may be asked of its robots."""
        return doable_kinds(self._behaviors)

    @cached_property
    def spoken_places(self) -> SpokenPlaces:
        """The places as people say them."""
        return SpokenPlaces(self._book.places.names)

    async def submit(self, request: AnyRequest, author: ev.Author | None) -> RequestView:
        """Book a request. Raises `RequestRefusedError`, what `Dispatcher.submit` does,
        `WrongInputError` for what no robot does, or where none goes, and `ConflictError` where as
        many are open as may be.
        """
        self._require_doable(request)
        first = request.name if request.recurrence is None else f"{request.name}/1"
        dispatcher = self._book.dispatcher
        async with self._one_by_one:
            async with self._book.at_once:
                self._require_room()
            async with self._book.told(author, request.name):
                return await self._book.in_thread(
                    lambda now_s: self._booked(first, dispatcher.submit(request, now_s)),
                    self._book.now_s,
                )

    async def change(self, name: str, request: AnyRequest, author: ev.Author | None) -> RequestView:
        """Other words for what nobody has set out for. Raises what `submit` does, but for room."""
        self._require_doable(request)
        dispatcher = self._book.dispatcher
        async with self._one_by_one, self._book.told(author, name):
            return await self._book.in_thread(
                lambda now_s: self._booked(name, dispatcher.change(name, request, now_s)),
                self._book.now_s,
            )

    async def cancel(self, name: str, author: ev.Author | None) -> RequestView | None:
        """What was asked for is not wanted any more. Raises as `Dispatcher.cancel`."""
        async with self._book.told(author, name):
            return await self._book.in_thread(self._book.dispatcher.cancel, name, self._book.now_s)

    def _require_doable(self, request: AnyRequest) -> None:
        for place in request.places:
            self._book.places.in_scene(place)
        require_doable(request, self._behaviors)

    def _require_room(self) -> None:
        if self._book.dispatcher.count_open() >= self._most_open:
            raise ConflictError(
                f"{self._most_open} requests are open, and at most so many may be: cancel one, or "
                "wait until one is done",
                limit="open_requests",
            )

    def _booked(self, name: str, answer: Answer) -> RequestView:
        if not answer.booked:
            raise RequestRefusedError(name, answer)
        return self._book.dispatcher.view(name)
