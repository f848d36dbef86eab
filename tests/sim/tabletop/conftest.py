"""A small scene, its world and a robot's hands in it."""

import pytest
from tabletop_hands import Hands

from mend.sim.tabletop.world import TabletopWorld
from mend.tasks.scene import Place, Pose, Scene, SceneObject


@pytest.fixture
def scene() -> Scene:
    """Three parts in reach, one out of reach, two places."""
    return Scene(
        name="small",
        objects={
            "red": SceneObject(
                color=(0.9, 0.1, 0.1), size=(0.06, 0.03, 0.05), pose=Pose(x=0.5, y=-0.3)
            ),
            "green": SceneObject(
                color=(0.1, 0.8, 0.1), size=(0.04, 0.04, 0.08), pose=Pose(x=0.6, y=-0.1, yaw=0.3)
            ),
            "plate": SceneObject(
                color=(0.1, 0.2, 0.9),
                size=(0.16, 0.12, 0.02),
                knob=(0.05, 0.03, 0.03),
                pose=Pose(x=0.45, y=-0.55),
            ),
            "far": SceneObject(
                color=(0.9, 0.8, 0.1), size=(0.06, 0.03, 0.05), pose=Pose(x=0.98, y=0.3)
            ),
        },
        places={
            "left": Place(pose=Pose(x=0.5, y=0.1)),
            "middle": Place(pose=Pose(x=0.65, y=-0.3, yaw=0.5)),
        },
    )


@pytest.fixture
def world(scene: Scene) -> TabletopWorld:
    return TabletopWorld(scene, seed=7)


@pytest.fixture
def hands(world: TabletopWorld) -> Hands:
    return Hands(world)
