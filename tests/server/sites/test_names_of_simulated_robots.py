"""The names of simulated robots are kept for as long as their runs last."""

from typing import Any
from uuid import uuid4

import pytest

from mend.server.journal.sqlite import SqliteJournal
from mend.server.robots.passes import OwnRobots
from mend.server.sites.running_world import RunningWorld


class Handle:
    """A robot that may fail to stop."""

    def __init__(self, error: Exception | None) -> None:
        self._error = error

    async def stop(self) -> None:
        if self._error is not None:
            raise self._error


class Setup:
    robots = ("sim-1",)

    def model_copy(self, update: Any) -> "Setup":  # noqa: ARG002
        return self


@pytest.mark.parametrize("error", [None, OSError("it does not end")], ids=str)
async def test_a_name_is_kept_while_its_robot_is_started_again_and_free_after_its_run(
    error: Exception | None,
) -> None:
    names, journal = OwnRobots(), SqliteJournal(":memory:")
    handles = [Handle(None), Handle(error)]

    async def launch(*_: Any) -> Handle:
        names.withdraw(names.issue("sim-1"))
        return handles.pop(0)

    setup: Any = Setup()
    names.reserve(["sim-2"])
    world = RunningWorld(launch, journal, names, "tabletop", uuid4(), setup, lambda *_: None)
    await world.restart("sim-1")
    assert "sim-1" in names
    await world.restart("sim-1")
    assert "sim-1" in names
    if error is None:
        await world.stop()
    else:
        with pytest.raises(OSError, match="does not end"):
            await world.stop()
    assert "sim-1" not in names
    assert "sim-2" in names
    journal.close()
