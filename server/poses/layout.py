"""The layout: what the frames of a run hold, and what stands still around it."""

from collections.abc import Sequence
from typing import Literal
from uuid import UUID

from mend.robots.link.messages import Hello, PoseLayout, Poses
from mend.server.models.robot_models import DrawnModel
from mend.server.runtime.run_state import RunState
from mend.server.runtime.views import View
from mend.tasks.scene import Place, Scene

RATE_HZ = 20.0
"""Frames per second of the robot's clock, at most."""

Triple = tuple[float, float, float]

_GREY: Triple = (0.5, 0.5, 0.5)


class ObjectLayout(View):
    """An object as it is drawn: a box, and a second one (`knob_m`) in the middle on top of it."""

    name: str
    kind: Literal["object", "obstacle"]
    shape: Literal["box"] = "box"
    size_m: Triple
    knob_m: Triple | None
    color: Triple


class PlaceLayout(View):
    """A target: where the bottom centre of an object is to rest, in the robot's base frame."""

    name: str
    position: Triple
    yaw: float


class TableLayout(View):
    """The work surface."""

    center: tuple[float, float]
    size_m: tuple[float, float]
    height_m: float


class ReachLayout(View):
    """The graspable range in the plane: distances from (x, y)."""

    x: float
    y: float
    min_m: float
    max_m: float


class ArmLayout(View):
    """The arm of another robot, and what frames tell of it."""

    robot: str
    model: str | None
    joints: list[str]
    own_colors: bool = False
    """Whether the model is drawn in the colours that it says."""


class Layout(View):
    """What every binary frame after it holds, in order, and what does not move."""

    type: Literal["layout"] = "layout"
    run: UUID
    robot: str
    model: str | None
    joints: list[str]
    objects: list[ObjectLayout]
    places: list[PlaceLayout]
    table: TableLayout
    reach: ReachLayout | None
    cameras: list[str]
    simulated: bool
    rate_hz: float = RATE_HZ
    robots: list[str] = []
    """Whose base frames each frame has, in this order; none where no robot drives."""
    arms: list[ArmLayout] = []
    """The robots beside `robot` that show an arm."""
    own_colors: bool = False
    """Whether the model is drawn in the colours that it says."""

    def fits(self, poses: Poses) -> bool:
        """Whether poses hold what this says."""
        joints, objects = len(poses.joints), len(poses.objects)
        return joints == len(self.joints) and objects == len(self.objects)


def lay_out(
    state: RunState,
    hello: Hello,
    shows: PoseLayout,
    model: DrawnModel | None,
    *,
    drives: bool = False,
    arms: Sequence[ArmLayout] = (),
) -> Layout:
    """The layout of a run with this robot; `model` is how it is drawn.

    `drives`: whether any robot of the run does. `arms`: those of others.
    """
    scene = state.scene if drives else state.frames[hello.robot].scene_to_robot(state.scene)
    return Layout(
        run=state.id,
        robot=hello.robot,
        model=None if model is None else model.address,
        own_colors=model is not None and model.own_colors,
        joints=shows.joints,
        objects=[
            ObjectLayout(
                name=each.name,
                kind=each.kind,
                size_m=each.size,
                knob_m=each.knob,
                color=each.color or _color(scene, each.name),
            )
            for each in shows.objects
        ],
        places=[_place(name, each, scene) for name, each in scene.places.items()],
        table=TableLayout(
            center=scene.table.center, size_m=scene.table.size, height_m=scene.table.height
        ),
        reach=ReachLayout(**hello.reach.model_dump()) if hello.reach else None,
        cameras=sorted(hello.cameras),
        simulated=hello.simulated,
        robots=list(state.frames) if drives else [],
        arms=list(arms),
    )


def arm_layout(robot: str, shows: PoseLayout, model: DrawnModel | None) -> ArmLayout:
    """What frames tell of the arm of a robot that shows this."""
    return ArmLayout(
        robot=robot,
        model=None if model is None else model.address,
        joints=shows.joints,
        own_colors=model is not None and model.own_colors,
    )


def _color(scene: Scene, name: str) -> Triple:
    return scene.objects[name].color if name in scene.objects else _GREY


def _place(name: str, place: Place, scene: Scene) -> PlaceLayout:
    pose = place.pose
    height = scene.table.height if pose.z is None else pose.z
    return PlaceLayout(name=name, position=(pose.x, pose.y, height), yaw=pose.yaw)
