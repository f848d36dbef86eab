"""What is written of a run, whatever the format: events, pictures and poses, as they come."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from enum import StrEnum
from typing import Protocol
from uuid import UUID

from mend.server.journal import events as ev
from mend.server.poses.frame import Frame
from mend.server.transcript_line import Line

FOREARM = "forearm"
"""The camera that clips are of."""

UNTOLD_CAMERA = "camera"
"""What stands for a camera's name where an event does not tell it."""


class Format(StrEnum):
    """Which kind of file."""

    CSV = "csv"
    MCAP = "mcap"


MEDIA_TYPES = {Format.CSV: "text/csv; charset=utf-8", Format.MCAP: "application/octet-stream"}


@dataclass(frozen=True, slots=True)
class ShownPicture:
    """A picture that an event names: of which camera of which robot, and when (run's clock, s)."""

    picture: UUID
    robot: str
    camera: str
    time_s: float


class RunFile(Protocol):
    """A file that grows; what is ready of it is taken, so that no more than a piece is kept."""

    @property
    def shows(self) -> bool:
        """Whether pictures and poses go into it."""
        ...

    def add_event(self, event: ev.Event, text: str, lines: Sequence[Line]) -> None:
        """Add an event, its JSON, and what the transcript tells of it."""
        ...

    def add_picture(self, shown: ShownPicture, jpeg: bytes) -> None: ...

    def add_frame(self, frame: Frame) -> None:
        """Add a moment of the recorded poses."""
        ...

    def take(self) -> bytes:
        """What is ready since this was called last."""
        ...

    def end(self) -> bytes:
        """The rest; nothing is added any more."""
        ...


def pictures_of(event: ev.Event) -> Iterator[ShownPicture]:
    """The pictures that an event names."""
    if isinstance(event, ev.ClipRecorded):
        for each in event.pictures:
            yield ShownPicture(each.picture, event.robot, FOREARM, each.time)
    elif isinstance(event, ev.CamerasRecorded):
        for shown in event.pictures:
            yield ShownPicture(shown.picture, event.robot, shown.camera, shown.time)
    elif isinstance(event, ev.IssueRaised | ev.UnseenHelp) and event.picture is not None:
        seen = event.detection
        camera = UNTOLD_CAMERA if seen is None else seen.camera
        yield ShownPicture(event.picture, event.robot, camera, event.time)
