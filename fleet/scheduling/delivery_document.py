"""What a delivery file may say: its models, one a part. Times are seconds, lengths metres."""

from typing import Annotated, Self

from pydantic import Field, model_validator

from mend.documents.strict_model import StrictModel
from mend.maps.navigation import WayKind
from mend.tasks.scene import Name

Seconds = Annotated[float, Field(ge=0.0, le=1e9, allow_inf_nan=False)]
Length = Annotated[float, Field(ge=0.0, le=1e7, allow_inf_nan=False)]
Coordinate = Annotated[float, Field(ge=-1e7, le=1e7, allow_inf_nan=False)]
Speed = Annotated[float, Field(gt=0.0, le=1e3, allow_inf_nan=False)]
Load = Annotated[float, Field(ge=0.0, le=1e6, allow_inf_nan=False)]
Weight = Annotated[float, Field(ge=0.0, le=1e9, allow_inf_nan=False)]
Span = tuple[Seconds, Seconds | None]
"""From when until when; null: for ever."""


PlaceName = Annotated[
    str, Field(min_length=1, max_length=130, pattern=r"^[^\s\x00-\x1f]+( [^\s\x00-\x1f]+)*$")
]
"""Any words; of a building's file `FLOOR/PLACE`, or a place's name that no other floor has."""


class PlaceEntry(StrictModel):
    """A place of a building, in the frame of its floor."""

    x: Coordinate
    y: Coordinate
    floor: Annotated[int, Field(ge=-100, le=1000)] = 0


class WayEntry(StrictModel):
    """A way between two places, in both directions unless it is `one_way`.

    Without `length_m` the straight line. `delay_s` comes on top (an elevator's ride). `open_s`:
    when a door may be passed; `closed`: never. `speed_m_s`: nobody is faster there.
    """

    between: tuple[PlaceName, PlaceName]
    kind: WayKind = WayKind.CORRIDOR
    length_m: Length | None = None
    delay_s: Seconds = 0.0
    open_s: tuple[Span, ...] = ()
    closed: bool = False
    one_way: bool = False
    speed_m_s: Speed | None = None


class GraphEntry(StrictModel):
    """A building: places on floors and the ways between them."""

    speed_m_s: Speed = 1.0
    places: Annotated[dict[PlaceName, PlaceEntry], Field(min_length=1, max_length=2000)]
    ways: tuple[WayEntry, ...] = ()


class CoordinatesEntry(StrictModel):
    """Points in the plane; everybody drives straight."""

    speed_m_s: Speed = 1.0
    places: Annotated[
        dict[PlaceName, tuple[Coordinate, Coordinate]], Field(min_length=1, max_length=2000)
    ]


class MatrixEntry(StrictModel):
    """Times from row to column, and distances (as the times if not given); null: no way."""

    places: Annotated[tuple[PlaceName, ...], Field(min_length=1, max_length=2000)]
    time_s: tuple[tuple[Seconds | None, ...], ...]
    distance_m: tuple[tuple[Length | None, ...], ...] | None = None


class BuildingEntry(StrictModel):
    """A building's file, beside the delivery file or below its folder."""

    file: Annotated[str, Field(min_length=1, max_length=500)]
    speed_m_s: Speed = 1.0


class TravelEntry(StrictModel):
    """How one gets from place to place: in exactly one of four forms."""

    building: BuildingEntry | None = None
    graph: GraphEntry | None = None
    coordinates: CoordinatesEntry | None = None
    matrix: MatrixEntry | None = None

    @model_validator(mode="after")
    def _one_form(self) -> Self:
        forms = (self.building, self.graph, self.coordinates, self.matrix)
        if sum(form is not None for form in forms) != 1:
            expected = "'building', 'graph', 'coordinates' and 'matrix'"
            raise ValueError(f"must have exactly one of {expected}")
        return self


class RobotEntry(StrictModel):
    """A robot. Without `end` it may end anywhere. `speed` is relative: 2 is twice as fast."""

    name: Name
    start: PlaceName
    end: PlaceName | None = None
    capacity: Load
    speed: Speed = 1.0
    shift_s: Span = (0.0, None)
    max_duration_s: Seconds | None = None


class VisitEntry(StrictModel):
    """Where and when: `window_s` must be kept, what begins after `due_s` is late and costs."""

    place: PlaceName
    window_s: Span = (0.0, None)
    due_s: Seconds | None = None
    service_s: Seconds = 0.0


class ItemEntry(StrictModel):
    """One delivery; `aboard` names the robot that has it already, in place of a pickup."""

    name: Name
    load: Load = 1.0
    pickup: VisitEntry | None = None
    aboard: Name | None = None
    delivery: VisitEntry
    max_on_board_s: Seconds | None = None

    @model_validator(mode="after")
    def _one_beginning(self) -> Self:
        if (self.pickup is None) == (self.aboard is None):
            raise ValueError("an item must have either 'pickup' or 'aboard'")
        return self


class TransfersEntry(StrictModel):
    """Where items may change robots: at the places listed, or anywhere."""

    places: tuple[PlaceName, ...] = ()
    anywhere: bool = False
    together: bool = False
    service_s: Seconds = 0.0

    @model_validator(mode="after")
    def _one_list(self) -> Self:
        if self.anywhere and self.places:
            raise ValueError("'places' say nothing more where transfers are possible 'anywhere'")
        return self


class WeightsEntry(StrictModel):
    """What a schedule costs: per metre, second of makespan, completion and lateness, and robot."""

    distance: Weight = 1.0
    makespan: Weight = 0.0
    completion: Weight = 0.0
    lateness: Weight = 1.0
    robots: Weight = 0.0


class DeliveryDocument(StrictModel):
    """A delivery file."""

    name: Name
    description: str = ""
    travel: TravelEntry
    robots: Annotated[tuple[RobotEntry, ...], Field(min_length=1, max_length=1000)]
    items: Annotated[tuple[ItemEntry, ...], Field(min_length=1, max_length=10_000)]
    transfers: TransfersEntry = TransfersEntry()
    weights: WeightsEntry = WeightsEntry()
