"""The robots of a building, where they change items, and for how long things are tried."""

from math import inf
from typing import Annotated

from pydantic import Field

from mend.documents.spellings import NAME
from mend.documents.strict_model import StrictModel
from mend.fleet.requests import LAST_S, Moment, PlaceName
from mend.maps.building.building import Speed

RobotName = Annotated[str, Field(pattern=NAME)]
Span = Annotated[float, Field(gt=0.0, le=LAST_S, allow_inf_nan=False)]
Handling = Annotated[float, Field(ge=0.0, le=3600.0, allow_inf_nan=False)]
Weight = Annotated[float, Field(ge=0.0, le=1e6, allow_inf_nan=False)]


class ServiceRobot(StrictModel):
    """One robot: where it is at first, how much it carries, when it works.

    `speed` divides all travel times.
    """

    name: RobotName
    start: PlaceName
    capacity: Annotated[float, Field(gt=0.0, le=1e6, allow_inf_nan=False)] = 1.0
    speed: Annotated[float, Field(gt=0.0, le=100.0, allow_inf_nan=False)] = 1.0
    works_from_s: Moment = 0.0
    works_until_s: Moment | None = None

    @property
    def until_s(self) -> float:
        """When its work ends."""
        return inf if self.works_until_s is None else self.works_until_s


class Policy(StrictModel):
    """For how long and how often things are tried (seconds).

    A stop that failed is tried again after `retry_after_s`, `max_attempts` times in all. What has
    no place in the plan is tried again every `retry_waiting_s`, for `patience_s` at most. What has
    no latest moment of its own has to be done within `longest_s`. What robots found is forgotten
    after `forget_s`. What is done up to `slack_s` later than was said is not late. Robots leave
    `reserve_s` earlier than they must. What recurs is planned `horizon_s` ahead, but not more than
    the next `occurrences` of each, and less where those of all come to more than
    `occurrences_in_all`. The next possible time lasts `grace_s` longer than it must. So many
    closed requests and changes of plans are kept as `kept` says.
    """

    max_attempts: Annotated[int, Field(ge=1, le=100)] = 3
    retry_after_s: Span = 300.0
    retry_waiting_s: Span = 60.0
    patience_s: Span = 4 * 3600.0
    longest_s: Span = 24 * 3600.0
    forget_s: Span = 1800.0
    slack_s: Span = 300.0
    reserve_s: Handling = 30.0
    horizon_s: Span = 24 * 3600.0
    occurrences: Annotated[int, Field(ge=1, le=1000)] = 12
    occurrences_in_all: Annotated[int, Field(ge=1, le=100_000)] = 160
    grace_s: Span = 120.0
    kept: Annotated[int, Field(ge=1, le=1_000_000)] = 1000


class FleetSetting(StrictModel):
    """The fleet of a building.

    `speed_m_s`: how fast a robot of speed 1 drives, and `starts_s` what it takes besides to speed
    up, to brake and to turn: `benchmarks/drive_times.py` compares that with robots that drive.
    `handling_s`: what it takes to give or take something, or to tell a message; `transfer_s`: to
    leave an item for another robot at one of the `transfer_places`, or to take it from there.
    `per_metre` and `per_second` weigh what is driven against how late everything is done: a metre
    takes a robot a second, which counts as much as one that somebody waits. `per_second_late`
    weighs, besides, how much later something is done than it was said to be when it was booked, and
    a slack (`Policy.slack_s`): nobody is put off time and again for who asks later.
    """

    robots: Annotated[tuple[ServiceRobot, ...], Field(min_length=1)]
    speed_m_s: Speed = 1.0
    starts_s: Handling = 1.0
    handling_s: Handling = 30.0
    transfer_places: tuple[PlaceName, ...] = ()
    transfer_s: Handling = 20.0
    per_metre: Weight = 1.0
    per_second: Weight = 1.0
    per_second_late: Weight = 10.0
    policy: Policy = Policy()
