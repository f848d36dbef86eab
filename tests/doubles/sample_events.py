"""Events for tests that do not care which."""

from datetime import UTC, datetime
from uuid import UUID

from mend.robots.link.messages import Detection
from mend.server.journal.events import IssueRaised, RunPaused, RunStarted

RUN = UUID("11111111-1111-4111-8111-111111111111")
WALL_TIME = datetime(2026, 1, 2, 3, 4, 5, tzinfo=UTC)


def paused(time: float = 1.0, run: UUID = RUN) -> RunPaused:
    return RunPaused(time=time, wall_time=WALL_TIME, run=run)


def started(run: UUID = RUN) -> RunStarted:
    return RunStarted(
        time=0.0,
        wall_time=WALL_TIME,
        run=run,
        tree_name="eket",
        tree={"name": "eket"},
        scene={"name": "eket"},
        world="tabletop",
        robots=["robot"],
        seed=7,
        speed="max",
        scenario=None,
        options={},
    )


def detected(run: UUID = RUN) -> IssueRaised:
    """A fault, with what the monitor saw."""
    return IssueRaised(
        time=1.0,
        wall_time=WALL_TIME,
        run=run,
        node="/0",
        name="green_leg",
        robot="robot",
        issue="dropped",
        object="green_leg",
        place="green_leg",
        execution=RUN,
        step=5,
        interrupts=True,
        detection=Detection(camera="forearm", center=(1.0, 2.0), expected=(3.0, 4.0)),
    )
