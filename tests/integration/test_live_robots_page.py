"""Every command of docs/live_robots.md does what the page says of it."""

import asyncio
import os
import re
import shlex
import sys
from collections.abc import AsyncIterator
from contextlib import AbstractAsyncContextManager, AsyncExitStack, asynccontextmanager
from pathlib import Path

import pytest
from forked_mend import Command, mend_command
from service_process import free_port

from mend.server.runtime.requests import RunRequest

ROOT = Path(__file__).parents[2]
PAGE = (ROOT / "docs" / "live_robots.md").read_text()
SECTIONS = {
    title: [shlex.split(each) for each in re.findall(r"```sh\n(.*?)\n```", text, re.S)]
    for title, text in re.findall(r"^## (.*?)\n(.*?)(?=^## |\Z)", PAGE, re.S | re.M)
}
PATIENCE_S = 600.0

pytestmark = pytest.mark.slow


@asynccontextmanager
async def robot(words: list[str], port: int) -> AsyncIterator[None]:
    """An example robot of the page in a terminal of its own, which calls at that port."""
    program = Path(sys.executable).with_name(Path(words[0]).name)
    url = f"ws://127.0.0.1:{port}/ws/robot"
    kept = {name: value for name, value in os.environ.items() if not name.startswith("MEND_")}
    process = await asyncio.create_subprocess_exec(
        program, *words[1:], "--url", url, "--step-s", "0.001", cwd=ROOT, env=kept,
        stdin=asyncio.subprocess.DEVNULL, stdout=asyncio.subprocess.PIPE,
        stderr=asyncio.subprocess.STDOUT,
    )  # fmt: skip
    try:
        yield
    finally:
        if process.returncode is None:
            process.kill()
        await process.communicate()


def mend(
    words: list[str], port: int, folder: Path, monkeypatch: pytest.MonkeyPatch
) -> AbstractAsyncContextManager[Command]:
    """A command of the page in a terminal of its own, at a port that is free here."""
    monkeypatch.chdir(ROOT)
    arguments = [each.replace(":8080", f":{port}") for each in words[1:]]
    return mend_command(*arguments, MEND_PORT=str(port), MEND_DATA_DIR=str(folder))


def test_there_are_commands_to_try() -> None:
    assert [len(each) for each in SECTIONS.values()] == [2, 3, 3, 0, 0, 0]


@pytest.mark.parametrize("title", [title for title, commands in SECTIONS.items() if commands])
async def test_the_commands_of_a_section_do_a_run(
    title: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    *others, run = SECTIONS[title]
    port = free_port()
    async with AsyncExitStack() as terminals, asyncio.timeout(PATIENCE_S):
        for each in others:
            if "examples/robot/robot.py" in each:
                await terminals.enter_async_context(robot(each, port))
            else:
                other = mend(each, port, tmp_path, monkeypatch)
                serving = await terminals.enter_async_context(other)
                await serving.says("Mend listens on")
        running = await terminals.enter_async_context(mend(run, port, tmp_path, monkeypatch))
        code, told, complaints = await running.outcome()
    assert (code, complaints) == (0, "")
    assert told.endswith("the run has finished: the task is done\n")


def test_the_requests_are_such() -> None:
    requests = re.findall(r"```json\n(.*?)\n```", PAGE, re.S)
    assert len(requests) == 2
    for each in requests:
        assert RunRequest.model_validate_json(each).world == "live"
