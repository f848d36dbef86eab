"""The building that a scene is set in: what its `setting` says, and where its floors are."""

import json
from itertools import pairwise

from pydantic import ValidationError

from mend.documents.problem import list_names
from mend.documents.validation import describe_mistake
from mend.errors import WrongInputError
from mend.maps.building.building import ON_FLOOR_M, Building, BuildingDocument
from mend.maps.building.building_file import check_building
from mend.tasks.scene import Scene
from mend.tasks.scene_problem import SceneProblem

_APART_M = 2 * ON_FLOOR_M
"""Floors that are nearer to each other cannot be told apart by their heights."""


def building_of(scene: Scene) -> Building:
    """The building that a scene is set in. Raises `WrongInputError` where there is none."""
    problems, building = read_setting(scene)
    if building is None:
        raise WrongInputError(problems[0].message)
    return building


def read_setting(scene: Scene) -> tuple[list[SceneProblem], Building | None]:
    """What is wrong with a scene's building, or else the building."""
    if not scene.setting:
        message = "this scene has no building as its 'setting': `mend building scene` makes one"
        return [SceneProblem(("setting",), message)], None
    try:
        document = BuildingDocument.model_validate_json(json.dumps(scene.setting))
    except ValidationError as error:
        return [
            SceneProblem(_at(*each["loc"]), describe_mistake(each, BuildingDocument))
            for each in error.errors(include_url=False)
        ], None
    mistakes = [SceneProblem(_at(*where), message) for where, message in check_building(document)]
    mistakes += _heights(document)
    return mistakes, None if mistakes else Building(document)


def _at(*where: str | int) -> tuple[str, ...]:
    return ("setting", *(str(each) for each in where))


def _heights(document: BuildingDocument) -> list[SceneProblem]:
    """Floors are told apart by their heights."""
    ordered = sorted(document.floors.items(), key=lambda each: each[1].height)
    return [
        SceneProblem(
            _at("floors", high, "height"),
            f"the floors {list_names([low, high])} are less than {_APART_M:g} m apart in "
            "height: say how high each of them is",
        )
        for (low, below), (high, above) in pairwise(ordered)
        if above.height - below.height < _APART_M
    ]
