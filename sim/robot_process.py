"""A simulated world's process: `python -P -m mend.sim.robot_process`, with its setup on stdin.

The first line of stdin is a `RobotProcessSetup` in JSON; stdin then stays open for as long as the
parent lives. Exits with 0 after a `shutdown` command or when the parent is gone, with 2 and one
sentence on stderr when it cannot run.
"""

import asyncio
import ctypes
import logging
import os
import random
import signal
import sys
import threading
from functools import partial
from pathlib import Path
from uuid import uuid4

from pydantic import ValidationError

from mend.documents.strict_model import StrictModel
from mend.garbage import look_for_garbage_seldom
from mend.robots.agent import AgentGroup
from mend.robots.link.channel import LinkRefusedError
from mend.robots.link.client import LinkedAgent, run_agents
from mend.robots.link.clock import LoopClock
from mend.robots.link.outbox import IN_MEMORY, Outbox
from mend.robots.link.pinned_tls import pinned_tls
from mend.robots.link.websocket import websocket_channel
from mend.sim.world import WorldAdapter, WorldSetup, WorldUnavailableError
from mend.tasks.plugins import PluginError, load_plugins

CANNOT_RUN = 2
PR_SET_PDEATHSIG = 1


class RobotProcessSetup(StrictModel):
    """What the process is told: which world, which robots in it, and where the service is.

    `tokens` are those of the robots, in their order. `certificate` is the file of the service's
    own, where it speaks TLS.
    """

    world: str
    setup: WorldSetup
    url: str
    tokens: list[str]
    certificate: str | None = None


def find_world(name: str) -> WorldAdapter:
    """The world adapter of that name.

    Raises `WorldUnavailableError` if there is none or it cannot run on this machine.
    """
    worlds = load_plugins("mend.worlds")
    if name not in worlds:
        known = ", ".join(sorted(worlds)) or "none is installed"
        raise WorldUnavailableError(f"there is no world '{name}' (there are: {known})")
    adapter: WorldAdapter = worlds[name]
    adapter.check_available()
    return adapter


def main() -> int:
    """Run one simulated world. Returns the exit code."""
    look_for_garbage_seldom()
    logging.basicConfig(level=logging.WARNING, format="%(name)s: %(message)s")
    _die_with_parent()
    try:
        told = RobotProcessSetup.model_validate_json(sys.stdin.buffer.readline())
        # Before the world is built: an orphan that came to connect would displace its successor.
        threading.Thread(target=_end_with_stdin, daemon=True).start()
        group = find_world(told.world).create_agents(told.setup)
        asyncio.run(_run(group, told))
    except ValidationError as error:
        first = error.errors(include_url=False, include_input=False)[0]
        where = ".".join(str(each) for each in first["loc"]) or "stdin"
        return _refuse(f"the setup of the robot is wrong at '{where}': {first['msg']}")
    except (WorldUnavailableError, PluginError, LinkRefusedError) as error:
        return _refuse(str(error))
    return 0


async def _run(group: AgentGroup, told: RobotProcessSetup) -> None:
    tls = None if told.certificate is None else pinned_tls(Path(told.certificate))
    linked = [
        LinkedAgent(
            agent,
            # Its parent is the service: it may stand still for as long as it likes, and be gone
            # only by closing stdin.
            partial(websocket_channel, told.url, token, tls, ping_s=None),
            Outbox(IN_MEMORY, robot, uuid4().hex),
        )
        for agent, robot, token in zip(group.agents, told.setup.robots, told.tokens, strict=True)
    ]
    await run_agents(group, linked, LoopClock(), random.Random(told.setup.seed))


def _end_with_stdin() -> None:
    """End the program when the parent has closed stdin, as it does when it dies."""
    # Not through sys.stdin: a thread that holds its lock would break the interpreter's exit.
    while os.read(sys.stdin.fileno(), 4096):
        pass
    # At once, whatever is under way: what the service has not acknowledged never happened.
    os._exit(0)


def _die_with_parent() -> None:
    """Have Linux kill this process when its parent dies, even by `kill -9`, even while it hangs."""
    if sys.platform == "linux":
        ctypes.CDLL(None).prctl(PR_SET_PDEATHSIG, signal.SIGKILL)


def _refuse(sentence: str) -> int:
    sys.stderr.write(f"{sentence}\n")
    return CANNOT_RUN


if __name__ == "__main__":
    sys.exit(main())
