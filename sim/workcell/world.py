"""The workcell: a PR2 at a table with parts, in PyBullet, with a person who intervenes."""

import json
from collections.abc import Callable, Mapping, Sequence
from functools import partial
from typing import Any, Literal

import numpy as np

from mend.robots.body import Matrix4
from mend.robots.link.messages import ShownObject, ShownPose
from mend.sim.camera_cover import CoverableCamera
from mend.sim.depth_noise import DepthNoise
from mend.sim.hand_over import HandOverSnapshot
from mend.sim.lighting import Lighting
from mend.sim.raster import Light
from mend.sim.workcell.bench import Bench
from mend.sim.workcell.body import PERIOD_S, WorkcellBody
from mend.sim.workcell.cameras import (
    Optics,
    WorkcellCamera,
    forearm_optics,
    head_camera_pose,
    head_optics,
)
from mend.sim.workcell.options import WorkcellOptions
from mend.sim.workcell.parts import RigidPart
from mend.sim.workcell.person import WorkcellPerson
from mend.sim.workcell.physics import arrangement, connect
from mend.sim.workcell.pr2 import Pr2
from mend.sim.workcell.rendering import BulletRenderer, FastRenderer, Renderer
from mend.sim.workcell.snapshot import PartSnapshot, PoseSnapshot, WorkcellSnapshot
from mend.tasks.intervention import Intervention
from mend.tasks.scene import Scene

_GRAVITY_M_S2 = -9.81
LIGHT = Light(direction=(0.6, -0.4, 2.0), ambient=0.60, diffuse=0.35)
_GRASP_ITERATIONS = 100
_REST_ITERATIONS = 20
"""Solver iterations per step: what is grasped sags with few, what lies does not."""

_NEIGHBORS_WITHIN_M = 0.005
"""The engine wakes what sleeps within a few times this of something that moves; by default a
gripper that comes down wakes a whole dense table (16 instead of 33 s of physics for 32 parts)."""

_CONTACT_SLOP_M = 0.0001
"""What touches sinks in by so much: contacts that are found anew find something at once."""

_SETTLE_CYCLES = 120
_REMEMBER_RESTS_CYCLES = 24
_FOREARM_HZ = {"bullet": 10, "fast": 30}


class WorkcellWorld:
    """A simulated world; the same seed and the same calls give the same world."""

    def __init__(self, scene: Scene, seed: int, options: WorkcellOptions | None = None) -> None:
        """Raises `WorldUnavailableError` where the physics engine or the robot is missing."""
        chosen = options or WorkcellOptions()
        self._scene = scene
        layout_rng, light_rng, depth_rng, self._rng, self._sensor_rng = _generators(seed)
        self._lighting = Lighting(LIGHT, chosen.light, chosen.camera_noise, light_rng)
        self._depth_noise = DepthNoise(chosen.depth_noise, depth_rng)
        self._build(chosen)
        self._bench.lay_out(layout_rng)
        self._settle()
        self._bench.remember_starts()

    def _build(self, options: WorkcellOptions) -> None:
        client = connect()
        client.setPhysicsEngineParameter(
            fixedTimeStep=PERIOD_S,
            numSolverIterations=_REST_ITERATIONS,
            contactBreakingThreshold=_NEIGHBORS_WITHIN_M,
            enableFileCaching=0,
            contactSlop=_CONTACT_SLOP_M,
        )
        client.setGravity(0.0, 0.0, _GRAVITY_M_S2)
        self._client = client
        self._iterations = _REST_ITERATIONS
        self._bench = Bench(client, self._scene)
        self._pr2 = Pr2(client)
        self._body = WorkcellBody(self._pr2, self._rng, self._sensor_rng, self._step)
        self._person = WorkcellPerson(client, self._bench, self._pr2, self._body)
        self._renderer: Renderer = (
            BulletRenderer(client) if options.renderer == "bullet" else FastRenderer(client)
        )
        self.head = self.camera("head", head_optics())
        self.forearm = self.camera("forearm", forearm_optics(1.0 / _FOREARM_HZ[options.renderer]))
        self._body.cameras = {
            "head": CoverableCamera(self.head, self._person.head_cover),
            "forearm": self.forearm,
        }

    def camera(self, name: Literal["head", "forearm"], optics: Optics) -> WorkcellCamera:
        """Another camera where one of the robot's is."""
        poses: dict[str, Callable[[], Matrix4]] = {
            "head": head_camera_pose,
            "forearm": self._pr2.forearm_camera_pose,
        }
        return WorkcellCamera(
            optics,
            self._renderer,
            self._lighting,
            self._depth_noise,
            poses[name],
            self._body.time_s,
            partial(arrangement, self._client),
        )

    @property
    def body(self) -> WorkcellBody:
        return self._body

    def time_s(self) -> float:
        """The world's clock."""
        return self._body.time_s()

    def advance_cycle(self) -> None:
        """Let one control cycle pass."""
        self._body.advance_cycle()

    def intervene(self, intervention: Intervention) -> str:
        """Do what a person does; an empty string, or one sentence that says why it cannot be."""
        return self._person.intervene(intervention)

    @property
    def shown_objects(self) -> Sequence[ShownObject]:
        """The parts, then what somebody may hold in the arm's way."""
        parts = [
            ShownObject(name=each.name, size=each.definition.size, knob=each.definition.knob)
            for each in self.parts.values()
        ]
        return [*parts, self._person.obstacle.shown]

    def shown_poses(self) -> Sequence[ShownPose]:
        """Where they really are, for people who watch."""
        held = self._bench.held(self._pr2)
        parts = [self._shown_pose(each, held) for each in self.parts.values()]
        return [*parts, self._person.obstacle.shown_pose()]

    def _shown_pose(self, part: RigidPart, held: RigidPart | None) -> ShownPose:
        pose = part.pose()
        return ShownPose(
            pose=(*pose.position, *pose.quaternion),
            held=part is held,
            gone=part.stolen,
            hidden=part.hidden,
        )

    def snapshot(self) -> dict[str, Any]:
        """The state from which `restore` can rebuild the world; JSON-compatible."""
        held, hand_over = self._bench.held(self._pr2), self._person.hand_over
        return WorkcellSnapshot(
            cycle=self._body.cycle,
            parts={name: self._snapshot_of(part, held) for name, part in self.parts.items()},
            held=held.name if held else None,
            obstacle=self._person.obstacle.center,
            hand_over=HandOverSnapshot(object=hand_over.part.name, until_s=hand_over.until_s)
            if hand_over
            else None,
            generator=json.dumps(self._rng.bit_generator.state),
            head_covered=self._person.head_cover.on,
        ).model_dump(mode="json")

    def restore(self, snapshot: dict[str, Any]) -> None:
        """Rebuild the world: what was held lies where it last rested, the arm is at neutral.

        Raises `ValueError` for a snapshot of another version or of another scene.
        """
        saved = WorkcellSnapshot.model_validate_json(json.dumps(snapshot))
        if set(saved.parts) != set(self.parts):
            raise ValueError(
                f"the snapshot has the parts {sorted(saved.parts)}, the scene {sorted(self.parts)}"
            )
        self._person.withdraw()
        self._body.go_neutral_at_once()
        for name, each in saved.parts.items():
            self._restore_part(self.parts[name], each)
        self._settle()
        if saved.obstacle is not None:
            self._person.obstacle.stand_at(saved.obstacle)
        if saved.hand_over is not None:
            self._person.hold_out(self.parts[saved.hand_over.object], saved.hand_over.until_s)
        self._person.head_cover.on = saved.head_covered
        self._body.cycle = saved.cycle
        self._rng.bit_generator.state = json.loads(saved.generator)

    def close(self) -> None:
        """Give the physics engine's memory back."""
        self._client.disconnect()

    @property
    def parts(self) -> Mapping[str, RigidPart]:
        """The parts as they really are; for tests and benchmarks to judge by."""
        return self._bench.parts

    @property
    def head_covered(self) -> bool:
        """Whether somebody has covered the head camera; for benchmarks to judge by."""
        return self._person.head_cover.on

    @property
    def held(self) -> str | None:
        """What the fingers really hold; for tests and benchmarks to judge by."""
        part = self._bench.held(self._pr2)
        return part.name if part else None

    def _step(self) -> None:
        self._person.act()
        self._choose_iterations()
        self._client.stepSimulation()
        if self._body.cycle % _REMEMBER_RESTS_CYCLES == 0:
            self._bench.remember_rests(self._pr2, self._person.has_in_hand)

    def _choose_iterations(self) -> None:
        wanted = _GRASP_ITERATIONS if self._body.gripper_in_use else _REST_ITERATIONS
        if wanted != self._iterations:
            self._iterations = wanted
            self._client.setPhysicsEngineParameter(numSolverIterations=wanted)

    def _settle(self) -> None:
        """Let everything come to rest before the clock runs."""
        for _ in range(_SETTLE_CYCLES):
            self._body.advance_cycle()
        self._body.cycle = 0

    def _snapshot_of(self, part: RigidPart, held: RigidPart | None) -> PartSnapshot:
        in_the_air = part is held or self._person.has_in_hand(part)
        rest = part.last_rest if in_the_air or part.stolen else part.pose()
        return PartSnapshot(
            rest=PoseSnapshot.of(rest),
            start=PoseSnapshot.of(part.start),
            stolen=part.stolen or self._person.is_pulling(part),
        )

    def _restore_part(self, part: RigidPart, saved: PartSnapshot) -> None:
        part.start = saved.start.to_pose()
        part.last_rest = saved.rest.to_pose()
        if saved.stolen:
            part.take_away()
        else:
            part.put(part.last_rest)


def _generators(seed: int) -> list[np.random.Generator]:
    """One each for the layout, the light, the depth's noise, the person and arm, the sensors."""
    return np.random.default_rng(seed).spawn(5)
