"""Whether a gripper can take hold of a part at all, and carry it."""

from collections.abc import Iterator

from mend.robots.arm.grasp import UngraspableError, grasps_of
from mend.robots.arm.gripper import GripperModel
from mend.robots.catalogue import Part
from mend.tasks.part_boxes import height_of
from mend.tasks.scene import SceneObject
from mend.tasks.scene_problem import SceneProblem


def cannot_handle(name: str, made: SceneObject, gripper: GripperModel) -> Iterator[SceneProblem]:
    """Too wide, too small, too low, too long, too high or too heavy."""
    try:
        grasps_of(Part(name, made.size, made.knob), gripper)
    except UngraspableError as error:
        key = "size" if made.knob is None else "knob"
        yield SceneProblem(("objects", name, key), str(error))
    where, high_m = ("objects", name, "size"), height_of(made.size, made.knob)
    if (long_m := max(made.size[:2])) > gripper.max_length_m:
        yield SceneProblem(
            where,
            f"{name} is {1e3 * long_m:.0f} mm long; this gripper carries parts of at most "
            f"{1e3 * gripper.max_length_m:.0f} mm",
        )
    if high_m > gripper.max_height_m:
        yield SceneProblem(
            where,
            f"{name} is {1e3 * high_m:.0f} mm high; this gripper carries parts of at most "
            f"{1e3 * gripper.max_height_m:.0f} mm",
        )
    if made.mass_kg > gripper.max_mass_kg:
        yield SceneProblem(
            ("objects", name, "mass_kg"),
            f"{name} weighs {made.mass_kg:.2f} kg; this gripper carries at most "
            f"{gripper.max_mass_kg:.2f} kg",
        )
