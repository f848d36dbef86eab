"""An arm that is in the head camera's picture, where hundreds of bits of it are seen."""

from collections.abc import Sequence
from typing import Any

import pytest
from agent_driver import Driver

from mend.robots.link.messages import Intervene, Look, Looked
from mend.robots.vision.level_surfaces import Surfaces
from mend.robots.vision.naming import Namer, Top
from mend.sim.workcell.adapter import WorkcellAdapter
from mend.sim.world import WorldSetup
from mend.tasks.intervention import Act, Intervention
from mend.tasks.scene import Pose, Scene, SceneObject

PARTS = {
    "tin": ((0.8, 0.1, 0.15), (0.05, 0.04, 0.06), None, Pose(x=0.56, y=-0.12)),
    "cup": ((0.1, 0.55, 0.3), (0.045, 0.055, 0.05), None, Pose(x=0.772, y=0.144)),
    "soap": ((0.15, 0.25, 0.8), (0.03, 0.07, 0.03), None, Pose(x=0.6, y=0.0, yaw=-0.3)),
    "tray": ((0.85, 0.7, 0.1), (0.11, 0.08, 0.014), (0.03, 0.025, 0.03), Pose(x=0.46, y=0.06)),
    "dice": ((0.8, 0.8, 0.85), (0.03, 0.03, 0.03), None, Pose(x=0.5, y=-0.26)),
}
SCENE = Scene(
    name="kitchen",
    objects={
        name: SceneObject(color=color, size=size, knob=knob, pose=pose)
        for name, (color, size, knob, pose) in PARTS.items()
    },
    places={},
)


def test_bits_of_an_arm_are_not_taken_apart_as_if_they_were_parts(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Each time that takes some tenths of a second, and a robot that is silent too long is lost."""
    named: list[int] = []
    name = Namer.name

    def counted(self: Namer, tops: Sequence[Top], surfaces: Surfaces, *more: Any, **named_: Any):
        named.append(len(tops))
        return name(self, tops, surfaces, *more, **named_)

    setup = WorldSetup(robots=["r1"], scene=SCENE, seed=4, speed=None)
    driver = Driver(WorkcellAdapter().create_agents(setup))
    away = Intervention(act=Act.MOVE, object="cup", to=Pose(x=0.857, y=-0.608))
    driver.send(Intervene(intervention=away, by="ann"))
    driver.run()
    monkeypatch.setattr(Namer, "name", counted)
    driver.send(Look(object="cup", expect="in_gripper", within_s=2.0))
    driver.run()
    assert driver.of(Looked)[-1].body.fulfilled is False
    assert max(named) > 50, "the arm is in the picture"
    assert sum(each > 50 for each in named) <= 3
