"""The arms of a world: what each of them can do, with the scene as it is seen from its own base."""

from collections.abc import Sequence

from mend.robots.arm.body import ArmBody
from mend.robots.arm.subsystem import ArmSubsystem
from mend.robots.catalogue import Catalogue
from mend.robots.robot import Robot
from mend.robots.vision.color_model import ColorModel
from mend.sim.world import WorldSetup
from mend.tasks.frames import frames_of
from mend.tasks.plugins import load_plugins


def arm_robots(setup: WorldSetup, bodies: Sequence[ArmBody], colors: ColorModel) -> list[Robot]:
    """One robot for each body, which are in the order of the scene's `robots`.

    Raises `ValueError` for other bodies than there are robots.
    """
    frames = frames_of(setup.scene).values()
    return [
        Robot(
            name,
            body,
            [
                ArmSubsystem(
                    body,
                    colors,
                    Catalogue.from_scene(frame.scene_to_robot(setup.scene)),
                    load_plugins("mend.behaviors"),
                    load_plugins("mend.monitors"),
                    # As fast as possible, nobody watches: what no monitor needs costs time.
                    films=setup.speed is not None,
                )
            ],
        )
        for name, frame, body in zip(setup.robots, frames, bodies, strict=True)
    ]
