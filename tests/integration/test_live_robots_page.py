"""Every command of docs/live_robots.md does what the page says of it."""

import asyncio
import os
import re
import shlex
import sys
from collections.abc import AsyncIterator
from contextlib import AsyncExitStack, asynccontextmanager
from pathlib import Path

import pytest
from service_process import free_port

from mend.server.runtime.requests import RunRequest

ROOT = Path(__file__).parents[2]
PAGE = (ROOT / "docs" / "live_robots.md").read_text()
SECTIONS = {
    title: [shlex.split(each) for each in re.findall(r"```sh\n(.*?)\n```", text, re.S)]
    for title, text in re.findall(r"^## (.*?)\n(.*?)(?=^## |\Z)", PAGE, re.S | re.M)
}
PATIENCE_S = 120.0

pytestmark = pytest.mark.slow(3)


@asynccontextmanager
async def terminal(
    words: list[str], port: int, folder: Path
) -> AsyncIterator[asyncio.subprocess.Process]:
    """A command of the page in a terminal of its own, at a port that is free here."""
    program = Path(sys.executable).with_name(Path(words[0]).name)
    arguments = [each.replace(":8080", f":{port}") for each in words[1:]]
    if "examples/robot/robot.py" in arguments:
        arguments += ["--url", f"ws://127.0.0.1:{port}/ws/robot", "--step-s", "0.001"]
    kept = {name: value for name, value in os.environ.items() if not name.startswith("MEND_")}
    process = await asyncio.create_subprocess_exec(
        program, *arguments, cwd=ROOT,
        env={**kept, "MEND_PORT": str(port), "MEND_DATA_DIR": str(folder)},
        stdin=asyncio.subprocess.DEVNULL, stdout=asyncio.subprocess.PIPE,
        stderr=asyncio.subprocess.STDOUT,
    )  # fmt: skip
    try:
        yield process
    finally:
        if process.returncode is None:
            process.kill()
        await process.communicate()


async def _until_it_listens(process: asyncio.subprocess.Process) -> None:
    assert process.stdout is not None
    async for line in process.stdout:
        if b"Mend listens on" in line:
            return
    raise AssertionError("the service has ended")


def test_there_are_commands_to_try() -> None:
    assert [len(each) for each in SECTIONS.values()] == [2, 3, 3, 0, 0]


@pytest.mark.parametrize("title", [title for title, commands in SECTIONS.items() if commands])
async def test_the_commands_of_a_section_do_a_run(title: str, tmp_path: Path) -> None:
    *others, run = SECTIONS[title]
    port = free_port()
    async with AsyncExitStack() as terminals, asyncio.timeout(PATIENCE_S):
        for each in others:
            process = await terminals.enter_async_context(terminal(each, port, tmp_path))
            if each[1] == "serve":
                await _until_it_listens(process)
        running = await terminals.enter_async_context(terminal(run, port, tmp_path))
        told, _ = await running.communicate()
    assert running.returncode == 0, told.decode()
    assert told.decode().endswith("the run has finished: the task is done\n")


def test_the_requests_are_such() -> None:
    requests = re.findall(r"```json\n(.*?)\n```", PAGE, re.S)
    assert len(requests) == 2
    for each in requests:
        assert RunRequest.model_validate_json(each).world == "live"
