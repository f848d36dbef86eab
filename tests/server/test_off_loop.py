"""Much work is done in a process of its own, which is begun anew if it dies."""

import asyncio
import os
import signal
import sys
from collections.abc import AsyncIterator
from pathlib import Path

import psutil
import pytest

from mend.server.documents import DocumentMistake, WrongDocumentError
from mend.server.errors import BusyError
from mend.server.limits import Limits
from mend.server.off_loop import MUCH_CHARS, OffLoop


@pytest.fixture
async def off_loop() -> AsyncIterator[OffLoop]:
    off_loop = OffLoop()
    yield off_loop
    off_loop.close()


def fail() -> None:
    raise WrongDocumentError(
        "task", [DocumentMistake(line=3, column=1, node="/0", message="it is wrong")]
    )


def die() -> None:
    os.kill(os.getpid(), signal.SIGKILL)


async def test_little_work_stays_in_the_process_and_much_does_not(off_loop: OffLoop) -> None:
    assert await off_loop.run(MUCH_CHARS - 1, os.getpid) == os.getpid()
    worker = await off_loop.run(MUCH_CHARS, os.getpid)
    assert worker != os.getpid()
    assert await off_loop.run(MUCH_CHARS, os.getpid) == worker


async def test_a_refusal_comes_back_as_it_was_made(off_loop: OffLoop) -> None:
    with pytest.raises(WrongDocumentError, match="the task file has a mistake") as wrong:
        await off_loop.run(MUCH_CHARS, fail)
    assert wrong.value.sentences == ["line:3: /0: it is wrong"]
    assert [each.node for each in wrong.value.mistakes] == ["/0"]


async def test_a_process_that_dies_is_told_of_and_begun_anew(off_loop: OffLoop) -> None:
    with pytest.raises(BusyError, match="has died"):
        await off_loop.run(MUCH_CHARS, die)
    assert await off_loop.run(MUCH_CHARS, os.getpid) != os.getpid()


async def test_work_that_does_not_end_is_ended_and_the_next_is_done(off_loop: OffLoop) -> None:
    worker = psutil.Process(await off_loop.run(MUCH_CHARS, os.getpid))
    patience_s, off_loop.longest_s = off_loop.longest_s, 0.1
    with pytest.raises(BusyError, match="takes longer than") as refused:
        await off_loop.run(MUCH_CHARS, signal.pause)
    assert refused.value.limit == "check_s"
    worker.wait(60)
    off_loop.longest_s = patience_s
    assert await off_loop.run(MUCH_CHARS, os.getpid) != worker.pid


async def test_work_that_nobody_waits_for_any_more_keeps_nobody_waiting(off_loop: OffLoop) -> None:
    worker = psutil.Process(await off_loop.run(MUCH_CHARS, os.getpid))
    unwanted = asyncio.create_task(off_loop.run(MUCH_CHARS, signal.pause))
    next_one = asyncio.create_task(off_loop.run(MUCH_CHARS, os.getpid))
    await asyncio.sleep(0)
    unwanted.cancel()
    assert await next_one != worker.pid


async def test_who_comes_when_too_much_waits_is_told_so_at_once() -> None:
    off_loop = OffLoop(Limits(waiting_chars=2 * MUCH_CHARS))
    at_work = [asyncio.create_task(off_loop.run(MUCH_CHARS, os.getpid)) for _ in range(2)]
    await asyncio.sleep(0)
    with pytest.raises(BusyError, match="too many large files wait") as refused:
        await off_loop.run(MUCH_CHARS, os.getpid)
    assert refused.value.limit == "waiting_chars"
    assert len(set(await asyncio.gather(*at_work))) == 1
    # One alone may be as large as it likes.
    await off_loop.run(3 * MUCH_CHARS, os.getpid)
    off_loop.close()


async def test_its_process_ends_with_it() -> None:
    off_loop = OffLoop()
    worker = psutil.Process(await off_loop.run(MUCH_CHARS, os.getpid))
    off_loop.close()
    worker.wait(60)


async def test_what_is_under_way_or_waits_when_it_is_closed_is_abandoned() -> None:
    off_loop = OffLoop()
    worker = psutil.Process(await off_loop.run(MUCH_CHARS, os.getpid))
    asked = [asyncio.create_task(off_loop.run(MUCH_CHARS, signal.pause)) for _ in range(3)]
    await asyncio.sleep(0)
    off_loop.close()
    async with asyncio.timeout(60):
        told = await asyncio.gather(*asked, return_exceptions=True)
    assert [str(each) for each in told] == ["the service is shutting down"] * 3
    worker.wait(60)
    with pytest.raises(BusyError, match="shutting down"):
        await off_loop.run(MUCH_CHARS, os.getpid)


HAS_A_PROCESS = """
import asyncio, os, signal
from mend.server.off_loop import MUCH_CHARS, OffLoop

async def work():
    off_loop = OffLoop()
    print(await off_loop.run(MUCH_CHARS, os.getpid), flush=True)
    await off_loop.run(MUCH_CHARS, signal.pause)

if __name__ == "__main__":
    asyncio.run(work())
"""


@pytest.mark.skipif(sys.platform != "linux", reason="only Linux ends a process with its parent")
async def test_its_process_ends_with_a_service_that_is_killed(tmp_path: Path) -> None:
    program = tmp_path / "service.py"
    program.write_text(HAS_A_PROCESS)
    service = await asyncio.create_subprocess_exec(
        sys.executable, str(program), stdout=asyncio.subprocess.PIPE
    )
    assert service.stdout is not None
    async with asyncio.timeout(60):
        worker = psutil.Process(int(await service.stdout.readline()))
    service.kill()
    await service.wait()
    try:
        await asyncio.to_thread(worker.wait, 60)
    except psutil.TimeoutExpired:
        worker.kill()
        raise
