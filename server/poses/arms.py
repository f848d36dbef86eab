"""The arms of a run beside the one of its layout's robot."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass

from mend.robots.link.messages import Hello, PoseLayout, Poses, PoseValues, ShownPose
from mend.server.models.robot_models import DrawnModel
from mend.server.poses.bases import in_scene, joined, seen_from
from mend.server.poses.layout import ArmLayout, arm_layout
from mend.tasks.frames import Frame


@dataclass(frozen=True, slots=True)
class SeenArm:
    """An arm as its robot told of it last, `age_s` ago by the run's clock.

    `number`: its place among the layout's `arms`. `base` is in the base frame of the layout's
    robot, and the tool of `poses` in its own.
    """

    number: int
    base: PoseValues
    age_s: float
    poses: Poses


@dataclass(frozen=True, slots=True)
class _Told:
    time_s: float
    poses: Poses


class OtherArms:
    """What the robots of a run beside that of its layout show of their arms, the newest of it.

    `frames` are those in which robots tell where they are.
    """

    def __init__(self, frames: Mapping[str, Frame]) -> None:
        self._frames = frames
        self._shows: dict[str, PoseLayout] = {}
        self._told: dict[str, _Told] = {}

    def connect(self, hello: Hello, shows: PoseLayout) -> None:
        """A robot of the run is there (again), and `shows` this."""
        if hello.robot not in self._frames or (shows.drives and not shows.joints):
            return
        if self._shows.get(hello.robot) != shows:
            self._told.pop(hello.robot, None)
        self._shows[hello.robot] = shows

    def layouts(self, but: str, model: Callable[[str], DrawnModel | None]) -> list[ArmLayout]:
        """Of all that have shown an arm `but` one; `model` finds how it is drawn."""
        return [
            arm_layout(robot, shows, None if shows.model is None else model(shows.model))
            for robot in self._frames
            if robot != but and (shows := self._shows.get(robot)) is not None
        ]

    def take(self, robot: str, time_s: float, poses: Poses) -> None:
        """What a robot of the run has told; poses that do not fit what it shows are left out."""
        shows = self._shows.get(robot)
        if shows is not None and len(poses.joints) == len(shows.joints):
            self._told[robot] = _Told(time_s, poses)

    def at(self, time_s: float, arms: list[ArmLayout], base: PoseValues) -> list[SeenArm]:
        """Those of a layout that have been told of; `base` is that of its robot in the scene."""
        return [
            SeenArm(
                number,
                seen_from(base, in_scene(self._frames[arm.robot], told.poses.base)),
                max(0.0, time_s - told.time_s),
                told.poses,
            )
            for number, arm in enumerate(arms)
            if (told := self._told.get(arm.robot)) is not None
        ]

    def held(self, arms: list[ArmLayout], seen: list[SeenArm]) -> dict[str, ShownPose]:
        """What they hold, in the base frame of the layout's robot."""
        found = {}
        for arm in seen:
            names = [each.name for each in self._shows[arms[arm.number].robot].objects]
            for name, shown in zip(names, arm.poses.objects, strict=False):
                if shown.held:
                    pose = joined(arm.base, shown.pose)
                    found[name] = shown.model_copy(update={"pose": pose})
        return found
