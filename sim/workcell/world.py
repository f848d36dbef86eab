"""The workcell: PR2s at a table with parts, in PyBullet, with a person who intervenes."""

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any, Literal

import numpy as np

from mend.robots.link.messages import ShownObject, ShownPose
from mend.sim.camera_cover import CoverableCamera
from mend.sim.depth_noise import DepthNoise
from mend.sim.hand_over import HandOverSnapshot
from mend.sim.lighting import Lighting
from mend.sim.raster import Light
from mend.sim.workcell.bench import Bench
from mend.sim.workcell.body import WorkcellBody
from mend.sim.workcell.cameras import (
    Mount,
    Optics,
    WorkcellCamera,
    forearm_optics,
    head_camera_pose,
    head_optics,
)
from mend.sim.workcell.clock import PERIOD_S, Clock
from mend.sim.workcell.options import WorkcellOptions
from mend.sim.workcell.parts import RigidPart
from mend.sim.workcell.person import WorkcellPerson
from mend.sim.workcell.physics import arrangement, connect
from mend.sim.workcell.pr2 import Pr2
from mend.sim.workcell.rendering import BulletRenderer, FastRenderer, Renderer
from mend.sim.workcell.snapshot import PartSnapshot, PoseSnapshot, WorkcellSnapshot
from mend.tasks.frames import frames_of
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


@dataclass(frozen=True, slots=True)
class RobotCameras:
    """The cameras of one robot."""

    head: WorkcellCamera
    forearm: WorkcellCamera


class WorkcellWorld:
    """A simulated world; the same seed and the same calls give the same world."""

    def __init__(self, scene: Scene, seed: int, options: WorkcellOptions | None = None) -> None:
        """Raises `WorldUnavailableError` where the physics engine or the robot is missing."""
        chosen = options or WorkcellOptions()
        self._scene = scene
        randomness = np.random.default_rng(seed)
        # One each for the layout, the light and the depth's noise; then two for each robot.
        layout_rng, light_rng, depth_rng = randomness.spawn(3)
        self._randomness = randomness
        self._generators: list[np.random.Generator] = []
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
        self._clock = Clock()
        self.bodies = [self._robot(Pr2(client, each)) for each in frames_of(self._scene).values()]
        self._person = WorkcellPerson(client, self._bench, self._clock, self.bodies)
        self._renderer: Renderer = (
            BulletRenderer(client) if options.renderer == "bullet" else FastRenderer(client)
        )
        forearm = forearm_optics(1.0 / _FOREARM_HZ[options.renderer])
        self.cameras = [
            RobotCameras(
                self.camera("head", head_optics(), each), self.camera("forearm", forearm, each)
            )
            for each in self.bodies
        ]
        for body, cameras in zip(self.bodies, self.cameras, strict=True):
            body.cameras = {
                "head": CoverableCamera(cameras.head, self._person.head_cover),
                "forearm": cameras.forearm,
            }

    def _robot(self, pr2: Pr2) -> WorkcellBody:
        rng, sensor_rng = self._randomness.spawn(2)
        self._generators.append(rng)
        return WorkcellBody(pr2, rng, sensor_rng, self._clock, self.advance_cycle)

    def camera(
        self, name: Literal["head", "forearm"], optics: Optics, body: WorkcellBody | None = None
    ) -> WorkcellCamera:
        """Another camera where one of a robot's is; without `body`, of the first."""
        pr2 = (body or self.body).pr2
        pose = head_camera_pose if name == "head" else pr2.forearm_camera_pose
        return WorkcellCamera(
            optics,
            self._renderer,
            self._lighting,
            self._depth_noise,
            Mount(pr2.base, pose, partial(self._other_bodies, pr2)),
            self._clock.time_s,
            partial(arrangement, self._client),
        )

    def _other_bodies(self, pr2: Pr2) -> list[int]:
        """The ids of the other robots, and of what they hold."""
        others = [each.pr2 for each in self.bodies if each.pr2 is not pr2]
        held = [part for each in others if (part := self._bench.held(each)) is not None]
        return [*(each.body_id for each in others), *(part.body_id for part in held)]

    @property
    def body(self) -> WorkcellBody:
        """That of the only robot, or of the first."""
        return self.bodies[0]

    @property
    def head(self) -> WorkcellCamera:
        """The head camera of the only robot, or of the first."""
        return self.cameras[0].head

    @property
    def forearm(self) -> WorkcellCamera:
        """The forearm camera of the only robot, or of the first."""
        return self.cameras[0].forearm

    def time_s(self) -> float:
        """The world's clock."""
        return self._clock.time_s()

    def advance_cycle(self) -> None:
        """Let one control cycle pass, for all robots at once."""
        for each in self.bodies:
            each.begin_cycle()
        self._person.act()
        self._choose_iterations()
        self._client.stepSimulation()
        if self._clock.cycle % _REMEMBER_RESTS_CYCLES == 0:
            robots = [each.pr2 for each in self.bodies]
            self._bench.remember_rests(robots, self._person.has_in_hand)
        for each in self.bodies:
            each.end_cycle()
        self._clock.cycle += 1

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
        held = self._all_held()
        parts = [self._shown_pose(each, held) for each in self.parts.values()]
        return [*parts, self._person.obstacle.shown_pose()]

    def _shown_pose(self, part: RigidPart, held: Sequence[RigidPart]) -> ShownPose:
        pose = part.pose()
        return ShownPose(
            pose=(*pose.position, *pose.quaternion),
            held=part in held,
            gone=part.stolen,
            hidden=part.hidden,
        )

    def snapshot(self) -> dict[str, Any]:
        """The state from which `restore` can rebuild the world; JSON-compatible."""
        held, hand_over = self._all_held(), self._person.hand_over
        first, *others = (json.dumps(each.bit_generator.state) for each in self._generators)
        return WorkcellSnapshot(
            cycle=self._clock.cycle,
            parts={name: self._snapshot_of(part, held) for name, part in self.parts.items()},
            held=held[0].name if held else None,
            also_held=[each.name for each in held[1:]],
            obstacle=self._person.obstacle.center,
            hand_over=HandOverSnapshot(object=hand_over.part.name, until_s=hand_over.until_s)
            if hand_over
            else None,
            generator=first,
            other_generators=others,
            head_covered=self._person.head_cover.on,
        ).model_dump(mode="json")

    def restore(self, snapshot: dict[str, Any]) -> None:
        """Rebuild the world: what was held lies where it last rested, the arms are at neutral.

        Raises `ValueError` for a snapshot of another version or of another scene.
        """
        saved = WorkcellSnapshot.model_validate_json(json.dumps(snapshot))
        if set(saved.parts) != set(self.parts):
            raise ValueError(
                f"the snapshot has the parts {sorted(saved.parts)}, the scene {sorted(self.parts)}"
            )
        generators = [saved.generator, *saved.other_generators]
        if len(generators) != len(self.bodies):
            raise ValueError(
                f"the snapshot has {len(generators)} robots, the scene {len(self.bodies)}"
            )
        self._person.withdraw()
        for body in self.bodies:
            body.go_neutral_at_once()
        for name, each in saved.parts.items():
            self._restore_part(self.parts[name], each)
        self._settle()
        if saved.obstacle is not None:
            self._person.obstacle.stand_at(saved.obstacle)
        if saved.hand_over is not None:
            self._person.hold_out(self.parts[saved.hand_over.object], saved.hand_over.until_s)
        self._person.head_cover.on = saved.head_covered
        self._clock.cycle = saved.cycle
        for generator, state in zip(self._generators, generators, strict=True):
            generator.bit_generator.state = json.loads(state)

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
        """What any fingers really hold; for tests and benchmarks to judge by."""
        held = self._all_held()
        return held[0].name if held else None

    def held_by(self, body: WorkcellBody) -> RigidPart | None:
        """What the fingers of one robot really hold; for tests and benchmarks to judge by."""
        return self._bench.held(body.pr2)

    def _all_held(self) -> list[RigidPart]:
        held = (self.held_by(each) for each in self.bodies)
        return [part for part in held if part is not None]

    def _choose_iterations(self) -> None:
        grasping = any(each.gripper_in_use for each in self.bodies)
        wanted = _GRASP_ITERATIONS if grasping else _REST_ITERATIONS
        if wanted != self._iterations:
            self._iterations = wanted
            self._client.setPhysicsEngineParameter(numSolverIterations=wanted)

    def _settle(self) -> None:
        """Let everything come to rest before the clock runs."""
        for _ in range(_SETTLE_CYCLES):
            self.advance_cycle()
        self._clock.cycle = 0

    def _snapshot_of(self, part: RigidPart, held: Sequence[RigidPart]) -> PartSnapshot:
        in_the_air = part in held or self._person.has_in_hand(part)
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
