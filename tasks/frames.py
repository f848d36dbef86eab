"""From the frame of a scene to that of a robot that stands in it, and back."""

import math
from dataclasses import dataclass
from typing import Self

from mend.tasks.scene import QUARTER, Base, Place, Pose, Scene, SceneObject, Table

ALONE = "pr2"
"""What a robot is called that stands alone."""


@dataclass(frozen=True, slots=True)
class Frame:
    """A robot's base frame in the scene's: its origin, and its yaw in quarters of a turn."""

    x: float = 0.0
    y: float = 0.0
    quarters: int = 0

    @classmethod
    def of(cls, base: Base) -> Self:
        return cls(base.x, base.y, round(base.yaw / QUARTER) % 4)

    @property
    def yaw(self) -> float:
        return self.quarters * QUARTER

    def to_robot(self, x: float, y: float) -> tuple[float, float]:
        """A point of the scene's plane as the robot has it."""
        return _turned(x - self.x, y - self.y, -self.quarters)

    def to_scene(self, x: float, y: float) -> tuple[float, float]:
        """A point of the robot's plane as the scene has it."""
        turned = _turned(x, y, self.quarters)
        return turned[0] + self.x, turned[1] + self.y

    def pose_to_robot(self, pose: Pose) -> Pose:
        """A pose of the scene as the robot has it."""
        x, y = self.to_robot(pose.x, pose.y)
        return Pose(x=x, y=y, z=pose.z, yaw=_wrapped(pose.yaw - self.yaw))

    def table_to_robot(self, table: Table) -> Table:
        """A table of the scene as the robot has it."""
        size = table.size[::-1] if self.quarters % 2 else table.size
        return Table(height=table.height, center=self.to_robot(*table.center), size=size)

    def scene_to_robot(self, scene: Scene) -> Scene:
        """A scene as the robot has it: itself in the middle, and nobody else."""
        if self == Frame():
            return scene.model_copy(update={"robots": {}})
        return scene.model_copy(
            update={
                "table": self.table_to_robot(scene.table),
                "objects": {name: self._object(each) for name, each in scene.objects.items()},
                "places": {
                    name: Place(pose=self.pose_to_robot(each.pose))
                    for name, each in scene.places.items()
                },
                "robots": {},
            }
        )

    def _object(self, part: SceneObject) -> SceneObject:
        return part.model_copy(update={"pose": self.pose_to_robot(part.pose)})


def frames_of(scene: Scene) -> dict[str, Frame]:
    """The frame of each robot of a scene, by the name that the scene gives it."""
    if not scene.robots:
        return {ALONE: Frame()}
    return {name: Frame.of(base) for name, base in scene.robots.items()}


def _turned(x: float, y: float, quarters: int) -> tuple[float, float]:
    match quarters % 4:
        case 0:
            return x, y
        case 1:
            return -y, x
        case 2:
            return -x, -y
        case _:
            return y, -x


def _wrapped(yaw: float) -> float:
    """Between -pi and pi, so that it stays what a scene may hold; the same where it is that."""
    return yaw if -math.pi <= yaw <= math.pi else math.remainder(yaw, 2 * math.pi)
