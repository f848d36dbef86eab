"""The judge who knows where things are: whether what a robot says is so, and what it has done."""

import math
from functools import lru_cache
from typing import Any

import numpy as np

from mend.robots.catalogue import Catalogue
from mend.robots.vision.presence import is_near
from mend.robots.vision.seen_box import SeenBox
from mend.sim.workcell.parts import PartPose
from mend.sim.workcell.world import WorkcellWorld
from mend.sim.world import SceneChecker
from mend.tasks.definition import BehaviorNode
from mend.tasks.plugins import load_plugins
from mend.tasks.scene import Pose, Scene, SceneObject

THERE_M = 0.02
UPRIGHT_RAD = 0.2
_CARRYING = range(3, 7)
_LIFTED = 4
_SLID_M = 0.01


class Judge:
    """Knows a workcell, and what the fingers held in the pick and place under way.

    `alike` has, for each part, those that look as it does, itself among them.
    """

    def __init__(self, world: WorkcellWorld, scene: Scene) -> None:
        self._world, self._scene = world, scene
        self._catalogue = Catalogue.from_scene(scene)
        self.alike = {name: self._equals(name) for name in scene.objects}
        self.forget()

    def forget(self) -> None:
        """Another pick and place begins."""
        self.was_held = False
        self._grasped: tuple[str, np.ndarray] | None = None

    def note_grasp(self, name: str, step: int) -> None:
        """See what the fingers hold while a part is to be carried."""
        if step in _CARRYING and self.holds(name):
            self.was_held = True
            held = self._world.held
            if step >= _LIFTED and self._grasped is None and held is not None:
                self._grasped = held, self._in_tool(held)

    def is_let_go(self, name: str) -> bool:
        """Whether the world has it that no such part is held; it may be only for a moment."""
        return self._world.held not in self.alike[name]

    def holds(self, name: str) -> bool:
        """Whether such a part is between the fingers, not only touched by fingers that met."""
        part = self._scene.objects[name]
        around = self._world.body.gripper_opening_m() > min((part.knob or part.size)[:2]) / 2
        return around and self._world.held in self.alike[name]

    def _has_slid(self) -> bool:
        """Whether what the fingers took is about to leave them: it is not where it was."""
        if self._grasped is None:
            return False
        held, at = self._grasped
        return float(np.linalg.norm(self._in_tool(held) - at)) > _SLID_M

    def _in_tool(self, name: str) -> np.ndarray:
        at = np.array([*self._world.parts[name].pose().position, 1.0])
        return np.asarray((np.linalg.inv(self._world.body.tool_pose()) @ at)[:3])

    def at_place(self, name: str) -> bool:
        """Whether such a part stands where this one belongs."""
        target = self._catalogue.places[place_of(name)]
        height_m = self._scene.table.height if target.z is None else target.z
        part = self._catalogue.parts[name]
        for each in self.alike[name]:
            now = self._world.parts[each].pose()
            x, y, z = now.position
            box = SeenBox(x, y, now.yaw, part.size, z, None, complete=True)
            level = now.tilt_rad <= UPRIGHT_RAD and abs(z - height_m) <= THERE_M
            if not self._world.parts[each].stolen and level and is_near(box, part, target):
                return True
        return False

    def is_true(self, issue: str, name: str) -> bool:
        """Whether an issue is so, as far as the world alone can tell."""
        part = self._world.parts[name]
        match issue:
            case "missed":
                return not self.holds(name) and not self.was_held
            case "dropped":
                return self.was_held and (not self.holds(name) or self._has_slid())
            case "missing":
                return part.stolen
            case "unreachable":
                return self.is_out_of_reach(name)
            case "undone":
                return not self.at_place(name)
            case "blocked":
                return self.is_obstructed(name)
            case "blind":
                return self._world.head_covered
            case _:
                return False

    def is_obstructed(self, name: str) -> bool:
        """Whether somebody stands in the way, or another part on this one or at its place."""
        if not self._world.shown_poses()[-1].gone:
            return True
        here = self._world.parts[name].pose().position
        target = self._scene.places[place_of(name)].pose
        radius_m = _radius_m(self._scene, name)
        for other, part in self._world.parts.items():
            if part.stolen or other in self.alike[name]:
                continue
            x, y, z = part.pose().position
            reach_m = radius_m + _radius_m(self._scene, other)
            over = math.hypot(x - here[0], y - here[1]) < reach_m and z > here[2] + THERE_M / 2
            if over or math.hypot(x - target.x, y - target.y) < reach_m:
                return True
        return False

    def is_out_of_reach(self, name: str) -> bool:
        """Whether the robot cannot take a part from where it is now: no scene may have it there."""
        parts = {
            each: self._world.parts[each].pose()
            for each in self._scene.objects
            if not self._world.parts[each].stolen
        }
        if name not in parts or parts[name].tilt_rad > UPRIGHT_RAD:
            return True
        objects = {each: self._now_at(each, pose) for each, pose in parts.items()}
        now = self._scene.model_copy(update={"objects": objects})
        return bool(checker().check_scene(now, [leaf_of(name)]))

    def _now_at(self, name: str, pose: PartPose) -> SceneObject:
        x, y, z = pose.position
        on_table = abs(z - self._scene.table.height) < THERE_M / 2
        at = Pose(x=x, y=y, z=None if on_table else z, yaw=pose.yaw)
        return self._scene.objects[name].model_copy(update={"pose": at})

    def _equals(self, name: str) -> frozenset[str]:
        mine = _look_of(self._scene, name)
        return frozenset(
            each for each in self._scene.objects if _look_of(self._scene, each) == mine
        )


def _look_of(scene: Scene, name: str) -> tuple[Any, ...]:
    part = scene.objects[name]
    return part.size, part.knob, part.color


def _radius_m(scene: Scene, name: str) -> float:
    return math.hypot(*scene.objects[name].size[:2]) / 2


def leaf_of(name: str) -> BehaviorNode:
    """The leaf of a random task that places a part."""
    parameters = {"object": name, "place": place_of(name)}
    return BehaviorNode(parent=None, name=name, behavior="pick_and_place", parameters=parameters)


def place_of(name: str) -> str:
    """Where a random scene has a part go."""
    return name.replace("part", "place")


@lru_cache(maxsize=1)
def checker() -> SceneChecker:
    """Says what the workcell cannot do in a scene."""
    adapter = load_plugins("mend.worlds")["workcell"]
    assert isinstance(adapter, SceneChecker)
    return adapter
