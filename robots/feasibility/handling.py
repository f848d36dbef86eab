"""Whether a gripper can take hold of a part at all, and carry it."""

from collections.abc import Iterator

from robots.catalogue import Part
from robots.grasp import UngraspableError, grasps_of
from robots.gripper import GripperModel
from tasks.scene import SceneObject
from tasks.scene_problem import SceneProblem


def cannot_handle(name: str, made: SceneObject, gripper: GripperModel) -> Iterator[SceneProblem]:
    """Too wide, too small, too low or too heavy."""
    try:
        grasps_of(Part(name, made.size, made.knob), gripper)
    except UngraspableError as error:
        key = "size" if made.knob is None else "knob"
        yield SceneProblem(("objects", name, key), str(error))
    if made.mass_kg > gripper.max_mass_kg:
        yield SceneProblem(
            ("objects", name, "mass_kg"),
            f"{name} weighs {made.mass_kg:.2f} kg; this gripper carries at most "
            f"{gripper.max_mass_kg:.2f} kg",
        )
