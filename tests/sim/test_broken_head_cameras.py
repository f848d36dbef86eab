"""A head camera that breaks is blamed itself, and no part is; a sound one never is."""

from collections.abc import Iterator
from dataclasses import dataclass
from types import MappingProxyType
from typing import Any

import pytest
from broken_camera import BrokenCamera
from sampled import sample

pytest.importorskip("pybullet", reason="PyBullet has wheels for Python 3.10 and 3.11 only")

from mend.robots.link.messages import (
    Finished,
    FinishedResult,
    IssueDetected,
    Look,
    Looked,
    ReportBody,
    Resume,
    Start,
    StepStarted,
)
from mend.sim.random_scene import random_scene
from mend.sim.shared_world import SharedWorld
from mend.sim.world import WorldSetup
from mend.tasks.plugins import load_plugins
from mend.tasks.scene import Place, Pose, Scene, SceneObject

pytestmark = pytest.mark.slow

SCENE = Scene(
    name="two",
    objects={
        "bar": SceneObject(
            color=(1.0, 0.35, 0.65), size=(0.112, 0.03, 0.04), pose=Pose(x=0.42, y=-0.30)
        ),
        "box": SceneObject(
            color=(0.4, 0.4, 0.4), size=(0.06, 0.03, 0.03), pose=Pose(x=0.60, y=-0.35)
        ),
    },
    places={"left": Place(pose=Pose(x=0.55, y=0.0))},
)
WORLDS = [
    ("tabletop", {}),
    ("tabletop", {"depth_noise": 1.0, "camera_noise": 3.0, "light": 1.0}),
    ("workcell", {}),
    ("workcell", {"depth_noise": 0.0}),
]
START = Start(
    execution="x bar",
    node="/0",
    behavior="pick_and_place",
    parameters={"object": "bar", "place": "left"},
)


@dataclass
class Broken:
    """A robot in a world, with a head camera that can break."""

    group: SharedWorld
    camera: BrokenCamera
    reports: list[ReportBody]

    def of(self, kind: type[Any]) -> list[Any]:
        return [each for each in self.reports if isinstance(each, kind)]

    @property
    def issues(self) -> list[str]:
        return [each.issue for each in self.of(IssueDetected)]

    def send(self, name: str, command: Any) -> None:
        self.group.agents[0].handle(name, command)
        while self.group.advance(1.0):
            pass

    def start_and_freeze_at(self, step: int) -> None:
        """Let it place the bar, with a camera that freezes in a step."""
        self.group.agents[0].handle("c", START)
        while self.group.advance(0.05):
            self.camera.frozen |= any(each.step >= step for each in self.of(StepStarted))


def broken(world: str, options: dict[str, Any]) -> Broken:
    setup = WorldSetup(robots=["r1"], scene=SCENE, seed=2, speed=None, options=options)
    group = load_plugins("mend.worlds")[world].create_agents(setup)
    body = group.world.bodies[0]
    camera = BrokenCamera(body.cameras["head"])
    cameras = MappingProxyType({**body.cameras, "head": camera})
    if world == "tabletop":
        body._cameras = cameras
    else:
        body.cameras = cameras
    made = Broken(group, camera, [])
    group.agents[0].attach(lambda said, *_: made.reports.append(said), lambda _: None)
    return made


# The one in which most is uncertain, and the one in which least is.
@pytest.fixture(
    params=sample([WORLDS[1], WORLDS[3]], WORLDS), ids=lambda param: f"{param[0]} {param[1]}"
)
def robot(request: pytest.FixtureRequest) -> Iterator[Broken]:
    made = broken(*request.param)
    yield made
    made.group.world.close()


def test_a_camera_that_freezes_while_a_part_is_carried_is_all_that_is_told(robot: Broken) -> None:
    robot.start_and_freeze_at(4)
    assert robot.issues == ["blind"]
    assert robot.of(Finished) == []
    robot.camera.frozen = False
    robot.send("go on", Resume(execution="x bar"))
    assert robot.of(Finished) == [Finished(execution="x bar", found_in_place=False)]
    assert robot.issues == ["blind"]


def test_a_camera_that_gives_its_first_picture_for_ever_is_found_out(robot: Broken) -> None:
    robot.camera.frozen = True
    robot.start_and_freeze_at(0)
    assert robot.issues == ["blind"]


@pytest.mark.parametrize("broken", [{"grey": True}, {"noise_m": 0.01}, {"noise_m": 0.1}])
def test_a_camera_without_colour_or_depth_to_tell_parts_by_accuses_none(
    robot: Broken, broken: dict[str, Any]
) -> None:
    vars(robot.camera).update(broken)
    result = FinishedResult(object="box", place="left")
    robot.send("look", Look(finished=[result]))
    assert robot.of(Looked)[-1].blind is not None
    assert robot.of(Looked)[-1].gone == []
    robot.send("c", START)
    assert robot.issues == ["blind"]
    vars(robot.camera).update(grey=False, noise_m=0.0)
    robot.send("go on", Resume(execution="x bar"))
    assert robot.issues == ["blind"]
    assert len(robot.of(Finished)) == 1


def test_a_sound_camera_is_never_blamed_however_still_the_scene_is(robot: Broken) -> None:
    for number in range(4):
        robot.send(f"look {number}", Look())
    robot.send("c", START)
    for number in range(4):
        robot.send(f"look again {number}", Look())
    assert [each.blind for each in robot.of(Looked)] == [None] * 8
    assert robot.issues == []
    assert len(robot.of(Finished)) == 1


@pytest.mark.drawn(4)
@pytest.mark.parametrize("seed", sample((395200,), range(395200, 395203)))
@pytest.mark.parametrize(
    ("world", "options"),
    [
        *WORLDS,
        ("tabletop", {"light": 0.01}),
        ("tabletop", {"camera_noise": 0.4, "light": 0.3}),
        ("tabletop", {"camera_noise": 30.0, "light": 1.0, "depth_noise": 1.0}),
        ("workcell", {"renderer": "bullet", "depth_noise": 0.0}),
        ("workcell", {"camera_noise": 30.0, "light": 1.0}),
    ],
)
def test_in_drawn_scenes_no_sound_camera_is_ever_blamed(
    world: str, options: dict[str, Any], seed: int
) -> None:
    scene = random_scene(seed).scene
    setup = WorldSetup(robots=["r1"], scene=scene, seed=seed, speed=None, options=options)
    group = load_plugins("mend.worlds")[world].create_agents(setup)
    reports: list[ReportBody] = []
    group.agents[0].attach(lambda said, *_: reports.append(said), lambda _: None)
    for number in range(4):
        group.agents[0].handle(f"look {number}", Look())
        while group.advance(1.0):
            pass
        for _ in range(5):
            group.world.advance_cycle()
    group.world.close()
    assert [each.blind for each in reports if isinstance(each, Looked)] == [None] * 4
