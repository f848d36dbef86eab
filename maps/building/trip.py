"""How long a robot takes from place to place of a building if nothing holds it up."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TypeAlias


@dataclass(frozen=True, slots=True)
class TripRide:
    """A ride in an elevator from floor to floor.

    The robot gets in within `gets_in_s` once the cabin is open for it, and is out of the door
    `gets_out_s` after it has opened at the other floor.
    """

    elevator: str
    from_floor: str
    to_floor: str
    gets_in_s: float
    gets_out_s: float


@dataclass(frozen=True, slots=True)
class TripStage:
    """A drive of so many seconds and metres to where a ride begins, or to the end (None).

    `doors`: so many doors that people open are on it.
    """

    drives_s: float
    drives_m: float
    doors: int = 0
    ride: TripRide | None = None


Trip: TypeAlias = Sequence[TripStage]
"""All but its last stage end with a ride."""
