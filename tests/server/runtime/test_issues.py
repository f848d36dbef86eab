"""An issue as dialogue scripts know it: how the robot came to know is read off what it detected."""

from datetime import UTC, datetime
from uuid import UUID

import pytest

from mend.robots.link.messages import Detection
from mend.server.journal import events as ev
from mend.server.runtime.dialogue_state import issue_of
from mend.tasks.issue import Sensed


@pytest.mark.parametrize(
    ("detection", "sensed"),
    [
        (None, Sensed.SEEN),
        (Detection(camera="head", center=(80.0, 60.0)), Sensed.SEEN),
        (Detection(camera="head"), Sensed.NOWHERE),
        (Detection(camera="head", felt=True), Sensed.FELT),
        (Detection(camera="laser"), Sensed.BY_LASER),
    ],
)
def test_how_a_robot_came_to_know_is_told_by_its_detection(
    detection: Detection | None, sensed: Sensed
) -> None:
    raised = ev.IssueRaised(
        time=1.0,
        wall_time=datetime(2026, 1, 2, tzinfo=UTC),
        run=UUID(int=1),
        node="/0",
        name="pink_bar",
        robot="pr2",
        issue="undone",
        object="pink_bar",
        place="left",
        execution=UUID(int=2),
        step=0,
        interrupts=True,
        detection=detection,
    )
    assert issue_of(raised).sensed is sensed
