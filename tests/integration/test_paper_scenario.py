"""The paper's scenario (Blankenburg et al. 2020, Section 4.1), from end to end in the workcell.

On the tabletop it is the command's (`test_cli.py`).
"""

from pathlib import Path

import pytest
from broken_constraints import broken_constraints

from mend.server.composition import open_service
from mend.server.journal import events as ev
from mend.server.runtime.requests import RunRequest
from mend.server.runtime.views import RunStatus
from mend.server.settings import Settings

ISSUES = [
    ("pink_bar", "dropped"),
    ("yellow_bar", "dropped"),
    ("yellow_bar", "positioning"),
    ("blue_leg", "missed"),
    ("blue_leg", "positioning"),
    ("purple_top", "unreachable"),
]
RESOLUTIONS = [
    ("pink_bar", "human_finish"),
    ("yellow_bar", "robot_retry"),
    ("yellow_bar", "collab_finish"),
    ("blue_leg", "robot_retry"),
    ("blue_leg", "collab_finish"),
    ("purple_top", "robot_finish"),
]


@pytest.mark.slow(20)
async def test_the_base_is_built_through_every_fault(tmp_path: Path) -> None:
    pytest.importorskip("pybullet")
    settings = Settings(port=0, data_dir=tmp_path, speech_voice="none")
    async with open_service(settings) as service:
        request = RunRequest(
            tree="eket", world="workcell", speed="max", seed=7, scenario="eket_paper"
        )
        started = await service.runtime.start_run(request)
        view = await service.runtime.wait_for_end(started.id)
        events = await service.journal.read(0, 10_000, started.id)
    assert view.result is not None
    assert view.status is RunStatus.FINISHED, view.result.reason
    assert view.result.missing == []
    assert broken_constraints(events, {node.node: node.kind for node in view.nodes}) == []
    issues = [(each.object, each.issue) for each in events if isinstance(each, ev.IssueRaised)]
    resolutions = [
        (each.object, str(each.resolution)) for each in events if isinstance(each, ev.Resolved)
    ]
    assert issues == ISSUES
    assert resolutions == RESOLUTIONS
    assert all(each.picture for each in events if isinstance(each, ev.IssueRaised))
