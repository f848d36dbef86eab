"""Sentences about numbers say what they are in, wherever in a document the number stands."""

import pytest

from mend.documents.problem import InvalidFileError
from mend.documents.strict_model import StrictModel
from mend.documents.unit import unit_at, unit_of_name
from mend.tasks.scene import Name, Place, Pose, Scene, SceneObject, Table
from mend.tasks.scene_file import check_scene_text


class Shelf(StrictModel):
    """Every way in which a number can stand in a model."""

    by_name: dict[Name, Pose]
    in_turn: list[Pose]
    table: Table | None = None
    count: int = 0


@pytest.mark.parametrize(
    ("location", "unit"),
    [
        (("by_name", "cup", "x"), "metres"),
        (("by_name", "cup", "z"), "metres"),
        (("by_name", "cup", "yaw"), "radians"),
        (("in_turn", 3, "yaw"), "radians"),
        (("table", "size", 1), "metres"),
        (("table", "size", 9), None),
        (("count",), None),
        (("by_name", "cup"), None),
        (("by_name", "[key]"), None),
        (("nothing", 1), None),
        ((), None),
    ],
)
def test_the_unit_of_a_number_is_found(location: tuple[int | str, ...], unit: str | None) -> None:
    assert unit_at(Shelf, location) == unit


def test_a_measure_beyond_its_limit_is_told_with_its_unit_and_line() -> None:
    cup = SceneObject(color=(1.0, 0.0, 0.0), size=(0.1, 0.1, 0.1), pose=Pose(x=0.5, y=0.0))
    scene = Scene(name="tea", objects={"cup": cup}, places={"tray": Place(pose=cup.pose)})
    wrong = scene.model_dump_json(indent=1).replace('"yaw": 0.0', '"yaw": 90', 1)
    with pytest.raises(InvalidFileError) as caught:
        check_scene_text(wrong)
    [problem] = caught.value.problems
    assert problem.message == (
        "'objects.cup.pose.yaw' must be less than or equal to 6.2832 (in radians), but it is 90"
    )
    assert problem.line == 1 + wrong[: wrong.index('"yaw": 90')].count("\n")


@pytest.mark.parametrize(
    ("location", "unit"),
    [
        (("person", "delay_s"), "seconds"),
        (("knob_m", 2), "metres"),
        (("speed_m_s",), "metres per second"),
        (("max_attempts",), None),
        (("s",), None),
        ((), None),
    ],
)
def test_the_end_of_a_name_tells_the_unit(
    location: tuple[int | str, ...], unit: str | None
) -> None:
    assert unit_of_name(location) == unit
