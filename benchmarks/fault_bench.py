"""A workcell in which faults come at exact moments, and the judge who knows where things are."""

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from functools import lru_cache
from typing import Any, NamedTuple

import numpy as np

from robots.catalogue import Catalogue, Part
from robots.grasp import grasp_of
from robots.grip import GripReading, GripState
from robots.link.messages import (
    Finished,
    FinishedResult,
    Interrupt,
    IssueDetected,
    Look,
    Looked,
    ReportBody,
    Start,
    WasDone,
)
from robots.robot import Robot
from robots.senses import Senses
from sim.random_scene import NoRoomError, random_scene
from sim.workcell.colors import learn_colors
from sim.workcell.options import WorkcellOptions
from sim.workcell.parts import PartPose
from sim.workcell.world import WorkcellWorld
from sim.world import SceneChecker
from tasks.definition import BehaviorNode
from tasks.intervention import Act, Intervention
from tasks.plugins import load_plugins
from tasks.scene import Pose, Scene, SceneObject

LONGEST_S = 120.0
HAND_OVER_S = 9.0
MOST_PARTS = 6
THERE_M = 0.02
UPRIGHT_RAD = 0.2
LAST_STEP = 8
_CARRYING = range(3, 7)
_LIFTED = 4
_SLID_M = 0.01
_STACK_M = 0.12


class Moment(NamedTuple):
    """So far in a pick and place: step 0 is before the robot is told, 9 after it is done."""

    step: int
    fraction: float = 0.0


NEVER = Moment(99)
AFTER_DONE = Moment(LAST_STEP + 1)


class NotNowError(Exception):
    """A person cannot do what a fault takes; the trial says nothing."""


class PlainWatch:
    """The naive way: the blob's centre stays within a fixed range of the image."""

    RANGE_PX = 8.0

    def __init__(self) -> None:
        self.reset()

    def reset(self) -> None:
        self._center: np.ndarray | None = None
        self._outside = 0
        self.alarm_s: float | None = None

    def update(self, reading: GripReading) -> None:
        if reading.state is GripState.UNDECIDED:
            return
        seen = None if reading.blob is None else np.array(reading.blob.center)
        if self._center is None:
            self._center = seen
        inside = (
            seen is not None
            and self._center is not None
            and bool(np.abs(seen - self._center).max() <= self.RANGE_PX)
        )
        self._outside = 0 if inside else self._outside + 1
        if self._outside >= 2 and self.alarm_s is None:
            self.alarm_s = reading.image.time


class SharedSenses(Senses):
    """The robot's senses, whose forearm pictures the plain watch sees too."""

    plain: PlainWatch

    def read_grip(self) -> GripReading | None:
        reading = super().read_grip()
        if reading is not None:
            self.plain.update(reading)
        return reading


@dataclass(frozen=True, slots=True)
class Said:
    """An issue as the robot told it, and whether the world bore it out then."""

    issue: str
    time_s: float
    why: str
    true: bool


@dataclass(slots=True)
class Trial:
    """What became of one pick and place, or of one hand-over.

    `out_s` is from when the fingers really held the part no more after the fault. `placed`: in the
    end such a part stands at the place.
    """

    seed: int
    name: str
    kind: str
    moment: Moment = NEVER
    detail: str = ""
    said: list[Said] = field(default_factory=list)
    fault_s: float | None = None
    out_s: float | None = None
    plain_s: float | None = None
    finished: bool = False
    placed: bool = False


class Bench:
    """A workcell with a robot, driven cycle by cycle."""

    def __init__(self, scene: Scene, seed: int, noise: float, light: float) -> None:
        options = WorkcellOptions(renderer="fast", camera_noise=noise, light=light, depth_noise=1.0)
        self.scene, self.seed = scene, seed
        self.world = WorkcellWorld(scene, seed, options)
        model = learn_colors(scene, noise)
        catalogue = Catalogue.from_scene(scene)
        senses = SharedSenses(self.world.body, model, catalogue)
        senses.plain = self._plain = PlainWatch()
        self.robot = Robot(
            "r1",
            self.world.body,
            model,
            catalogue,
            load_plugins("mend.behaviors"),
            load_plugins("mend.monitors"),
            senses=senses,
        )
        self._trial: Trial | None = None
        self._was_held = False
        self._grasped: tuple[str, np.ndarray] | None = None
        self._looked: Looked | None = None
        self._executions = 0
        self.robot.attach(self._take, _ignore)
        self.alike = {name: self._equals(name) for name in scene.objects}

    # --- What the robot does ------------------------------------------------------------------

    def pick(
        self, trial: Trial, fault: Callable[[], None], was_done: WasDone | None = None
    ) -> None:
        """One pick and place, with `fault` at the trial's moment. Raises `NotNowError`."""
        self._trial, self._was_held, self._grasped = trial, False, None
        self._plain.reset()
        trial.finished = False
        if trial.moment.step == 0 and trial.fault_s is None:
            self._strike(trial, fault)
        self._executions += 1
        self.robot.handle(trial.name, self._start(trial.name, was_done))
        begin_s = self.robot.time_s()
        while self.robot.advance(self.world.body.control_period_s):
            progress = self.robot.task_progress
            step = 0 if progress is None else progress.step
            self._note_grasp(trial.name, step)
            due = progress is not None and (step, progress.fraction) >= trial.moment
            if due and trial.fault_s is None:
                self._strike(trial, fault)
            if step < LAST_STEP - 2 and trial.fault_s is not None and self._was_held:
                # Fingers that only lose touch for a moment have not lost what they hold.
                gone = self.world.held not in self.alike[trial.name]
                trial.out_s = (trial.out_s or self.robot.time_s()) if gone else None
            if self.robot.time_s() > begin_s + LONGEST_S:
                break
        trial.plain_s = self._plain.alarm_s
        trial.placed = self.at_place(trial.name)
        self._trial = None

    def strike_after_done(self, trial: Trial, fault: Callable[[], None], later_s: float) -> None:
        """`fault` once a part is placed; then the look before the next choice, and its leaf again.

        Raises `NotNowError`.
        """
        trial.moment = NEVER
        self.pick(trial, fault)
        trial.moment = AFTER_DONE
        if trial.said or not trial.placed:
            raise NotNowError("it was not placed")
        self._strike(trial, fault)
        self.let_pass(later_s)
        if self.looks_gone(trial.name):
            self.pick(trial, fault, was_done="gone")

    def _strike(self, trial: Trial, fault: Callable[[], None]) -> None:
        fault()
        trial.fault_s = self.robot.time_s()

    def _start(self, name: str, was_done: WasDone | None) -> Start:
        return Start(
            execution=f"{name}-{self._executions}",
            node="/0",
            behavior="pick_and_place",
            parameters={"object": name, "place": place_of(name)},
            was_done=was_done,
        )

    def looks_gone(self, name: str) -> bool:
        """Whether the robot's look at finished results says that this one is gone."""
        result = FinishedResult(object=name, place=place_of(name))
        looked = self._look(Look(finished=[result]))
        return looked is not None and result in looked.gone

    def take(self, wanted: str, offered: str) -> bool:
        """Whether the robot, told to take `wanted` from a person, takes what is `offered`."""
        self.act(Act.HAND_OVER, offered)
        looked = self._look(Look(expect="in_gripper", object=wanted, within_s=HAND_OVER_S))
        return looked is not None and bool(looked.fulfilled)

    def _look(self, look: Look) -> Looked | None:
        self._looked = None
        self.robot.handle("look", look)
        while self.robot.advance(1.0):
            pass
        return self._looked

    def let_pass(self, duration_s: float) -> None:
        """Nothing is done for so long."""
        end_s = self.robot.time_s() + duration_s
        while self.robot.time_s() < end_s:
            self.world.body.advance_cycle()

    def clear_up(self) -> bool:
        """Put everything back to where it started, with the robot as at first."""
        self.robot.handle("end", Interrupt(retreat=True))
        while self.robot.advance(1.0):
            pass
        try:
            if self.world.shown_poses()[-1].gone is False:
                self.act(Act.RELEASE)
            for each in self.scene.objects:
                self.world.parts[each].take_away()
            for each in sorted(self.scene.objects, key=self._start_z):
                self.act(Act.PUT_BACK, each)
        except NotNowError:
            return False
        self.let_pass(0.5)
        return True

    def _start_z(self, name: str) -> float:
        return self.world.parts[name].start.position[2]

    # --- What a person does -------------------------------------------------------------------

    def act(self, act: Act, name: str | None = None, **how: Any) -> None:
        """Do what a person does. Raises `NotNowError` where that cannot be."""
        given = {"act": act, "object": name, **how}
        reason = self.world.intervene(Intervention.model_validate(given))
        if reason:
            raise NotNowError(f"{act} {name}: {reason}")

    def swap(self, name: str, other: str) -> None:
        """Another part is where this one was."""
        parts = self.world.parts
        pose = parts[name].pose()
        parts[name].take_away()
        parts[other].put(pose)

    # --- How things really are ----------------------------------------------------------------

    def holds(self, name: str) -> bool:
        """Whether such a part is between the fingers, not only touched by fingers that met."""
        part = self.scene.objects[name]
        around = self.world.body.gripper_opening_m() > min((part.knob or part.size)[:2]) / 2
        return around and self.world.held in self.alike[name]

    def _note_grasp(self, name: str, step: int) -> None:
        if step in _CARRYING and self.holds(name):
            self._was_held = True
            held = self.world.held
            if step >= _LIFTED and self._grasped is None and held is not None:
                self._grasped = held, self._in_tool(held)

    def _has_slid(self) -> bool:
        """Whether what the fingers took is about to leave them: it is not where it was."""
        if self._grasped is None:
            return False
        held, at = self._grasped
        return float(np.linalg.norm(self._in_tool(held) - at)) > _SLID_M

    def _in_tool(self, name: str) -> np.ndarray:
        at = np.array([*self.world.parts[name].pose().position, 1.0])
        return np.asarray((np.linalg.inv(self.world.body.tool_pose()) @ at)[:3])

    def at_place(self, name: str) -> bool:
        """Whether such a part stands where this one belongs."""
        target = self.scene.places[place_of(name)].pose
        height_m = self.scene.table.height if target.z is None else target.z
        for each in self.alike[name]:
            part = self.world.parts[each]
            x, y, z = part.pose().position
            near = math.hypot(x - target.x, y - target.y) <= THERE_M
            upright = part.pose().tilt_rad <= UPRIGHT_RAD
            if not part.stolen and near and upright and abs(z - height_m) <= THERE_M:
                return True
        return False

    def is_true(self, issue: str, name: str) -> bool:
        """Whether an issue is so, as far as the world alone can tell."""
        part = self.world.parts[name]
        match issue:
            case "missed":
                return not self.holds(name) and not self._was_held
            case "dropped":
                return self._was_held and (not self.holds(name) or self._has_slid())
            case "missing":
                return part.stolen
            case "unreachable":
                return self.is_out_of_reach(name)
            case "undone":
                return not self.at_place(name)
            case "blocked":
                return self.is_obstructed(name)
            case _:
                return False

    def is_obstructed(self, name: str) -> bool:
        """Whether somebody stands in the way, or another part on this one or at its place."""
        if not self.world.shown_poses()[-1].gone:
            return True
        here = self.world.parts[name].pose().position
        target = self.scene.places[place_of(name)].pose
        radius_m = _radius_m(self.scene, name)
        for other, part in self.world.parts.items():
            if part.stolen or other in self.alike[name]:
                continue
            x, y, z = part.pose().position
            reach_m = radius_m + _radius_m(self.scene, other)
            over = math.hypot(x - here[0], y - here[1]) < reach_m and z > here[2] + THERE_M / 2
            if over or math.hypot(x - target.x, y - target.y) < reach_m:
                return True
        return False

    def is_out_of_reach(self, name: str) -> bool:
        """Whether the robot cannot take a part from where it is now: no scene may have it there."""
        parts = {
            each: self.world.parts[each].pose()
            for each in self.scene.objects
            if not self.world.parts[each].stolen
        }
        if name not in parts or parts[name].tilt_rad > UPRIGHT_RAD:
            return True
        objects = {each: self._now_at(each, pose) for each, pose in parts.items()}
        now = self.scene.model_copy(update={"objects": objects})
        return bool(_checker().check_scene(now, [leaf_of(name)]))

    def _now_at(self, name: str, pose: PartPose) -> SceneObject:
        x, y, z = pose.position
        on_table = abs(z - self.scene.table.height) < THERE_M / 2
        at = Pose(x=x, y=y, z=None if on_table else z, yaw=pose.yaw)
        return self.scene.objects[name].model_copy(update={"pose": at})

    # --- Within -------------------------------------------------------------------------------

    def _take(self, body: ReportBody, time_s: float, _: object) -> None:
        """Judge an issue at once, before anything moves on."""
        trial = self._trial
        match body:
            case Looked():
                self._looked = body
            case IssueDetected() if trial is not None and body.issue != "positioning":
                why = body.detection.explanation if body.detection else ""
                true = self.is_true(body.issue, trial.name)
                trial.said.append(Said(body.issue, time_s, why, true))
            case Finished() if trial is not None:
                trial.finished = True

    def _equals(self, name: str) -> frozenset[str]:
        mine = _look_of(self.scene, name)
        return frozenset(each for each in self.scene.objects if _look_of(self.scene, each) == mine)


def _ignore(_picture: object) -> None:
    """Nobody asked for pictures."""


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


def alone(bench: Bench) -> list[str]:
    """The parts that are on the table, with nothing on them, at their start and at their place."""
    scene = bench.scene
    top = scene.table.height + 1e-6
    stacked = [
        each.pose
        for each in (*scene.objects.values(), *scene.places.values())
        if (each.pose.z or 0.0) > top
    ]

    def is_free(x: float, y: float) -> bool:
        return all(math.hypot(x - each.x, y - each.y) > _STACK_M for each in stacked)

    return [
        name
        for name, each in scene.objects.items()
        if is_free(each.pose.x, each.pose.y)
        and is_free(scene.places[place_of(name)].pose.x, scene.places[place_of(name)].pose.y)
    ]


def width_m(bench: Bench, name: str) -> float:
    """How far apart the fingers are on a part."""
    part = bench.scene.objects[name]
    return grasp_of(Part(name, part.size, part.knob), bench.world.body.gripper).width_m


@lru_cache(maxsize=1)
def _checker() -> SceneChecker:
    adapter = load_plugins("mend.worlds")["workcell"]
    assert isinstance(adapter, SceneChecker)
    return adapter


def benches(seed: int, noise: float, light: float) -> Iterator[Bench]:
    """Workcells with random scenes, one after the other."""
    for number in range(seed, seed + 1_000_000):
        count = int(np.random.default_rng(number).integers(2, MOST_PARTS + 1))
        try:
            scene = random_scene(number, count, _checker().check_scene).scene
        except NoRoomError:
            continue
        bench = Bench(scene, number, noise, light)
        yield bench
        bench.world.close()
