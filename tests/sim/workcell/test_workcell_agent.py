"""The robot works in a workcell with its own eyes."""

import math
from collections.abc import Sequence

import numpy as np
import pytest
from sampled import sample
from workcell_hands import TABLE_M, distance_m

from mend.errors import WrongInputError
from mend.robots.link.messages import (
    Finished,
    Intervene,
    IssueDetected,
    Location,
    Look,
    Looked,
    ReportBody,
    Resume,
    Start,
)
from mend.sim.shared_world import SharedWorld
from mend.sim.workcell.adapter import adapter
from mend.sim.workcell.clock import PERIOD_S
from mend.sim.workcell.parts import PartPose
from mend.sim.workcell.world import WorkcellWorld
from mend.sim.world import SceneChecker, WorldSetup
from mend.tasks.intervention import Act, Intervention
from mend.tasks.plugins import load_plugins
from mend.tasks.scenario import ScriptedIntervention, Trigger
from mend.tasks.scene import Place, Pose, Scene, SceneObject

pytestmark = pytest.mark.slow

PLACE = PartPose.upright(0.55, 0.0, TABLE_M, 0.0)


def place_bar(
    scene: Scene,
    options: dict[str, object],
    interventions: Sequence[ScriptedIntervention] = (),
    beforehand: Sequence[Intervention] = (),
) -> tuple[SharedWorld, list[ReportBody]]:
    """Let a robot place the bar, after what people did `beforehand`; what it reported."""
    setup = WorldSetup(
        robots=["r1"],
        scene=scene,
        seed=2,
        speed=None,
        options=options,
        interventions=list(interventions),
    )
    group = adapter.create_agents(setup)
    return group, do(group, "bar", beforehand)


def do(group: SharedWorld, name: str, beforehand: Sequence[Intervention] = ()) -> list[ReportBody]:
    """Let a robot place a part; what it reports, then and later."""
    reports: list[ReportBody] = []
    group.agents[0].attach(lambda body, _time, _world: reports.append(body), lambda _picture: None)
    for number, each in enumerate(beforehand):
        group.agents[0].handle(f"before {number}", Intervene(intervention=each, by="ann"))
    start(group, name, Location(x=0.55, y=0.0))
    while group.advance(1.0):
        pass
    return reports


def start(group: SharedWorld, name: str, target: Location) -> None:
    """Have a robot bring a part to where `left` is, or somewhere else."""
    group.agents[0].handle(
        "1",
        Start(
            execution="e",
            node="/",
            behavior="pick_and_place",
            parameters={"object": name, "place": "left"},
            target=target,
        ),
    )


def test_a_heavy_part_does_not_swing_between_the_fingers() -> None:
    part = SceneObject(
        color=(0.8, 0.2, 0.1),
        size=(0.072, 0.030, 0.122),
        mass_kg=0.493,
        pose=Pose(x=0.6441, y=-0.3548),
    )
    target = Location(x=0.492, y=-0.1365, yaw=-2.05)
    scene = Scene(name="one", objects={"part": part}, places={"left": Place(pose=Pose(x=0, y=0))})
    group = adapter.create_agents(WorldSetup(robots=["r1"], scene=scene, seed=1, speed=None))
    group.agents[0].attach(lambda _body, _time, _world: None, lambda _picture: None)
    start(group, "part", target)
    world, positions_m = world_of(group), []
    while group.advance(PERIOD_S):
        positions_m.append(world.parts["part"].pose().position)
    carried = np.array([each for each in positions_m if each[2] > TABLE_M + 0.03])
    jerks_m = np.diff(carried[:, :2], 2, axis=0)
    world.close()
    assert len(carried) > 500
    assert math.sqrt((jerks_m**2).mean()) < 3e-5


def world_of(group: SharedWorld) -> WorkcellWorld:
    world = group.world
    assert isinstance(world, WorkcellWorld)
    return world


@pytest.mark.parametrize(
    "options",
    [
        {"renderer": "bullet"},
        *sample([], [{"renderer": "fast"}]),
        {"renderer": "fast", "camera_noise": 3.0, "light": 1.0},
    ],
)
def test_a_part_found_by_camera_is_placed_within_3_mm(
    scene: Scene, options: dict[str, object]
) -> None:
    group, reports = place_bar(scene, options)
    assert not [each for each in reports if isinstance(each, IssueDetected)]
    assert isinstance(reports[-1], Finished)
    assert distance_m(world_of(group).parts["bar"].pose(), PLACE) < 0.003


@pytest.mark.parametrize(
    ("step", "fraction", "manner", "issue"),
    [
        (2, 0.9, "vanish", "missed"),
        (4, 0.8, "vanish", "dropped"),
        (5, 0.3, "pull", "dropped"),
    ],
)
def test_a_stolen_part_is_noticed(
    scene: Scene, step: int, fraction: float, manner: str, issue: str
) -> None:
    stolen = ScriptedIntervention(
        when=Trigger(object="bar", step=step, fraction=fraction),
        do=Intervention.model_validate({"act": Act.STEAL, "object": "bar", "manner": manner}),
    )
    _, reports = place_bar(scene, {}, [stolen])
    assert [each.issue for each in reports if isinstance(each, IssueDetected)] == [issue]


@pytest.mark.parametrize(
    "options", [*sample([], [{}]), {"renderer": "fast", "camera_noise": 3.0, "light": 1.0}]
)
def test_a_place_that_is_taken_is_seen_cleared_and_then_filled(
    scene: Scene, options: dict[str, object]
) -> None:
    taken = Intervention(act=Act.PLACE, object="leg", place="left")
    group, reports = place_bar(scene, options, beforehand=[taken])
    issues = [each for each in reports if isinstance(each, IssueDetected)]
    assert [each.issue for each in issues] == ["blocked"]
    assert "leg is where bar belongs" in issues[0].detection.explanation
    freed = Intervention(act=Act.RELEASE, object="bar", place="left")
    look = Look(object="bar", place="left", expect="way_clear", within_s=1.0)
    for command in (look, Intervene(intervention=freed, by="ann"), look, Resume(execution="e")):
        group.agents[0].handle("next", command)
        while group.advance(1.0):
            pass
    assert [each.fulfilled for each in reports if isinstance(each, Looked)] == [False, True]
    assert isinstance(reports[-1], Finished)
    assert distance_m(world_of(group).parts["bar"].pose(), PLACE) < 0.003


@pytest.mark.parametrize("fraction", sample([0.9], [0.2, 0.7, 0.9]))
def test_somebody_in_the_way_is_met_however_late_they_come(scene: Scene, fraction: float) -> None:
    blocked = ScriptedIntervention(
        when=Trigger(object="bar", step=5, fraction=fraction), do=Intervention(act=Act.BLOCK)
    )
    group, reports = place_bar(scene, {}, [blocked])
    assert [each.issue for each in reports if isinstance(each, IssueDetected)] == ["blocked"]
    assert world_of(group).held == "bar"


def test_the_robot_declares_the_range_that_it_grasps_in(scene: Scene) -> None:
    group = adapter.create_agents(WorldSetup(robots=["r1"], scene=scene, seed=0, speed=None))
    reach = group.agents[0].hello("boot").reach
    assert math.dist((reach.x, reach.y), (-0.05, -0.188)) < 1e-6
    assert (reach.min_m, reach.max_m) == (0.30, 0.81)


def test_a_wrong_option_stops_the_robot_from_being_made(scene: Scene) -> None:
    setup = WorldSetup(
        robots=["r1"], scene=scene, seed=0, speed=None, options={"renderer": "laser"}
    )
    with pytest.raises(
        WrongInputError, match="an option of the world 'workcell' is wrong: 'renderer' must"
    ):
        adapter.create_agents(setup)


def test_the_workcell_is_offered_to_runs() -> None:
    found = load_plugins("mend.worlds")["workcell"]
    assert found.own_process
    assert not found.lays_out_anything
    found.check_available()


def test_fingers_that_close_beside_a_part_leave_it_where_it_is() -> None:
    """They pass over the plate when they are open, and come down as they close."""
    base, top, peg = (0.141, 0.067, 0.036), (0.017, 0.084, 0.031), (0.021, 0.029, 0.049)
    made = Scene(
        name="beside",
        objects={
            "base": SceneObject(
                color=(0.79, 0.69, 0.91), size=base, mass_kg=0.162, pose=Pose(x=0.6507, y=-0.3)
            ),
            "top": SceneObject(
                color=(0.1, 0.6, 0.1),
                size=top,
                mass_kg=0.034,
                pose=Pose(x=0.6836, y=-0.3, z=TABLE_M + base[2]),
            ),
            "peg": SceneObject(
                color=(0.9, 0.1, 0.1), size=peg, mass_kg=0.015, pose=Pose(x=0.5552, y=-0.266)
            ),
        },
        places={"left": Place(pose=Pose(x=0.55, y=0.0))},
    )
    setup = WorldSetup(robots=["r1"], scene=made, seed=2, speed=None)
    assert isinstance(adapter, SceneChecker)
    assert adapter.check_scene(made, []) == []
    group = adapter.create_agents(setup)
    parts = world_of(group).parts
    before = {name: parts[name].pose() for name in ("base", "top")}
    reports = do(group, "peg")
    assert isinstance(reports[-1], Finished)
    for name, pose in before.items():
        assert distance_m(parts[name].pose(), pose) < 0.0005
        assert parts[name].pose().tilt_rad < 0.01
