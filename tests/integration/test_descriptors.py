"""A service whose process has no file descriptor left, as a process of its own."""

import asyncio
import socket
from contextlib import ExitStack
from pathlib import Path

import httpx
import pytest
from service_process import service_process

DESCRIPTORS = 64
CLIENTS = 80


@pytest.mark.slow
async def test_without_descriptors_the_service_waits_and_goes_on_by_itself(tmp_path: Path) -> None:
    limits = {"MEND_LIMITS__STRANGERS_PER_ADDRESS": "1000", "MEND_LIMITS__HEAD_S": "2"}
    chosen = {**limits, "MEND_SPEECH_VOICE": "auto"}
    async with service_process(tmp_path, descriptors=DESCRIPTORS, **chosen) as service:
        with ExitStack() as stack:
            for _ in range(CLIENTS):
                stack.enter_context(socket.create_connection(("127.0.0.1", service.port)))
            async with asyncio.timeout(60):
                while "no more connections can be taken" not in service.complaints:  # noqa: ASYNC110
                    await asyncio.sleep(0.01)
            # It serves again while all of them are still there: they are ended one by one.
            async with httpx.AsyncClient(base_url=service.url, timeout=60) as client:
                assert (await client.get("/healthz")).status_code == 200
        assert await service.stop() == 0
        said = service.complaints.splitlines()
    assert sum("no more connections can be taken" in line for line in said) == 1
    # The voice may have tried a dozen texts meanwhile.
    assert len(said) < 40
    assert not any("Traceback" in line for line in said)
