"""The tabletop world: a table, parts, people and a robot, without physics."""

import json
import math
from collections.abc import Sequence
from dataclasses import astuple, dataclass
from typing import Any

import numpy as np

from mend.robots.arm.body import Reach
from mend.robots.link.messages import ShownObject, ShownPose
from mend.sim.camera_cover import CoverableCamera
from mend.sim.depth_noise import DepthNoise
from mend.sim.lighting import Lighting
from mend.sim.raster import Light
from mend.sim.tabletop.blocker import SIZE_M as BLOCKER_SIZE_M
from mend.sim.tabletop.blocker import Blocker
from mend.sim.tabletop.body import TabletopBody
from mend.sim.tabletop.options import REACH_MIN_M, TabletopOptions
from mend.sim.tabletop.part import TablePart, UprightPose, Whereabouts
from mend.sim.tabletop.person import TabletopPerson
from mend.sim.tabletop.scenery import (
    BLOCKER_COLOR,
    ForearmCamera,
    HeadCamera,
    Scenery,
    head_exposures,
)
from mend.sim.tabletop.snapshot import TabletopSnapshot, to_rest_pose
from mend.sim.tabletop.state import TabletopState
from mend.tasks.intervention import Intervention
from mend.tasks.scene import Scene

REACH_ORIGIN = (0.0, -0.19)
REACH_MAX_M = 0.79
"""The graspable range of the workcell's robot, so that scenes mean the same in both worlds."""


@dataclass(frozen=True, slots=True)
class RobotCameras:
    """The cameras of one robot."""

    head: HeadCamera
    forearm: ForearmCamera


class TabletopWorld:
    """A world in which every motion is a straight line and everything let go falls at once."""

    def __init__(self, scene: Scene, seed: int, options: TabletopOptions | None = None) -> None:
        self.scene = scene
        chosen = options or TabletopOptions()
        layout_rng, light_rng, depth_rng = np.random.default_rng(seed).spawn(3)
        self._state = TabletopState(scene, layout_rng)
        self._person = TabletopPerson(self._state)
        self._state.person_acts = self._person.act
        scenery = Scenery(self._state)
        lighting = Lighting(Light(), chosen.light, chosen.camera_noise, light_rng)
        depth_noise = DepthNoise(chosen.depth_noise, depth_rng, head_exposures(scene.table))
        self.cameras = [
            RobotCameras(
                HeadCamera(self._state, each, scenery, lighting, depth_noise),
                ForearmCamera(self._state, each, scenery, lighting, depth_noise),
            )
            for each in self._state.manipulators
        ]
        reach = reach_for(scene, chosen.reach_m)
        self.bodies = [
            TabletopBody(
                self._state,
                manipulator,
                {
                    "head": CoverableCamera(cameras.head, self._person.head_cover),
                    "forearm": cameras.forearm,
                },
                reach,
            )
            for manipulator, cameras in zip(self._state.manipulators, self.cameras, strict=True)
        ]

    @property
    def body(self) -> TabletopBody:
        """That of the only robot, or of the first."""
        return self.bodies[0]

    def time_s(self) -> float:
        """The world's clock."""
        return self._state.time_s

    def advance_cycle(self) -> None:
        """Let one control cycle pass."""
        self._state.advance_cycle()

    def intervene(self, intervention: Intervention) -> str:
        """Do what a person does; an empty string, or one sentence that says why it cannot be."""
        return self._person.intervene(intervention)

    @property
    def shown_objects(self) -> Sequence[ShownObject]:
        """The parts, then whoever may stand in the arm's way."""
        parts = [
            ShownObject(name=each.name, size=each.size, knob=each.knob)
            for each in self._state.parts.values()
        ]
        blocker = ShownObject(
            name="obstacle", kind="obstacle", size=BLOCKER_SIZE_M, color=BLOCKER_COLOR
        )
        return [*parts, blocker]

    def shown_poses(self) -> Sequence[ShownPose]:
        """Where they really are, for people who watch."""
        parts = [_shown_pose(each) for each in self._state.parts.values()]
        blocker = self._state.blocker
        x, y, bottom_z = (0.0, 0.0, 0.0) if blocker is None else blocker.foot
        foot = (x, y, bottom_z, 0.0, 0.0, 0.0, 1.0)
        return [*parts, ShownPose(pose=foot, gone=blocker is None)]

    def snapshot(self) -> dict[str, Any]:
        """The state from which `restore` can rebuild the world; JSON-compatible."""
        state, hand_over = self._state, self._person.hand_over
        held = self._all_held()
        return {
            "version": 2,
            "time_s": state.time_s,
            "moved": {
                name: list(to_rest_pose(part.last_rest))
                for name, part in state.parts.items()
                if part.last_rest is not part.start
            },
            "gone": [name for name, part in state.parts.items() if self._is_lost(part)],
            "held": held[0] if held else None,
            "also_held": held[1:],
            "blocker": list(astuple(state.blocker)) if state.blocker else None,
            "hand_over": {"object": hand_over.part.name, "until_s": hand_over.until_s}
            if hand_over
            else None,
            "head_covered": self._person.head_cover.on,
        }

    def restore(self, snapshot: dict[str, Any]) -> None:
        """Rebuild the world: what was in the air lies where it last rested, the arm is at neutral.

        Raises `ValueError` for a snapshot of another version or of another scene.
        """
        saved = TabletopSnapshot.model_validate_json(json.dumps(snapshot))
        unknown = sorted({*saved.moved, *saved.gone} - set(self._state.parts))
        if unknown:
            raise ValueError(f"the snapshot has parts that the scene has not: {unknown}")
        self._person.withdraw()
        self._state.reset(saved.time_s, Blocker(*saved.blocker) if saved.blocker else None)
        for name, part in self._state.parts.items():
            rest = saved.moved.get(name)
            part.rest_at(part.start if rest is None else UprightPose(*rest))
            if name in saved.gone:
                part.give_to(Whereabouts.GONE)
        if saved.hand_over is not None:
            part = self._state.parts[saved.hand_over.object]
            self._person.hold_out(part, saved.hand_over.until_s)
        self._person.head_cover.on = saved.head_covered
        self._state.settle()

    def close(self) -> None:
        """Nothing to give back."""

    def pose_of(self, name: str) -> UprightPose | None:
        """Where a part really is, None if it is gone; for tests and benchmarks to judge by."""
        part = self._state.parts[name]
        return None if part.whereabouts is Whereabouts.GONE else part.pose

    @property
    def held(self) -> str | None:
        """What any fingers really hold; for tests and benchmarks to judge by."""
        held = self._all_held()
        return held[0] if held else None

    def _all_held(self) -> list[str]:
        return [each.held.name for each in self._state.manipulators if each.held is not None]

    def _is_lost(self, part: TablePart) -> bool:
        return part.whereabouts is Whereabouts.GONE or self._person.is_pulling(part)


def _shown_pose(part: TablePart) -> ShownPose:
    pose, half = part.pose, part.pose.yaw / 2
    return ShownPose(
        pose=(pose.x, pose.y, pose.z, 0.0, 0.0, math.sin(half), math.cos(half)),
        held=part.whereabouts is Whereabouts.HELD,
        gone=part.whereabouts is Whereabouts.GONE,
        hidden=not part.shown,
    )


def reach_for(scene: Scene, reach_m: float | None) -> Reach:
    """How far an arm reaches; one that is alone without `reach_m`, at least to every place."""
    if scene.robots:
        return Reach(REACH_ORIGIN, REACH_MIN_M, reach_m or REACH_MAX_M)
    farthest = max(
        (math.dist(REACH_ORIGIN, (each.pose.x, each.pose.y)) for each in scene.places.values()),
        default=0.0,
    )
    return Reach(REACH_ORIGIN, REACH_MIN_M, reach_m or max(REACH_MAX_M, farthest + 0.02))
