"""Robots in a made-up building, with what they report kept for a test."""

from collections.abc import Sequence
from typing import Any, TypeVar

from mend.maps.building.building import Building
from mend.maps.building.random_building import random_building
from mend.robots.link.messages import CommandBody, Location, ReportBody, Start
from mend.sim.building.buildings import BUILDINGS
from mend.sim.building.scene import scene_of
from mend.sim.building.world import BuildingWorld
from mend.sim.shared_world import SharedWorld
from mend.sim.world import WorldSetup
from mend.tasks.frames import frames_of
from mend.tasks.scenario import ScriptedIntervention
from mend.tasks.scene import Scene

LONGEST_S = 300.0

R = TypeVar("R")


def made_up(floors: int = 1, rooms: int = 4, seed: int = 3) -> Building:
    return Building(random_building(seed, floors, rooms))


class BuildingBench:
    """Commands in, reports out; rooms are called as scenes call them."""

    def __init__(
        self,
        scene: Scene | None = None,
        *,
        robots: int = 1,
        shut_doors: float = 0.0,
        wrong_floors: float = 0.0,
        seed: int = 1,
        localizer: str = "exact",
        unmapped: float = 0.0,
        carried_every_s: float = 0.0,
        forgetful: float = 0.0,
        battery_wh: float = 0.0,
        people: int = 0,
        blocked_hallways: float = 0.0,
        no_shows: float = 0.0,
        dawdling: float = 0.0,
        interventions: Sequence[ScriptedIntervention] = (),
        snapshot: dict[str, Any] | None = None,
    ) -> None:
        self.scene = scene or scene_of(made_up(), "office", robots)
        setup = WorldSetup(
            robots=list(self.scene.robots),
            scene=self.scene,
            seed=seed,
            speed=None,
            interventions=list(interventions),
            snapshot=snapshot,
            options={
                "shut_doors": shut_doors,
                "wrong_floors": wrong_floors,
                "localizer": localizer,
                "unmapped": unmapped,
                "carried_every_s": carried_every_s,
                "forgetful": forgetful,
                "battery_wh": battery_wh,
                "people": people,
                "blocked_hallways": blocked_hallways,
                "no_shows": no_shows,
                "dawdling": dawdling,
            },
        )
        self.group: SharedWorld = BUILDINGS.create_agents(setup)
        self.world: BuildingWorld = self.group.world  # type: ignore[assignment]
        self.reports: list[tuple[str, ReportBody]] = []
        for agent in self.group.agents:
            agent.attach(
                lambda body, _time, _world, name=agent.name: self.reports.append((name, body)),
                lambda _: None,
            )
        self._sent = 0

    def send(self, robot: str, body: CommandBody) -> None:
        self._sent += 1
        agent = next(each for each in self.group.agents if each.name == robot)
        agent.handle(f"c{self._sent}", body)

    def go(self, robot: str, place: str, behavior: str = "go_to", **more: str | float) -> None:
        """Start a behavior at a place; `more` are its other parameters."""
        pose = self.scene.places[place].pose
        x, y = frames_of(self.scene)[robot].to_robot(pose.x, pose.y)
        self.send(
            robot,
            Start(
                execution=f"e{self._sent + 1}",
                node="/0",
                behavior=behavior,
                parameters={"place": place, **more},
                target=Location(x=x, y=y, z=pose.z, yaw=pose.yaw),
            ),
        )

    def run(self) -> None:
        """Until nothing is under way any more."""
        while self.group.advance(1.0):
            assert self.group.time_s() < LONGEST_S, "it never ends"

    def run_until(self, kind: type[R]) -> R:
        """Until a report of this kind comes."""
        before = len(self.of(kind))
        while len(self.of(kind)) == before:
            going_on = self.group.advance(0.05)
            assert going_on or len(self.of(kind)) > before, f"no {kind.__name__} came"
            assert self.group.time_s() < LONGEST_S, f"no {kind.__name__} came"
        return self.of(kind)[-1]

    def of(self, kind: type[R]) -> list[R]:
        return [body for _, body in self.reports if isinstance(body, kind)]
