"""What runs may choose about a world."""

from typing import Any

import pytest
from counting_world import NoOptions
from pydantic import BaseModel

from mend.errors import WrongInputError
from mend.sim.tabletop.options import TabletopOptions
from mend.sim.workcell.options import WorkcellOptions
from mend.sim.world_options import read_options


@pytest.mark.parametrize(
    ("model", "given", "sentence"),
    [
        (
            WorkcellOptions,
            {"camera_nois": 4},
            "the world 'cell' has no option 'camera_nois'; "
            "it has 'camera_noise', 'depth_noise', 'light', 'renderer'",
        ),
        (
            WorkcellOptions,
            {"light": 2},
            "an option of the world 'cell' is wrong: "
            "'light' must be less than or equal to 1, but it is 2",
        ),
        (
            WorkcellOptions,
            {"renderer": "slow"},
            "an option of the world 'cell' is wrong: "
            "'renderer' must be 'bullet' or 'fast', but it is \"slow\"",
        ),
        (
            TabletopOptions,
            {"reach_m": "far"},
            "an option of the world 'cell' is wrong: "
            "'reach_m' must be a number (in metres), "
            'but it is "far"',
        ),
        (NoOptions, {"fog": True}, "the world 'cell' has no options, but 'fog' is given"),
    ],
)
def test_a_wrong_option_is_told_with_what_would_be_right(
    model: type[BaseModel], given: dict[str, Any], sentence: str
) -> None:
    with pytest.raises(WrongInputError) as error:
        read_options(model, "cell", given)
    assert str(error.value) == sentence


def test_whole_numbers_are_numbers_too() -> None:
    assert read_options(WorkcellOptions, "cell", {"light": 1}) == WorkcellOptions(light=1.0)
