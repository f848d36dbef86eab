"""The example clients, as a user runs them, against a service in a process of its own."""

import asyncio
import os
import sys
from collections.abc import AsyncIterator, Mapping, Sequence
from pathlib import Path

import pytest
import pytest_asyncio
from example_robot import ROBOT
from forked_mend import FORKED
from service_process import ServiceProcess, service_process
from two_boxes import BENCH, BOTH

from mend.server.client import MendClient

EXAMPLES = Path(__file__).parents[2] / "examples"

PULLED = """
name: pulled
tree: both
interventions:
  - when: {object: red_box, step: 4, fraction: 0.5}
    do: {act: steal, object: red_box, manner: pull}
answers: [yes, yes, yes, yes, yes, yes]
"""
ARGUMENTS: Mapping[str, Sequence[str]] = {
    "demo_client.py": ("--tree", "both", "--scenario", "pulled", "--world", "tabletop")
}
"""The demo's own world and task are those that take long."""

TIME_S = 600.0
"""Patience with a run, on a machine that is busy."""

pytestmark = pytest.mark.slow(2)


@pytest_asyncio.fixture(scope="module", loop_scope="module")
async def service(tmp_path_factory: pytest.TempPathFactory) -> AsyncIterator[ServiceProcess]:
    async with service_process(tmp_path_factory.mktemp("service"), forked=FORKED) as service:
        async with MendClient(service.url) as client:
            await client.upload_scene(BENCH)
            await client.upload_tree(BOTH)
            await client.upload_scenario(PULLED)
        yield service


@pytest.mark.asyncio(loop_scope="module")
@pytest.mark.parametrize("client", sorted(each.name for each in EXAMPLES.glob("*.py")))
async def test_an_example_client_sees_its_run_to_the_end(
    service: ServiceProcess, client: str
) -> None:
    async with asyncio.timeout(TIME_S):
        process = await asyncio.create_subprocess_exec(
            sys.executable, str(EXAMPLES / client), service.url, *ARGUMENTS.get(client, ()),
            env={**os.environ, "MEND_TOKEN": ""},
            stdout=asyncio.subprocess.PIPE, stderr=asyncio.subprocess.PIPE,
        )  # fmt: skip
        told, complaints = await process.communicate()
    assert (process.returncode, complaints) == (0, b"")
    assert told.endswith(b"has finished\n")


def test_the_example_robot_calls_where_a_service_listens_unless_told() -> None:
    from mend.server.settings import Settings

    assert f"127.0.0.1:{Settings.model_fields['port'].default}/ws/robot" in ROBOT.read_text()
    assert "8000" not in ROBOT.read_text()
