"""Where the robot does not wait for help, nobody is asked any more once it has let go."""

from pathlib import Path
from typing import Any

import pytest
from awaited_events import events_until

from mend.server.composition import open_service
from mend.server.journal import events as ev
from mend.server.runtime.requests import RunRequest
from mend.server.settings import Settings


@pytest.mark.slow(5)
@pytest.mark.parametrize(
    "how", [{"speed": 20.0}, {"speed": "max", "answers": "none"}], ids=["live", "scripted"]
)
async def test_a_question_lapses_before_the_gripper_opens(
    tmp_path: Path, how: dict[str, Any]
) -> None:
    settings = Settings(port=0, data_dir=tmp_path, speech_voice="none")
    async with open_service(settings) as service:
        request = RunRequest.model_validate({"tree": "eket", "world": "tabletop", **how})
        await service.runtime.start_run(request)
        events = await events_until(
            service, lambda all_: any(isinstance(each, ev.DialogueClosed) for each in all_)
        )
        closed = next(each for each in events if isinstance(each, ev.DialogueClosed))
        events = await events_until(
            service,
            lambda all_: any(
                isinstance(each, ev.NodeDone) and each.node == closed.node for each in all_
            ),
        )
    assert (closed.issue, closed.reason) == ("positioning", "aborted")
    after = events[[each.seq for each in events].index(closed.seq) + 1]
    assert isinstance(after, ev.StepStarted)
    assert after.phase == "release"
    done = next(
        each for each in events if isinstance(each, ev.NodeDone) and each.node == closed.node
    )
    assert done.by == "robot"
