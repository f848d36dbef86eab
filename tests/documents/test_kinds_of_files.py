"""A file of another kind is told as that, and not by all the keys that it lacks."""

from collections.abc import Callable

import pytest

from mend.documents.problem import InvalidFileError
from mend.fleet.request_file import read_request_text
from mend.maps.building.building_file import read_building_text
from mend.tasks.scene_file import check_scene_text

BUILDING = "building: office\nfloors: {}\n"
SCENE = "name: tea\nobjects: {}\nplaces: {}\n"
REQUESTS = "requests: []\n"


@pytest.mark.parametrize(
    ("read", "text", "told"),
    [
        (check_scene_text, BUILDING, "this is a building, and not a scene: `mend building scene`"),
        (read_request_text, BUILDING, "this is a building, and not a request file"),
        (read_request_text, SCENE, "this is a scene, and not a request file"),
        (read_building_text, REQUESTS, "this is a request file, and not a building"),
        (read_building_text, "tree: {}\n", "this is a task tree, and not a building"),
    ],
)
def test_a_file_of_another_kind_is_told_as_one(
    read: Callable[[str], object], text: str, told: str
) -> None:
    with pytest.raises(InvalidFileError) as caught:
        read(text)
    [problem] = caught.value.problems
    assert problem.message.startswith(told)


def test_what_has_something_of_its_own_kind_is_told_what_it_lacks() -> None:
    with pytest.raises(InvalidFileError) as caught:
        check_scene_text("objects: {}\nrequests: []\n")
    assert not any("this is" in each.message for each in caught.value.problems)
