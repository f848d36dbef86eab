"""What a robot is told about its work: the parts it may handle, the places, the table.

Where a part really is is for the cameras to find; `starts` only says which of several equal
parts goes by which name.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field

from mend.robots.link.messages import Location
from mend.tasks.part_boxes import Size, boxes_of, height_of
from mend.tasks.scene import Scene, Table


@dataclass(frozen=True, slots=True)
class Part:
    """An object as it is built: a box, or a plate with a knob on top."""

    name: str
    size: Size
    knob: Size | None = None
    needs_help: bool = False

    @property
    def height(self) -> float:
        """From its bottom to its highest point, in metres."""
        return height_of(self.size, self.knob)

    @property
    def boxes(self) -> list[tuple[float, Size]]:
        """Each of its boxes: how high its bottom is above the part's, and its extents."""
        return boxes_of(self.size, self.knob)

    @property
    def off_square_m(self) -> float:
        """By how much, at most, its sides differ from what they are after a quarter of a turn."""
        return max(abs(length - width) for _, (length, width, _) in self.boxes)

    def equals(self, other: "Part") -> bool:
        """Whether another part has exactly its measures."""
        return (self.size, self.knob) == (other.size, other.knob)


@dataclass(frozen=True, slots=True)
class Catalogue:
    """The parts and places that a robot knows by name, and the table they are on."""

    parts: Mapping[str, Part]
    places: Mapping[str, Location]
    table: Table
    starts: Mapping[str, tuple[float, float, float]] = field(default_factory=dict)

    @classmethod
    def from_scene(cls, scene: Scene) -> "Catalogue":
        """Take a scene's parts and places."""
        parts = {
            name: Part(name, each.size, each.knob, each.needs_help)
            for name, each in scene.objects.items()
        }
        places = {
            name: Location(x=each.pose.x, y=each.pose.y, z=each.pose.z, yaw=each.pose.yaw)
            for name, each in scene.places.items()
        }
        poses = {name: each.pose for name, each in scene.objects.items()}
        starts = {
            name: (pose.x, pose.y, scene.table.height if pose.z is None else pose.z)
            for name, pose in poses.items()
        }
        return cls(parts, places, scene.table, starts)

    def height_of(self, location: Location) -> float:
        """The height in metres at which something at `location` rests."""
        return self.table.height if location.z is None else location.z
