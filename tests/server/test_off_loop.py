"""Much work is done in a process of its own, which is begun anew if it dies."""

import os
import signal
from collections.abc import AsyncIterator

import psutil
import pytest

from server.documents import DocumentMistake, WrongDocumentError
from server.errors import ConflictError
from server.off_loop import MUCH_CHARS, OffLoop


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
    assert wrong.value.problems == ["line:3: /0: it is wrong"]
    assert [each.node for each in wrong.value.mistakes] == ["/0"]


async def test_a_process_that_dies_is_told_of_and_begun_anew(off_loop: OffLoop) -> None:
    with pytest.raises(ConflictError, match="has died"):
        await off_loop.run(MUCH_CHARS, die)
    assert await off_loop.run(MUCH_CHARS, os.getpid) != os.getpid()


async def test_its_process_ends_with_it() -> None:
    off_loop = OffLoop()
    worker = psutil.Process(await off_loop.run(MUCH_CHARS, os.getpid))
    off_loop.close()
    worker.wait(60)
