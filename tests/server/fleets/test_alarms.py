"""Who waits for a moment of a site's clock is woken once it has come, and not before."""

import asyncio

from mend.server.fleets.alarms import Alarms


async def test_each_is_woken_when_its_moment_comes() -> None:
    now_s = 0.0
    alarms = Alarms(lambda: now_s)
    woken: list[str] = []

    async def wait(name: str, moment_s: float) -> None:
        await alarms.wait(moment_s)
        woken.append(name)

    assert alarms.next_s is None
    async with asyncio.TaskGroup() as tasks:
        tasks.create_task(wait("later", 20.0))
        tasks.create_task(wait("sooner", 10.0))
        await asyncio.sleep(0)
        assert alarms.next_s == 10.0
        alarms.ring()
        await asyncio.sleep(0)
        assert not woken
        now_s = 12.0
        alarms.ring()
        for _ in range(10):
            await asyncio.sleep(0)
        assert woken == ["sooner"]
        assert alarms.next_s == 20.0
        now_s = 20.0
        alarms.ring()
    assert woken == ["sooner", "later"]
    assert alarms.next_s is None


async def test_what_is_past_is_waited_for_by_nobody() -> None:
    alarms = Alarms(lambda: 5.0)
    await alarms.wait(5.0)
    assert alarms.next_s is None
