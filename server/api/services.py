"""What the routes work with: the parts of the service, and parameters that many of them take."""

import time
from collections.abc import Callable
from dataclasses import dataclass, field
from datetime import UTC, datetime
from typing import TYPE_CHECKING, Annotated, Protocol
from uuid import UUID

from fastapi import Depends, Path, Query
from pydantic import AwareDatetime, Field
from starlette.requests import HTTPConnection

from mend.documents.spellings import NAME, SEEN_CHARACTERS
from mend.errors import WrongInputError
from mend.robots.link.shown_name import SHOWN
from mend.server.access.access import Access
from mend.server.access.deed_log import DeedLog
from mend.server.access.principal import Caller
from mend.server.dialogues.attendance import Attendance
from mend.server.documents import DocumentLibrary
from mend.server.fleets.fleets import Fleets
from mend.server.journal.journal import Journal
from mend.server.journal.subscriptions import Subscribers
from mend.server.journal.writer import CommitStatistics
from mend.server.models.robot_models import RobotModels
from mend.server.off_loop import OffLoop
from mend.server.poses.feed import PoseSource
from mend.server.push.push import Push
from mend.server.refusals import Refusals
from mend.server.runtime.service import RunService
from mend.server.runtime.views import WorldView
from mend.server.settings import Settings
from mend.server.sites.sites import Sites
from mend.server.speech.abilities import NO_SPEECH, SpeechAbilities

if TYPE_CHECKING:
    # It refuses with problem documents, which know them.
    from mend.server.api.repeats import Repeats

MAX_SEQ = 2**63 - 1


class ObservedJournal(Journal, Protocol):
    """A journal that tells how it is doing."""

    @property
    def subscribers(self) -> Subscribers: ...

    async def look(self) -> None: ...

    def commit_statistics(self) -> CommitStatistics: ...


class WorldList(Protocol):
    """Where the API finds worlds."""

    def worlds(self) -> list[WorldView]: ...


@dataclass(frozen=True, slots=True)
class Services:
    """The parts of one service; `app.state.services` holds them."""

    runs: RunService
    journal: ObservedJournal
    trees: DocumentLibrary
    scenes: DocumentLibrary
    scenarios: DocumentLibrary
    worlds: WorldList
    sites: Sites
    fleets: Fleets
    models: RobotModels
    poses: PoseSource
    settings: Settings
    access: Access
    deeds: DeedLog
    push: Push
    repeats: "Repeats"
    speech: SpeechAbilities = NO_SPEECH
    refusals: Refusals = field(default_factory=Refusals)
    off_loop: OffLoop = field(default_factory=OffLoop)
    wall_time_s: Callable[[], float] = time.time
    attendance: Attendance = field(default_factory=Attendance)

    def utc_now(self) -> datetime:
        """The date and time by the service's wall clock."""
        return datetime.fromtimestamp(self.wall_time_s(), UTC)


def services_of(connection: HTTPConnection) -> Services:
    services: Services = connection.app.state.services
    return services


def known_caller(connection: HTTPConnection) -> Caller:
    """Who the gate has let in, at a door that lets in nobody else."""
    caller: Caller = connection.state.caller
    return caller


def caller_if_known(connection: HTTPConnection) -> Caller | None:
    """Who it is, at a door that is open to strangers; None for one."""
    known: Caller | None = connection.state.known
    return known


WithCaller = Annotated[Caller, Depends(known_caller)]
WithCallerIfKnown = Annotated[Caller | None, Depends(caller_if_known)]
WithServices = Annotated[Services, Depends(services_of)]

RunId = Annotated[UUID, Path(description="The run's id.")]
SiteId = Annotated[UUID, Path(description="The site's id.")]
DialogueId = Annotated[UUID, Path(description="The dialogue's id.")]
DocumentName = Annotated[str, Path(pattern=NAME, examples=["eket"])]
After = Annotated[int, Query(ge=0, le=MAX_SEQ, description="Only what comes after this `seq`.")]
Limit = Annotated[int, Query(ge=1, le=1000, description="At most so many.")]
Offset = Annotated[int, Query(ge=0, le=MAX_SEQ, description="Skip so many.")]
SearchedText = Annotated[
    str | None, Query(max_length=200, description="Contained in one of the names it goes by.")
]
Since = Annotated[
    AwareDatetime | None, Query(description="Not before this moment, by the wall clock.")
]
Until = Annotated[AwareDatetime | None, Query(description="Before this moment, by the wall clock.")]
HelperName = Annotated[
    str,
    Field(
        min_length=1,
        max_length=64,
        pattern=SEEN_CHARACTERS,
        description="The helper's name; the others see it.",
        examples=["anna"],
    ),
    SHOWN,
]


def helper_of(caller: Caller, declared: str | None) -> str:
    """What the helper is called. Raises `WrongInputError` where nobody says so."""
    name = caller.helper_name(declared)
    if name is None:
        missing = "body.helper: is missing: with this token everybody says who it is"
        raise WrongInputError(missing, [missing])
    return name
