"""How many simulated seconds pass per second of CPU while the EKET base is built with vision on.

    python benchmarks/simulation_speed.py [--quick]

One robot picks and places five parts; forearm pictures are taken and watched throughout. The
slowest line, the physics engine with its own renderer, is what the ratios compare with.
"""

# ruff: noqa: T201

import argparse
import json
import time
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import yaml

import mend.tasks
from mend.robots.agent import AgentGroup
from mend.robots.link.messages import Finished, IssueDetected, ReportBody, Start
from mend.sim.world import WorldAdapter, WorldSetup
from mend.tasks.plugins import load_plugins
from mend.tasks.scene import Scene

BUILD = (
    ("green_leg", "green_leg"),
    ("pink_bar", "pink_bar"),
    ("yellow_bar", "yellow_bar"),
    ("blue_leg", "blue_leg"),
    ("purple_top", "purple_top"),
)

CASES: tuple[tuple[str, str, dict[str, Any]], ...] = (
    ("workcell, PyBullet's renderer, 10 Hz", "workcell", {"renderer": "bullet"}),
    ("workcell, fast camera, 30 Hz", "workcell", {"renderer": "fast"}),
    ("tabletop, 10 Hz", "tabletop", {}),
)


@dataclass(frozen=True, slots=True)
class Timing:
    """One build: simulated and CPU seconds, parts placed, issues raised."""

    simulated_s: float
    cpu_s: float
    placed: int
    issues: int


def load_scene() -> Scene:
    """The scene of the EKET base."""
    text = (Path(next(iter(mend.tasks.__path__))) / "scenes" / "eket.yaml").read_text(
        encoding="utf-8"
    )
    return Scene.model_validate_json(json.dumps(yaml.safe_load(text)))


def build(group: AgentGroup) -> Timing:
    """Let the robot place all parts, one after the other."""
    reports: list[ReportBody] = []
    group.agents[0].attach(lambda body, _time, _world: reports.append(body), lambda _picture: None)
    begin_s, begin_cpu_s = group.time_s(), time.process_time()
    for name, place in BUILD:
        start = Start(
            execution=name,
            node="/0",
            behavior="pick_and_place",
            parameters={"object": name, "place": place},
        )
        group.agents[0].handle(name, start)
        while group.advance(1.0):
            pass
    return Timing(
        group.time_s() - begin_s,
        time.process_time() - begin_cpu_s,
        sum(isinstance(each, Finished) for each in reports),
        sum(isinstance(each, IssueDetected) for each in reports),
    )


def measure(adapter: WorldAdapter, options: dict[str, Any], builds: int) -> list[Timing]:
    """Several builds with seeds of their own; one before them warms up compilers and caches."""
    timings = []
    for seed in range(builds + 1):
        setup = WorldSetup(
            robots=["r1"], scene=load_scene(), seed=seed, speed=None, options=options
        )
        timings.append(build(adapter.create_agents(setup)))
    return timings[1:]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--quick", action="store_true", help="one build each")
    builds = 1 if parser.parse_args().quick else 5
    slowest: float | None = None
    print(f"{'world':40} {'builds':>6} {'placed':>7} {'sim s':>7} {'CPU s':>7} {'x real':>7} ratio")
    for label, world, options in CASES:
        timings = measure(load_plugins("mend.worlds")[world], options, builds)
        simulated_s = sum(each.simulated_s for each in timings)
        cpu_s = sum(each.cpu_s for each in timings)
        placed = f"{sum(each.placed for each in timings)}/{builds * len(BUILD)}"
        speed = simulated_s / cpu_s
        slowest = slowest or speed
        print(
            f"{label:40} {builds:6} {placed:>7} {simulated_s:7.1f} {cpu_s:7.2f} {speed:7.1f}"
            f" {speed / slowest:5.1f}"
        )


if __name__ == "__main__":
    main()
