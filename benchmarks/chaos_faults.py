"""The kinds of fault, each of which begins, lasts a while, and is over."""

import asyncio
import contextlib
import resource
import signal
from collections.abc import Awaitable, Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

from chaos_place import DESCRIPTORS, Place

DAY_S = 86_400.0


@dataclass(frozen=True, slots=True)
class Fault:
    """`alone`: not while another such fault lasts. `weight`: how often it is drawn."""

    name: str
    act: Callable[[Place], Awaitable[None]]
    weight: float = 1.0
    alone: bool = False


# --- The disk ---------------------------------------------------------------------------------


async def full_disk(place: Place) -> None:
    await asyncio.to_thread(place.disk.fill)
    try:
        await asyncio.sleep(place.a_while_s(10.0))
    finally:
        place.disk.free()


async def failing_writes(place: Place) -> None:
    """Every write of the service to a file fails, as on a broken or read-only disk."""
    with _no_file_may_grow(place.service.process.pid):
        await asyncio.sleep(place.a_while_s(10.0))


async def journal_away(place: Place) -> None:
    """Somebody moves the journal, sees what that does, and moves it back."""
    away = place.service.journal.with_suffix(".away")
    with _moved(place.service.journal, away):
        await asyncio.sleep(place.a_while_s(5.0))


# --- Processes --------------------------------------------------------------------------------


async def killed_service(place: Place) -> None:
    with place.probe.excused():
        await place.kill_service()
        await place.start_service()


async def killed_on_full_disk(place: Place) -> None:
    """The service dies for want of space, and comes back once there is some."""
    with place.probe.excused():
        await asyncio.to_thread(place.disk.fill)
        try:
            await asyncio.sleep(place.a_while_s(1.0))
            await place.kill_service()
            await place.service.spawn()
            await asyncio.sleep(place.a_while_s(4.0))
        finally:
            place.disk.free()
        if place.service.process.returncode is not None:
            await place.start_service()
        else:
            await place.wait_until_ready()


async def stopped_service(place: Place) -> None:
    with place.probe.excused():
        place.service.process.send_signal(signal.SIGSTOP)
        try:
            await asyncio.sleep(place.a_while_s(60.0))
        finally:
            place.service.process.send_signal(signal.SIGCONT)
        # What waits at its door by then is answered first.
        await place.clients.running()


async def killed_robot(place: Place) -> None:
    place.robots[place.rng.integers(len(place.robots))].kill()


async def stopped_robot(place: Place) -> None:
    robot = place.robots[place.rng.integers(len(place.robots))]
    await robot.stop_for(place.a_while_s(60.0))


async def descriptors_exhausted(place: Place) -> None:
    async with place.strangers.crowd(DESCRIPTORS + 50):
        await asyncio.sleep(place.a_while_s(3.0))


# --- Clocks -----------------------------------------------------------------------------------


async def clock_jump(place: Place) -> None:
    """The service's wall clock jumps by up to a day, and stays there."""
    place.clock.write_text(str(float(place.rng.uniform(-DAY_S, DAY_S))))


# --- Whoever connects -------------------------------------------------------------------------


async def half_sent_requests(place: Place) -> None:
    await place.strangers.half_sent(30, place.a_while_s(4.0))


async def stuck_helpers(place: Place) -> None:
    await place.strangers.stuck(8, place.a_while_s(6.0))


async def wrong_tokens(place: Place) -> None:
    await place.strangers.wrong_tokens(50)


async def hostile_robot(place: Place) -> None:
    await place.strangers.hostile_robot(place.rng, place.a_while_s(6.0))


async def aborted_run(place: Place) -> None:
    await place.clients.abort_one(int(place.rng.integers(100)))


FAULTS = (
    Fault("full disk", full_disk, alone=True),
    Fault("failing writes", failing_writes, alone=True),
    Fault("journal moved away", journal_away, 0.5, alone=True),
    Fault("service killed", killed_service, 1.5, alone=True),
    Fault("service killed on full disk", killed_on_full_disk, 0.5, alone=True),
    Fault("service stopped", stopped_service, alone=True),
    Fault("robot killed", killed_robot),
    Fault("robot stopped", stopped_robot),
    Fault("descriptors exhausted", descriptors_exhausted),
    Fault("clock jump", clock_jump),
    Fault("half-sent requests", half_sent_requests),
    Fault("stuck helpers", stuck_helpers),
    Fault("wrong tokens", wrong_tokens),
    Fault("hostile robot", hostile_robot, 2.0),
    Fault("run aborted", aborted_run, 0.5),
)


@contextmanager
def _no_file_may_grow(process: int) -> Iterator[None]:
    """The kernel refuses each write beyond a file's first byte (`EFBIG`)."""
    before = resource.prlimit(process, resource.RLIMIT_FSIZE)
    resource.prlimit(process, resource.RLIMIT_FSIZE, (0, before[1]))
    try:
        yield
    finally:
        with contextlib.suppress(ProcessLookupError):
            resource.prlimit(process, resource.RLIMIT_FSIZE, before)


@contextmanager
def _moved(file: Path, away: Path) -> Iterator[None]:
    file.rename(away)
    try:
        yield
    finally:
        away.rename(file)
