"""Room for the fingers: what leaves them none is in the way, and another grasp is tried first."""

import pytest
from agent_driver import Driver

from mend.robots.link.messages import Finished, Intervene, Look, Looked, Resume, Resumed
from mend.sim.tabletop.adapter import TabletopAdapter
from mend.sim.world import WorldSetup
from mend.tasks.intervention import Act, Intervention
from mend.tasks.scene import Place, Pose, Scene, SceneObject

AT = Pose(x=0.5, y=0.0)
BESIDE = {"west": Pose(x=0.459, y=0.0), "north": Pose(x=0.5, y=0.046)}
"""Six millimetres from either side of the brick at `AT`: too near for a finger."""


def post(x: float, color: tuple[float, float, float]) -> SceneObject:
    return SceneObject(color=color, size=(0.03, 0.03, 0.06), pose=Pose(x=x, y=-0.2))


SCENE = Scene(
    name="room",
    objects={
        "brick": SceneObject(
            color=(0.9, 0.1, 0.1), size=(0.04, 0.05, 0.05), pose=Pose(x=0.5, y=-0.45)
        ),
        "west": post(0.45, (0.1, 0.8, 0.1)),
        "north": post(0.65, (0.1, 0.2, 0.9)),
    },
    places={"spot": Place(pose=AT)},
)


def driver_with(*beside: str) -> Driver:
    """Some posts stand close to the spot."""
    setup = WorldSetup(robots=["r1"], scene=SCENE, seed=3, speed=None, interventions=[], options={})
    driver = Driver(TabletopAdapter().create_agents(setup))
    for name in beside:
        person(driver, Act.MOVE, object=name, to=BESIDE[name])
    return driver


def person(driver: Driver, act: Act, **more: object) -> None:
    deed = Intervention(act=act, **more)  # type: ignore[arg-type]
    driver.send(Intervene(intervention=deed, by="ann"))


def look(driver: Driver, **what: object) -> Looked:
    driver.send(Look(object="brick", **what))  # type: ignore[arg-type]
    driver.run()
    looked: Looked = driver.of(Looked)[-1].body
    return looked


@pytest.mark.parametrize("beside", ["west", "north"])
def test_what_leaves_room_for_another_grasp_is_in_nobodys_way(beside: str) -> None:
    driver = driver_with(beside)
    driver.start("brick", "spot")
    driver.run()
    assert driver.issues == []
    assert len(driver.of(Finished)) == 1


def test_what_leaves_no_room_at_the_place_is_in_the_way_until_it_is_gone() -> None:
    driver = driver_with("west", "north")
    driver.start("brick", "spot")
    raised = driver.run_until_issue()
    assert (raised.issue, raised.step) == ("blocked", 0)
    said = f"{raised.detection.part} leaves no room for the fingers at its place"
    assert raised.detection.explanation == said
    driver.run()
    assert look(driver, expect="way_clear", within_s=1.0).fulfilled is False
    person(driver, Act.RELEASE, object=raised.detection.part)
    assert look(driver, expect="way_clear", within_s=1.0).fulfilled is True
    driver.send(Resume(execution="e1"))
    driver.run()
    assert len(driver.of(Finished)) == 1


def test_what_is_held_so_that_it_does_not_fit_is_put_down_and_held_otherwise() -> None:
    driver = driver_with("west")
    person(driver, Act.STEAL, object="brick")
    driver.start("brick", "spot")
    assert driver.run_until_issue().issue == "missing"
    driver.run()
    assert look(driver).held is None
    person(driver, Act.HAND_OVER, object="brick")
    taken = look(driver, expect="in_gripper", within_s=10.0)
    assert (taken.fulfilled, taken.held) == (True, "brick")
    driver.send(Resume(execution="e1"))
    driver.run()
    assert [each.issue for each in driver.issues] == ["missing"]
    assert [each.body.step for each in driver.of(Resumed)] == [1]
    assert len(driver.of(Finished)) == 1
    assert look(driver, place="spot", expect="at_place").fulfilled is True


def test_what_the_fingers_have_no_room_beside_is_not_in_reach() -> None:
    driver = driver_with("west", "north")
    person(driver, Act.MOVE, object="brick", to=AT)
    assert look(driver, expect="in_reach", within_s=1.5).fulfilled is False
    person(driver, Act.MOVE, object="brick", to=Pose(x=0.5, y=-0.45))
    assert look(driver, expect="in_reach", within_s=1.5).fulfilled is True
