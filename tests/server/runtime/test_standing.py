"""Which live robot stands where in a scene."""

import asyncio
import json
from collections.abc import Mapping, Sequence

import pytest
from pretend_robots import PretendRobot
from pretend_service import pretend_service
from pydantic import ValidationError
from task_documents import definition_of

from mend.errors import WrongInputError
from mend.server.errors import NotConnectedError
from mend.server.journal import events as ev
from mend.server.runtime.requests import RunRequest
from mend.server.runtime.standing import stand
from mend.tasks.frames import Frame
from mend.tasks.scene import Base, Scene

HERE, ACROSS = Base(x=0.0, y=0.0), Base(x=1.0, y=0.0, yaw=3.1416)
OPEN = Scene(name="open", objects={}, places={})
PAIR = OPEN.model_copy(update={"name": "pair", "robots": {"left": HERE, "right": ACROSS}})
ONE_PART = definition_of({"behavior": "pick_and_place", "object": "part_1", "place": "spot_1"})


@pytest.mark.parametrize(
    ("robots", "by_place"),
    [
        ({"right": "b", "left": "a"}, {"left": "a", "right": "b"}),
        (["a", "b"], {"left": "a", "right": "b"}),
        (["right", "left"], {"left": "left", "right": "right"}),
        (["right", "a"], {"left": "a", "right": "right"}),
        ({"left": "right", "right": "left"}, {"left": "right", "right": "left"}),
        ({"right": "b"}, {"right": "b"}),
        ([], {"left": "", "right": ""}),
    ],
)
def test_robots_stand_where_the_scene_says(
    robots: Sequence[str] | Mapping[str, str], by_place: dict[str, str]
) -> None:
    standing, scene = stand(robots, PAIR)
    assert standing == [each for each in by_place.values() if each]
    assert scene.robots == {place: PAIR.robots[place] for place in by_place}


@pytest.mark.parametrize("robots", [["a"], ["a", "b"]])
def test_robots_of_a_scene_that_says_nothing_of_them_are_in_its_frame(robots: list[str]) -> None:
    assert stand(robots, OPEN) == (robots, OPEN)


@pytest.mark.parametrize(
    ("robots", "scene", "sentence"),
    [
        ({"lft": "a"}, PAIR, "the scene 'pair' has no robot 'lft'; it has 'left', 'right'"),
        ({"left": "a"}, OPEN, "the scene 'open' has no robot 'left'; it does not say where"),
        (["a"], PAIR, "'robots' lists 1, but in the scene 'pair' stand 'left', 'right'"),
        (["a", "b", "c"], PAIR, "'robots' lists 3, but in the scene 'pair' stand"),
        ({"left": "a", "right": "a"}, PAIR, "'robots' names the robot 'a' more than once"),
    ],
)
def test_what_does_not_fit_the_scene_is_told(
    robots: Sequence[str] | Mapping[str, str], scene: Scene, sentence: str
) -> None:
    with pytest.raises(WrongInputError, match=sentence):
        stand(robots, scene)


async def test_a_run_has_each_robot_in_its_frame_and_the_journal_says_so() -> None:
    async with pretend_service(ONE_PART, scene=PAIR) as service:
        for name in ("a", "b"):
            service.robots.robots[name] = PretendRobot(name, slow=True)
        request = {"tree": "tree", "world": "live", "robots": {"right": "a", "left": "b"}}
        view = await service.runtime.start_run(RunRequest.model_validate_json(json.dumps(request)))
        state = service.run_of(view).context.state  # type: ignore[arg-type]
        assert state.frames == {"b": Frame(), "a": Frame(1.0, 0.0, 2)}
        (started,) = await service.journal.read(0, 1, view.id)
        assert isinstance(started, ev.RunStarted)
        assert started.robots == view.robots == ["b", "a"]
        assert list(started.scene["robots"]) == ["left", "right"]
        await service.runtime.abort(view.id)
        await asyncio.wait_for(service.runtime.wait_for_end(view.id), 60)


async def test_a_place_that_is_none_is_told_before_a_robot_that_is_not_there() -> None:
    async with pretend_service(ONE_PART, scene=PAIR) as service:
        service.robots.robots["a"] = PretendRobot("a")
        wrong = RunRequest(tree="tree", world="live", robots={"lft": "nobody"})
        with pytest.raises(WrongInputError, match="no robot 'lft'"):
            await service.runtime.start_run(wrong)
        absent = RunRequest(tree="tree", world="live", robots={"left": "a", "right": "nobody"})
        with pytest.raises(NotConnectedError) as refused:
            await service.runtime.start_run(absent)
        assert service.journal.head == 0
    assert str(refused.value) == "no robot 'nobody' is connected (connected and free: 'a')"
    assert refused.value.robots == ["nobody"]


@pytest.mark.parametrize("robots", ["a", 1, [1], {"left": 1}])
def test_robots_are_names(robots: object) -> None:
    with pytest.raises(ValidationError):
        RunRequest.model_validate({"tree": "tree", "world": "live", "robots": robots})
