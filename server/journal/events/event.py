"""What every event has, and events of the service itself have."""

from datetime import datetime
from uuid import UUID

from pydantic import BaseModel, ConfigDict

from mend.server.access.roles import Role


class EventModel(BaseModel):
    """Base of events and their parts."""

    # The journal's writer looks for these constants; a null would look like no number at all.
    model_config = ConfigDict(extra="forbid", frozen=True, ser_json_inf_nan="constants")


class Author(EventModel):
    """Who did something: the principal, the role that it had then, and where it came from.

    `address` is None for what was done in the service's own process.
    """

    principal: str
    role: Role
    address: str | None = None


class Event(EventModel):
    """What every event has. `seq` is 0 until the journal has given it its number."""

    seq: int = 0
    time: float
    wall_time: datetime
    run: UUID


class NodeEvent(Event):
    """An event of one node."""

    node: str
    name: str


class RobotEvent(Event):
    robot: str


NO_RUN = UUID(int=0)
"""The `run` of what belongs to none."""


class ServiceEvent(Event):
    """Something that was done to the service itself: only admins get to read it."""

    time: float = 0.0
    run: UUID = NO_RUN
