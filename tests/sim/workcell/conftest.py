"""A small scene, its world and a robot's hands in it."""

from collections.abc import Iterator

import pytest

pytest.importorskip("pybullet", reason="PyBullet has wheels for Python 3.10 and 3.11 only")

from workcell_hands import Hands

from mend.sim.workcell.world import WorkcellWorld
from mend.tasks.scene import Place, Pose, Scatter, Scene, SceneObject


@pytest.fixture(scope="session")
def scene() -> Scene:
    """A leg, a bar and a plate with a knob; two places."""
    return Scene(
        name="small",
        scatter=Scatter(xy=0.01, yaw=0.2),
        objects={
            "leg": SceneObject(
                color=(0.08, 0.55, 0.12), size=(0.03, 0.20, 0.08), pose=Pose(x=0.45, y=-0.55)
            ),
            "bar": SceneObject(
                color=(1.0, 0.35, 0.65), size=(0.112, 0.03, 0.04), pose=Pose(x=0.42, y=-0.30)
            ),
            "plate": SceneObject(
                color=(0.42, 0.08, 0.6),
                size=(0.18, 0.22, 0.016),
                knob=(0.028, 0.04, 0.036),
                pose=Pose(x=0.60, y=-0.30),
                mass_kg=0.15,
            ),
        },
        places={
            "left": Place(pose=Pose(x=0.55, y=0.0)),
            "right": Place(pose=Pose(x=0.40, y=0.05, yaw=0.4)),
        },
    )


@pytest.fixture
def world(scene: Scene) -> Iterator[WorkcellWorld]:
    world = WorkcellWorld(scene, seed=7)
    yield world
    world.close()


@pytest.fixture
def hands(world: WorkcellWorld) -> Hands:
    return Hands(world)
