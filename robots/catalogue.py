"""What a robot is told about its work: the parts it may handle, the places, the table.

Nothing here says where a part is; that is for the cameras to find.
"""

from collections.abc import Mapping
from dataclasses import dataclass

from robots.link.messages import Location
from tasks.scene import Scene, Table

Size = tuple[float, float, float]
"""Full extents along x, y and z in metres."""


@dataclass(frozen=True, slots=True)
class Part:
    """An object as it is built: a box, or a plate with a knob on top."""

    name: str
    size: Size
    knob: Size | None = None
    needs_help: bool = False


@dataclass(frozen=True, slots=True)
class Catalogue:
    """The parts and places that a robot knows by name, and the table they are on."""

    parts: Mapping[str, Part]
    places: Mapping[str, Location]
    table: Table

    @classmethod
    def from_scene(cls, scene: Scene) -> "Catalogue":
        """Take everything from a scene but where its objects are."""
        parts = {
            name: Part(name, each.size, each.knob, each.needs_help)
            for name, each in scene.objects.items()
        }
        places = {
            name: Location(x=each.pose.x, y=each.pose.y, z=each.pose.z, yaw=each.pose.yaw)
            for name, each in scene.places.items()
        }
        return cls(parts, places, scene.table)

    def height_of(self, location: Location) -> float:
        """The height in metres at which something at `location` rests."""
        return self.table.height if location.z is None else location.z
