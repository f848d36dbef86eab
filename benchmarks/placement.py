"""How precisely and how reliably whole EKET bases are built in the workcell, with vision on.

    python benchmarks/placement.py [--quick] [--builds N] [--seed S] [--steady-light]

Every pick is located by the head camera; camera noise is on, and light and exposure vary by the
seed. Each build takes its bars and its top in an order and of a kind chosen by the seed. A build
succeeds when all five parts were placed without an issue. Placement errors (distance in the
plane between where a part is and its place) are compared with those of the head camera's picks.
"""

# ruff: noqa: T201

import argparse
import math
import time
from collections.abc import Sequence
from dataclasses import dataclass, field
from random import Random
from typing import Any

import numpy as np

from mend.robots.arm.subsystem import ArmSubsystem
from mend.robots.catalogue import Catalogue
from mend.robots.link.messages import IssueDetected, Look, Looked, ReportBody, Start
from mend.robots.robot import Robot
from mend.sim.shared_world import SharedWorld
from mend.sim.workcell.colors import learn_colors
from mend.sim.workcell.options import WorkcellOptions
from mend.sim.workcell.parts import PartPose
from mend.sim.workcell.world import WorkcellWorld
from mend.tasks.plugins import load_plugins
from mend.tasks.scene import Scene
from mend.tasks.scene_file import built_in_scene

NOISY = {"camera_noise": 3.0, "light": 1.0}
GOAL_P95_MM = 1.5
GOAL_MAX_MM = 3.0
GOAL_SUCCESS = 0.99


@dataclass(slots=True)
class Tally:
    """What all builds came to: millimetres per part name, and what went wrong."""

    picked_mm: dict[str, list[float]] = field(default_factory=dict)
    placed_mm: dict[str, list[float]] = field(default_factory=dict)
    yaw_deg: list[float] = field(default_factory=list)
    failures: list[str] = field(default_factory=list)
    simulated_s: float = 0.0
    cpu_s: float = 0.0


def scene_without_help() -> Scene:
    """The EKET base with no part that a person has to help with."""
    scene = built_in_scene("eket")
    objects = {
        name: each.model_copy(update={"needs_help": False}) for name, each in scene.objects.items()
    }
    return scene.model_copy(update={"objects": objects})


def order_of(random: Random) -> list[str]:
    """An order that the task tree allows."""
    bars = ["pink_bar", "yellow_bar"]
    random.shuffle(bars)
    return ["green_leg", *bars, "blue_leg", random.choice(["purple_top", "orange_top"])]


def build(scene: Scene, seed: int, options: dict[str, Any], tally: Tally) -> None:
    """One whole base; ends at the first issue."""
    chosen = WorkcellOptions.model_validate(options)
    world = WorkcellWorld(scene, seed, chosen)
    model = learn_colors(scene, chosen.camera_noise)
    catalogue = Catalogue.from_scene(scene)
    behaviors, monitors = load_plugins("mend.behaviors"), load_plugins("mend.monitors")
    arm = ArmSubsystem(world.body, model, catalogue, behaviors, monitors)
    robot = Robot("r1", world.body, [arm])
    group = SharedWorld(world, [robot], speed=None)
    reports: list[ReportBody] = []
    group.agents[0].attach(lambda body, _time, _world: reports.append(body), lambda _picture: None)
    for name in order_of(Random(seed)):
        group.agents[0].handle(f"look for {name}", Look())
        while group.advance(1.0):
            pass
        looked = reports[-1]
        if isinstance(looked, Looked) and name in looked.objects:
            seen, (x, y, _) = looked.objects[name], world.parts[name].pose().position
            error = math.hypot(seen.x - x, seen.y - y) * 1e3
            tally.picked_mm.setdefault(name, []).append(error)
        parameters = {"object": name, "place": name}
        start = Start(execution=name, node="/", behavior="pick_and_place", parameters=parameters)
        group.agents[0].handle(name, start)
        while group.advance(1.0):
            pass
        issues = [each for each in reports if isinstance(each, IssueDetected)]
        if issues:
            explanation = issues[0].detection.explanation if issues[0].detection else ""
            tally.failures.append(f"seed {seed}, {name}: {issues[0].issue} ({explanation})")
            break
    else:
        judge(scene, seed, world, tally)
    tally.simulated_s += group.time_s()
    world.close()


def judge(scene: Scene, seed: int, world: WorkcellWorld, tally: Tally) -> None:
    """Measure every part that was placed, once everything is."""
    for name in order_of(Random(seed)):
        place = PartPose.at(scene.places[name].pose, scene.table.height)
        part = world.parts[name].pose()
        (x, y, z), (place_x, place_y, place_z) = part.position, place.position
        error = math.hypot(x - place_x, y - place_y) * 1e3
        tally.placed_mm.setdefault(name, []).append(error)
        tally.yaw_deg.append(abs(math.degrees(math.remainder(part.yaw - place.yaw, math.pi))))
        if abs(z - place_z) > GOAL_MAX_MM / 1e3 or error > GOAL_MAX_MM:
            tally.failures.append(f"seed {seed}, {name}: {error:.1f} mm from its place")


def line(label: str, errors: Sequence[float]) -> str:
    p50, p95, p99, most = np.percentile(errors, [50, 95, 99, 100])
    return f"{label:24} {len(errors):6} {p50:7.2f} {p95:7.2f} {p99:7.2f} {most:7.2f}"


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--quick", action="store_true", help="two builds")
    parser.add_argument("--builds", type=int, default=200)
    parser.add_argument("--seed", type=int, default=0, help="of the first build")
    parser.add_argument("--steady-light", action="store_true", help="no noise, no change of light")
    arguments = parser.parse_args()
    builds = 2 if arguments.quick else arguments.builds
    options = {} if arguments.steady_light else NOISY
    scene, tally = scene_without_help(), Tally()
    begin = time.process_time()
    for seed in range(arguments.seed, arguments.seed + builds):
        build(scene, seed, options, tally)
    tally.cpu_s = time.process_time() - begin
    report(builds, options, tally)


def report(builds: int, options: dict[str, Any], tally: Tally) -> None:
    print(f"{builds} builds, options {options}, {tally.simulated_s / tally.cpu_s:.1f} x real time")
    print(f"{'mm in the plane':24} {'parts':>6} {'p50':>7} {'p95':>7} {'p99':>7} {'max':>7}")
    for name, errors in sorted(tally.placed_mm.items()):
        print(line(f"placed {name}", errors))
    placed = [error for errors in tally.placed_mm.values() for error in errors]
    picked = [error for errors in tally.picked_mm.values() for error in errors]
    if placed:
        print(line("placed, all", placed))
        print(line("located for picking", picked))
        print(f"yaw: at most {max(tally.yaw_deg):.2f} degrees off")
        p95, most = np.percentile(placed, [95, 100])
        print(f"p95 / goal {p95 / GOAL_P95_MM:.2f}, max / goal {most / GOAL_MAX_MM:.2f}")
    whole = builds - len({failure.split(",")[0] for failure in tally.failures})
    print(f"whole builds: {whole} of {builds} ({whole / builds:.1%}; goal {GOAL_SUCCESS:.0%})")
    for failure in tally.failures:
        print(f"  {failure}")


if __name__ == "__main__":
    main()
