"""What is read of Open-RMF's plans of buildings (`building.yaml`)."""

from typing import Annotated, Any, Literal

from pydantic import BaseModel, BeforeValidator, ConfigDict, Field

Text = Annotated[str, BeforeValidator(str)]
"""Names may be numbers there."""
Coordinate = Annotated[float, Field(ge=-1e9, le=1e9, allow_inf_nan=False)]
"""Of a drawing, in pixels, metres or degrees."""
Properties = dict[str, tuple[int, Any]]
Vertex = (
    tuple[Coordinate, Coordinate, float]
    | tuple[Coordinate, Coordinate, float, Text]
    | (tuple[Coordinate, Coordinate, float, Text, Properties])
)
Edge = tuple[int, int] | tuple[int, int, Properties]
Fiducial = tuple[Coordinate, Coordinate, Text]


class _Lenient(BaseModel):
    model_config = ConfigDict(extra="ignore")


class Level(_Lenient):
    elevation: float = 0.0
    vertices: list[Vertex] = []
    lanes: list[Edge] = []
    walls: list[Edge] = []
    doors: list[Edge] = []
    measurements: list[Edge] = []
    fiducials: list[Fiducial] = []


class Lift(_Lenient):
    """`x`, `y` in its reference level's drawing; `width` along its turned x axis, in metres."""

    level_doors: dict[Text, list[Text]] = {}
    reference_floor_name: Text | None = None
    x: Coordinate = 0.0
    y: Coordinate = 0.0
    yaw: float = 0.0
    width: float = 0.0
    depth: float = 0.0


class Plan(_Lenient):
    name: Text = "building"
    coordinate_system: Literal["reference_image", "wgs84", "cartesian_meters"] = "reference_image"
    reference_level_name: Text | None = None
    levels: dict[Text, Level]
    lifts: dict[Text, Lift] = {}


def property_of(of: Vertex | Edge, name: str, otherwise: Any = None) -> Any:
    """The value of a property, which comes as a number for its type and the value."""
    last = of[-1]
    return last[name][1] if isinstance(last, dict) and name in last else otherwise
