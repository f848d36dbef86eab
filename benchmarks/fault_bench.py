"""A workcell in which faults come at exact moments."""

import math
from collections.abc import Callable, Iterator
from typing import Any

import numpy as np
from fault_judge import Judge, checker, place_of
from fault_trial import AFTER_DONE, LAST_STEP, NEVER, NotNowError, Said, Trial
from plain_watch import PlainWatch, SharedSenses

from mend.errors import WrongInputError
from mend.robots.arm.grasp import grasp_of
from mend.robots.arm.subsystem import ArmSubsystem
from mend.robots.catalogue import Catalogue, Part
from mend.robots.link.messages import (
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
from mend.robots.robot import Robot
from mend.sim.random_scene import random_scene
from mend.sim.workcell.colors import learn_colors
from mend.sim.workcell.options import WorkcellOptions
from mend.sim.workcell.world import WorkcellWorld
from mend.tasks.intervention import Act, Intervention
from mend.tasks.plugins import load_plugins
from mend.tasks.scene import Scene

LONGEST_S = 120.0
HAND_OVER_S = 9.0
MOST_PARTS = 6
_STACK_M = 0.12


class Bench:
    """A workcell with a robot, driven cycle by cycle."""

    def __init__(self, scene: Scene, seed: int, noise: float, light: float) -> None:
        options = WorkcellOptions(renderer="fast", camera_noise=noise, light=light, depth_noise=1.0)
        self.scene, self.seed = scene, seed
        self.world = WorkcellWorld(scene, seed, options)
        self.judge = Judge(self.world, scene)
        model = learn_colors(scene, noise)
        catalogue = Catalogue.from_scene(scene)
        self.perception = SharedSenses(self.world.body, model, catalogue)
        self.perception.plain = self._plain = PlainWatch()
        self.robot = Robot(
            "r1",
            self.world.body,
            [
                ArmSubsystem(
                    self.world.body,
                    model,
                    catalogue,
                    load_plugins("mend.behaviors"),
                    load_plugins("mend.monitors"),
                    perception=self.perception,
                )
            ],
        )
        self._trial: Trial | None = None
        self._looked: Looked | None = None
        self._executions = 0
        self.robot.attach(self._take, _ignore)

    # --- What the robot does ------------------------------------------------------------------

    def pick(
        self, trial: Trial, fault: Callable[[], None], was_done: WasDone | None = None
    ) -> None:
        """One pick and place, with `fault` at the trial's moment. Raises `NotNowError`."""
        self._trial = trial
        self.judge.forget()
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
            self.judge.note_grasp(trial.name, step)
            due = progress is not None and (step, progress.fraction) >= trial.moment
            if due and trial.fault_s is None:
                self._strike(trial, fault)
            if step < LAST_STEP - 2 and trial.fault_s is not None and self.judge.was_held:
                # Fingers that only lose touch for a moment have not lost what they hold.
                gone = self.judge.is_let_go(trial.name)
                trial.out_s = (trial.out_s or self.robot.time_s()) if gone else None
            if self.robot.time_s() > begin_s + LONGEST_S:
                break
        trial.plain_s = self._plain.alarm_s
        trial.placed = self.judge.at_place(trial.name)
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
            if self.world.head_covered:
                self.act(Act.UNCOVER)
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

    # --- Within -------------------------------------------------------------------------------

    def _take(self, body: ReportBody, time_s: float, _: object) -> None:
        """Judge an issue at once, before anything moves on."""
        trial = self._trial
        match body:
            case Looked():
                self._looked = body
            case IssueDetected() if trial is not None and body.issue != "positioning":
                why = body.detection.explanation if body.detection else ""
                true = self.judge.is_true(body.issue, trial.name)
                trial.said.append(Said(body.issue, time_s, why, true))
            case Finished() if trial is not None:
                trial.finished = True


def _ignore(_picture: object) -> None:
    """Nobody asked for pictures."""


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


def benches(seed: int, noise: float, light: float) -> Iterator[Bench]:
    """Workcells with random scenes, one after the other."""
    for number in range(seed, seed + 1_000_000):
        count = int(np.random.default_rng(number).integers(2, MOST_PARTS + 1))
        try:
            scene = random_scene(number, count, checker().check_scene).scene
        except WrongInputError:
            continue
        bench = Bench(scene, number, noise, light)
        yield bench
        bench.world.close()
