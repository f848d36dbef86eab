"""Where the parts of a scene stand, or are to stand, as upright boxes."""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import shapely

from mend.robots.catalogue import Part
from mend.robots.vision.seen_box import SeenBox
from mend.tasks.scene import RESTS_M, Pose, Scene

_OVERLAP_M = 0.001
"""What overlaps by less only touches."""


@dataclass(frozen=True, slots=True)
class Standing:
    """A part at a pose; `where` are the keys to that pose in the scene's document."""

    part: Part
    pose: Pose
    bottom_z: float
    where: tuple[str, ...]

    @property
    def name(self) -> str:
        return self.part.name

    @property
    def deck_z(self) -> float:
        """The height of the surface that something can stand on: of a plate, not of its knob."""
        return self.bottom_z + self.part.size[2]

    @property
    def boxes(self) -> list[SeenBox]:
        """The part's body, and its knob."""
        body = self._box(self.part.size, self.bottom_z)
        return [body] if self.part.knob is None else [body, self._box(self.part.knob, self.deck_z)]

    @property
    def ground(self) -> shapely.Polygon:
        """What it covers, from above."""
        return shapely.Polygon(self.boxes[0].corners())

    def meets(self, other: "Standing") -> bool:
        """Whether both are in one space, one of them inside the other."""
        return any(_intersect(one, two) for one in self.boxes for two in other.boxes)

    def _box(self, size: tuple[float, float, float], bottom_z: float) -> SeenBox:
        pose = self.pose
        return SeenBox(pose.x, pose.y, pose.yaw, size, bottom_z, self.part.name, complete=True)


def starts(scene: Scene) -> dict[str, Standing]:
    """Where every object starts."""
    return {
        name: _standing(scene, name, each.pose, ("objects", name, "pose"))
        for name, each in scene.objects.items()
    }


def at_place(scene: Scene, name: str, place: str) -> Standing:
    """An object at a place."""
    return _standing(scene, name, scene.places[place].pose, ("places", place, "pose"))


def beneath(standing: Standing, others: Sequence[Standing]) -> list[Standing]:
    """What a part stands on, but for the table."""
    return [
        other
        for other in others
        if abs(other.deck_z - standing.bottom_z) <= RESTS_M
        and other.ground.intersection(standing.ground).area > 0.0
    ]


def resting_on(lowest: Standing, others: Sequence[Standing]) -> list[Standing]:
    """All that stands on a part, directly or by way of others."""
    found: list[Standing] = []
    layer = [lowest]
    while layer:
        layer = [
            each
            for each in others
            if each not in found and any(one in layer for one in beneath(each, layer))
        ]
        found += layer
    return found


def _standing(scene: Scene, name: str, pose: Pose, where: tuple[str, ...]) -> Standing:
    made = scene.objects[name]
    bottom_z = scene.table.height if pose.z is None else pose.z
    return Standing(Part(name, made.size, made.knob), pose, bottom_z, where)


def _intersect(one: SeenBox, two: SeenBox) -> bool:
    deep_m = min(one.top_z, two.top_z) - max(one.bottom_z, two.bottom_z)
    reach_m = (math.hypot(*one.size[:2]) + math.hypot(*two.size[:2])) / 2
    if deep_m <= RESTS_M or math.hypot(one.x - two.x, one.y - two.y) >= reach_m:
        return False
    outlines = (shapely.Polygon(each.corners()).buffer(-_OVERLAP_M / 2) for each in (one, two))
    first, second = outlines
    return bool(first.intersects(second))
