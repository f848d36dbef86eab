"""What people of a building want of its robots, and how far that has come.

Times are seconds on the building's clock, places are a building's, as `FLOOR/PLACE` or by a name
that is there once.
"""

from abc import abstractmethod
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from enum import StrEnum
from math import inf
from typing import Annotated, Any, ClassVar, Literal, Self

from pydantic import AfterValidator, Field, model_validator

from mend.documents.quotation_marks import single_marks
from mend.documents.spellings import NAME, SEEN_CHARACTERS
from mend.documents.strict_model import StrictModel
from mend.documents.validation import refusing
from mend.errors import WrongInputError
from mend.fleet.scheduling.problem import Item, Visit, Window
from mend.tasks.transitions import Transitions

LAST_S = 1e8
"""The latest moment that there is: some three years, as plans are exact to less than 1e-6 s."""

RequestName = Annotated[str, Field(pattern=NAME)]
Text = Annotated[
    str,
    Field(min_length=1, max_length=500, pattern=SEEN_CHARACTERS),
    AfterValidator(single_marks),
]
"""What robots say and show between quotation marks, and so has none of its own."""
PlaceName = Annotated[str, Field(min_length=1, max_length=129, pattern=SEEN_CHARACTERS)]
Moment = Annotated[float, Field(ge=0.0, le=LAST_S, allow_inf_nan=False)]
Stay = Annotated[float, Field(ge=0.0, le=3600.0, allow_inf_nan=False)]
Load = Annotated[float, Field(ge=0.0, le=1e6, allow_inf_nan=False)]


class RequestKind(StrEnum):
    """What is wanted."""

    GO_TO_ROOM = "go_to_room"
    DELIVER_MESSAGE = "deliver_message"
    ESCORT = "escort"
    TRANSPORT = "transport"


class LegAction(StrEnum):
    """What a robot does at the end of a leg."""

    VISIT = "visit"
    DELIVER_MESSAGE = "deliver_message"
    MEET = "meet"
    ESCORT = "escort"
    COLLECT = "collect"
    HAND_OVER = "hand_over"
    GIVE = "give"
    TAKE = "take"
    BRING_BACK = "bring_back"

    @property
    def words(self) -> str:
        """As it stands in a sentence."""
        return self.replace("_", " ")


class RequestStatus(StrEnum):
    """How far a request has come.

    `booked`: it is in the plan; `waiting`: it has no place there for now and is tried again;
    `under_way`: a robot has set out for it, or has what is to be brought; `returning`: what was
    fetched goes back to where it came from.
    """

    BOOKED = "booked"
    WAITING = "waiting"
    UNDER_WAY = "under_way"
    RETURNING = "returning"
    DONE = "done"
    REFUSED = "refused"
    CANCELLED = "cancelled"
    FAILED = "failed"

    @property
    def words(self) -> str:
        """As it stands in a sentence."""
        return self.replace("_", " ")


_OVER = (RequestStatus.CANCELLED, RequestStatus.FAILED)
STATUS = Transitions(
    "a request",
    {
        RequestStatus.BOOKED: {RequestStatus.WAITING, RequestStatus.UNDER_WAY, *_OVER},
        RequestStatus.WAITING: {RequestStatus.BOOKED, RequestStatus.UNDER_WAY, *_OVER},
        RequestStatus.UNDER_WAY: {
            RequestStatus.BOOKED,
            RequestStatus.WAITING,
            RequestStatus.RETURNING,
            RequestStatus.DONE,
            *_OVER,
        },
        RequestStatus.RETURNING: {RequestStatus.DONE, *_OVER},
        RequestStatus.DONE: frozenset[RequestStatus](),
        RequestStatus.REFUSED: frozenset[RequestStatus](),
        RequestStatus.CANCELLED: frozenset[RequestStatus](),
        RequestStatus.FAILED: frozenset[RequestStatus](),
    },
)
"""`returning` becomes `done` where a robot had handed over just before it heard otherwise."""


class Recurrence(StrictModel):
    """The same again every so many seconds, the last time not after `until_s`."""

    every_s: Annotated[float, Field(ge=60.0, le=LAST_S, allow_inf_nan=False)]
    until_s: Moment | None = None


@dataclass(frozen=True, slots=True)
class Terms:
    """What turns requests into items of a fleet: the numbers of places, how long robots take at
    their stops (seconds), and the load that nothing has room beside."""

    place: Callable[[str], int]
    handling_s: float
    whole_load: float


class _Asked(StrictModel):
    """What all requests have: nothing begins before `earliest_s`; it is to be done, or handed over,
    by `latest_s`."""

    name: RequestName
    earliest_s: Moment = 0.0
    latest_s: Moment | None = None
    recurrence: Recurrence | None = None

    fetching: ClassVar[LegAction]
    bringing: ClassVar[LegAction]
    comes_back: ClassVar[bool] = False
    """Whether what cannot be handed over is brought back to where it was fetched."""
    is_visit: ClassVar[bool] = False
    """Whether it is done with one leg to one place."""

    @property
    @abstractmethod
    def places(self) -> tuple[str, ...]:
        """The places that it names."""

    @abstractmethod
    def item(self, name: str, terms: Terms) -> Item:
        """The item of the scheduling problem that stands for it, under that name."""

    def occurrence(self, number: int) -> Self:
        """What is wanted the first (1), second, ... time, by itself."""
        if self.recurrence is None:
            return self
        later_s = (number - 1) * self.recurrence.every_s
        latest_s = None if self.latest_s is None else self.latest_s + later_s
        times = {"earliest_s": self.earliest_s + later_s, "latest_s": latest_s}
        return self.model_copy(update={**times, "recurrence": None})

    def recurs(self, number: int) -> bool:
        """Whether there is such an occurrence."""
        if self.recurrence is None:
            return number == 1
        until_s = LAST_S if self.recurrence.until_s is None else self.recurrence.until_s
        latest_s = 0.0 if self.latest_s is None else self.latest_s - self.earliest_s
        begins_s = self.earliest_s + (number - 1) * self.recurrence.every_s
        return begins_s <= until_s and begins_s + latest_s <= LAST_S

    @property
    def window(self) -> Window:
        """When it may be begun and must be done."""
        return Window(self.earliest_s, inf if self.latest_s is None else self.latest_s)

    @model_validator(mode="after")
    def _times_make_sense(self) -> Self:
        if self.latest_s is not None and self.latest_s <= self.earliest_s:
            raise ValueError(
                f"latest_s must be after earliest_s ({self.earliest_s:g} s), "
                f"but it is {self.latest_s:g} s"
            )
        until_s = None if self.recurrence is None else self.recurrence.until_s
        if until_s is not None and until_s < self.earliest_s:
            raise ValueError(
                f"recurrence.until_s must not be before earliest_s ({self.earliest_s:g} s), "
                f"but it is {until_s:g} s"
            )
        return self


class _Visiting(_Asked):
    """A request that is done at one place: picked up and delivered there, with nothing to carry."""

    place: PlaceName
    is_visit: ClassVar[bool] = True

    @property
    def places(self) -> tuple[str, ...]:
        return (self.place,)

    def _visit(self, name: str, terms: Terms, lasts_s: float) -> Item:
        place = terms.place(self.place)
        there = Visit(place, self.window, service_s=lasts_s)
        return Item(name, 0.0, there, Visit(place), direct=True)


class _Bringing(_Asked):
    """A request to bring from place to place."""

    origin: PlaceName
    destination: PlaceName

    @property
    def places(self) -> tuple[str, ...]:
        return (self.origin, self.destination)

    def _way(self, name: str, terms: Terms, load: float, *, direct: bool) -> Item:
        origin, destination = terms.place(self.origin), terms.place(self.destination)
        if origin == destination:
            raise WrongInputError(self._leads_nowhere)
        pickup = Visit(origin, self.window, service_s=terms.handling_s)
        by = Window(0.0, self.window.latest_s)
        delivery = Visit(destination, by, service_s=terms.handling_s)
        return Item(name, load, pickup, delivery, direct=direct)

    @model_validator(mode="after")
    def _leads_somewhere(self) -> Self:
        if self.origin == self.destination:
            raise ValueError(self._leads_nowhere)
        return self

    @property
    def _leads_nowhere(self) -> str:
        return f"destination must be another place than origin ('{self.origin}')"


class GoToRoom(_Visiting):
    """A robot is wanted at a place, to stay there for a while."""

    kind: Literal[RequestKind.GO_TO_ROOM] = RequestKind.GO_TO_ROOM
    stay_s: Stay = 0.0
    fetching: ClassVar[LegAction] = LegAction.VISIT
    bringing: ClassVar[LegAction] = LegAction.VISIT

    def item(self, name: str, terms: Terms) -> Item:
        return self._visit(name, terms, self.stay_s)


class DeliverMessage(_Visiting):
    """A message is to be told at a place, to a person if one is named."""

    kind: Literal[RequestKind.DELIVER_MESSAGE] = RequestKind.DELIVER_MESSAGE
    message: Text
    person: Text | None = None
    fetching: ClassVar[LegAction] = LegAction.DELIVER_MESSAGE
    bringing: ClassVar[LegAction] = LegAction.DELIVER_MESSAGE

    def item(self, name: str, terms: Terms) -> Item:
        return self._visit(name, terms, terms.handling_s)


class Escort(_Bringing):
    """A person is to be met and shown the way; the robot has room for nothing else meanwhile."""

    kind: Literal[RequestKind.ESCORT] = RequestKind.ESCORT
    person: Text
    fetching: ClassVar[LegAction] = LegAction.MEET
    bringing: ClassVar[LegAction] = LegAction.ESCORT

    def item(self, name: str, terms: Terms) -> Item:
        return self._way(name, terms, terms.whole_load, direct=True)


class Transport(_Bringing):
    """A thing is to be fetched and handed over; it may change robots on its way."""

    kind: Literal[RequestKind.TRANSPORT] = RequestKind.TRANSPORT
    what: Text
    load: Load = 1.0
    person: Text | None = None
    fetching: ClassVar[LegAction] = LegAction.COLLECT
    bringing: ClassVar[LegAction] = LegAction.HAND_OVER
    comes_back: ClassVar[bool] = True

    def item(self, name: str, terms: Terms) -> Item:
        return self._way(name, terms, self.load, direct=False)


Request = Annotated[GoToRoom | DeliverMessage | Escort | Transport, Field(discriminator="kind")]

REQUESTS: Mapping[RequestKind, type[GoToRoom | DeliverMessage | Escort | Transport]] = {
    RequestKind.GO_TO_ROOM: GoToRoom,
    RequestKind.DELIVER_MESSAGE: DeliverMessage,
    RequestKind.ESCORT: Escort,
    RequestKind.TRANSPORT: Transport,
}


def request_of(document: Mapping[str, Any]) -> GoToRoom | DeliverMessage | Escort | Transport:
    """The request that a document describes. Raises `WrongInputError`, a sentence per mistake."""
    kind = document.get("kind")
    if not isinstance(kind, str) or kind not in list(RequestKind):
        raise WrongInputError(f"'kind' must be one of {', '.join(REQUESTS)}")
    model = REQUESTS[RequestKind(kind)]
    with refusing(model):
        return model.model_validate({**document, "kind": RequestKind(kind)})
