"""Options that a world does not take refuse the run, before anything is journaled."""

from typing import Any

import pytest

from mend.errors import WrongInputError
from mend.server.sites.worlds import SimulatedWorlds
from mend.tasks.plugins import load_plugins


@pytest.mark.parametrize("world", ["tabletop", "workcell"])
@pytest.mark.parametrize(
    ("options", "sentence"),
    [
        ({"a": 1.0}, "has no option 'a'; it has "),
        ({"depth_noise": "x"}, "is wrong: 'depth_noise' must"),
        ({"light": 2.0}, "is wrong: 'light' must"),
    ],
)
def test_options_are_checked_beforehand(world: str, options: dict[str, Any], sentence: str) -> None:
    if world == "workcell":
        pytest.importorskip("pybullet")
    worlds = SimulatedWorlds(load_plugins("mend.worlds"))
    worlds.check(world, {"depth_noise": 0.5})
    with pytest.raises(WrongInputError, match=sentence):
        worlds.check(world, options)
