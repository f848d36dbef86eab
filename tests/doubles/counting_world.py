"""A world with a counting robot, for tests of robot processes."""

import sys
from pathlib import Path

from counting_agent import CountingAgent

from mend.documents.strict_model import StrictModel
from mend.robots.link.messages import CommandBody, Interrupt
from mend.sim.world import WorldSetup, WorldUnavailableError


class HangingAgent(CountingAgent):
    """An interrupt makes its simulator hang."""

    def handle(self, command_id: str, body: CommandBody) -> None:
        while isinstance(body, Interrupt):
            pass
        super().handle(command_id, body)


class NoOptions(StrictModel):
    """There is nothing to choose."""


class CountingWorld:
    """Implements `mend.sim.world.WorldAdapter`."""

    options = NoOptions

    lays_out_anything = False

    def __init__(self, *, own_process: bool = True, available: bool = True) -> None:
        self.own_process = own_process
        self._available = available

    def check_available(self) -> None:
        if not self._available:
            raise WorldUnavailableError("the world 'absent' needs a package that is not installed")

    def create_agents(self, setup: WorldSetup) -> CountingAgent:
        return HangingAgent(setup.robots[0], steps=50, pace=setup.speed)


class EndlessWorld(CountingWorld):
    """Building it never comes to an end."""

    def create_agents(self, setup: WorldSetup) -> CountingAgent:  # noqa: ARG002
        sys.stderr.write("building for ever\n")
        sys.stderr.flush()
        while True:
            pass


counting = CountingWorld()
embedded = CountingWorld(own_process=False)
absent = CountingWorld(available=False)
endless = EndlessWorld()

NAMES = ("counting", "embedded", "absent", "endless")


def install(folder: Path) -> None:
    """Make the folder, once it is on the path, provide these worlds."""
    metadata = folder / "counting_world-1.0.dist-info"
    metadata.mkdir()
    (metadata / "METADATA").write_text("Metadata-Version: 2.1\nName: counting-world\nVersion: 1\n")
    entries = [f"{name} = counting_world:{name}" for name in NAMES]
    (metadata / "entry_points.txt").write_text("\n".join(["[mend.worlds]", *entries]))
