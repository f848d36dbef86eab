"""Heights at which a scenario has parts stand, and at which nothing could hold them."""

from collections.abc import Iterator

from mend.tasks.part_boxes import height_of
from mend.tasks.scenario import Scenario
from mend.tasks.scene import RESTS_M, Pose, Scene

Where = tuple[int | str, ...]


def heights_out_of_place(scenario: Scenario, scene: Scene) -> Iterator[tuple[Where, str]]:
    """The poses that are inside the table or above all that parts could stand on, and why.

    A part stands at most on all the others of its scene, one on the other.
    """
    if scene.setting:
        return
    for where, name, pose in _poses(scenario):
        if name in scene.objects and pose.z is not None:
            why = _why_not(pose.z, pose, name, scene)
            if why:
                yield (*where, "z"), why


def _poses(scenario: Scenario) -> Iterator[tuple[Where, str, Pose]]:
    for name, pose in scenario.scene.items():
        yield ("scene", name), name, pose
    for index, each in enumerate(scenario.interventions):
        if each.do.to is not None and each.do.object is not None:
            yield ("interventions", index, "do", "to"), each.do.object, each.do.to


def _why_not(z: float, pose: Pose, name: str, scene: Scene) -> str:
    table_z = scene.table.height
    others = [part for other, part in scene.objects.items() if other != name]
    highest_z = table_z + sum(max(*each.size, height_of(each.size, each.knob)) for each in others)
    if z > highest_z + RESTS_M:
        return (
            f"puts '{name}' at a height of {z:g} m, where nothing could hold it: the table is "
            f"{table_z:g} m high, and all other parts on one another reach {highest_z:.2f} m"
        )
    if z < table_z - RESTS_M and scene.table.is_under(pose.x, pose.y):
        return (
            f"puts '{name}' at a height of {z:g} m, inside the table, which is {table_z:g} m high"
        )
    return ""
