"""The names of simulated robots are kept for as long as their runs last."""

from types import SimpleNamespace
from typing import Any
from uuid import uuid4

import pytest

from mend.server.journal.sqlite import SqliteJournal
from mend.server.robots.passes import OwnRobots
from mend.server.runtime.worlds import SimulatedHardware


class Handle:
    """A robot that may fail to stop."""

    def __init__(self, error: Exception | None) -> None:
        self._error = error

    async def stop(self) -> None:
        if self._error is not None:
            raise self._error


class Setup:
    robots = ("r",)

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

    state: Any = SimpleNamespace(
        id=uuid4(), started=SimpleNamespace(robots=["sim-1"], world="tabletop")
    )
    setup: Any = Setup()
    unused: Any = None
    names.reserve(["sim-1", "sim-2"])
    hardware = SimulatedHardware(launch, journal, names, setup, state, unused)
    await hardware.restart("sim-1")
    assert "sim-1" in names
    await hardware.restart("sim-1")
    assert "sim-1" in names
    if error is None:
        await hardware.release()
    else:
        with pytest.raises(OSError, match="does not end"):
            await hardware.release()
    assert "sim-1" not in names
    assert "sim-2" in names
    journal.close()
