"""Runs of simulated robots, exported for Foxglove: nothing in them that it would not show."""

from pathlib import Path
from uuid import UUID

import httpx
import pytest
from console_situations import begin_rounds
from foxglove_rules import mistakes_in

from mend.server.composition import Service, open_service
from mend.server.runtime.requests import RunRequest
from mend.server.settings import Settings

EKET = RunRequest(tree="eket", world="tabletop", speed="max", scenario="eket_paper", seed=7)


def settings(folder: Path) -> Settings:
    return Settings(
        port=0, data_dir=folder, speech_voice="none", log_level="error", record_before_fault_s=3.0
    )


async def exported(service: Service, run: UUID) -> bytes:
    await service.runtime.wait_for_end(run)
    async with httpx.AsyncClient(base_url=service.url, timeout=60) as client:
        response = await client.get(f"/api/runs/{run}/export", params={"format": "mcap"})
    assert response.status_code == 200
    return response.content


@pytest.mark.slow(seconds=6)
async def test_of_an_arm_with_clips_of_its_faults(tmp_path: Path) -> None:
    async with open_service(settings(tmp_path)) as service:
        file = await exported(service, (await service.runtime.start_run(EKET)).id)
    assert mistakes_in(file) == []
    assert b"foxglove.CompressedImage" in file


@pytest.mark.slow(seconds=6)
async def test_of_robots_that_drive_on_two_floors(tmp_path: Path) -> None:
    async with open_service(settings(tmp_path)) as service:
        assert mistakes_in(await exported(service, await begin_rounds(service, "max"))) == []
