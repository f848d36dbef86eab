"""Whatever drops of the connection happen: every report once and in order, every command once."""

import asyncio
import random
import time

from counting_agent import CountingAgent
from dropping_channel import DroppingChannel
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from recording_sink import RecordingSink
from sampled import sample

from mend.robots.link.channel import Channel, memory_channel
from mend.robots.link.client import LinkSettings, run_agent
from mend.robots.link.clock import LoopClock
from mend.robots.link.messages import Shutdown, Start
from mend.robots.link.outbox import IN_MEMORY, Outbox
from mend.server.journal.sqlite import SqliteJournal
from mend.server.robots.registry import RobotRegistry

EXECUTIONS = 3
STEPS = 4

drops = st.lists(
    st.tuples(st.integers(0, 12), st.integers(0, 12), st.booleans()), min_size=1, max_size=12
)


@settings(
    deadline=None,
    max_examples=sample(20, 60),
    suppress_health_check=[HealthCheck.function_scoped_fixture],
)
@given(drops=drops, simulated=st.booleans())
def test_reports_are_committed_once_and_in_order_and_commands_done_once(
    drops: list[tuple[int, int, bool]], simulated: bool
) -> None:
    asyncio.run(deliver_through(drops, simulated))


async def deliver_through(drops: list[tuple[int, int, bool]], simulated: bool) -> None:
    journal = SqliteJournal(":memory:")
    registry = RobotRegistry(journal, time.monotonic)
    sink = RecordingSink(journal)
    registry.assign("counter", sink)
    left = list(drops)
    serving = []

    async def connect() -> Channel:
        robot_end, service_end = memory_channel()
        dropping: Channel = robot_end
        if left:
            sends, receives, at_service = left.pop()
            if at_service:
                served: Channel = DroppingChannel(service_end, sends=sends, receives=receives)
                serving.append(asyncio.create_task(registry.serve(served)))
                return robot_end
            dropping = DroppingChannel(robot_end, sends=sends, receives=receives)
        serving.append(asyncio.create_task(registry.serve(service_end)))
        return dropping

    agent = CountingAgent(steps=STEPS, simulated=simulated)
    outbox = Outbox(IN_MEMORY, "counter", "b1")
    impatient = LinkSettings(first_backoff_s=0.0001, longest_backoff_s=0.0002, goodbye_s=5.0)
    robot = asyncio.create_task(
        run_agent(agent, connect, outbox, LoopClock(), random.Random(0), impatient)
    )
    for n in range(EXECUTIONS):
        start = Start(execution=f"e{n}", node="/0", behavior="count", parameters={})
        registry.send("counter", f"c{n}", start)
        await sink.wait_until(lambda n=n: sink.types().count("finished") == n + 1)
    registry.send("counter", "last", Shutdown())
    async with asyncio.timeout(60):
        await robot
        await asyncio.gather(*serving)

    total = EXECUTIONS * (STEPS + 1)
    assert [receipt.seq for receipt in sink.receipts] == list(range(1, total + 1))
    assert sink.types() == (["step_started"] * STEPS + ["finished"]) * EXECUTIONS
    assert [command for command, _ in agent.handled] == ["c0", "c1", "c2", "last"]
    assert await journal.received("counter", "b1") == total
    registry.close()
    journal.close()
    outbox.close()
