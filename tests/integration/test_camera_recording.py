"""What a simulated robot's cameras saw around a fault is kept, exported, and gone with the run."""

import io
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from pathlib import Path
from uuid import UUID

import cv2
import httpx
import numpy as np
import pytest
from awaited_events import when
from mcap.reader import make_reader

from mend.server.client import MendClient
from mend.server.client_errors import RefusedError
from mend.server.composition import Service, open_service
from mend.server.journal import events as ev
from mend.server.runtime.requests import RunRequest
from mend.server.settings import Settings
from mend.tasks.intervention import Intervention
from mend.tasks.scenario import Person

STEAL = Intervention.model_validate({"act": "steal", "object": "green_leg"})
CAMERAS = {"forearm", "head"}


@asynccontextmanager
async def recording(folder: Path, **settings: object) -> AsyncIterator[Service]:
    values = {"data_dir": folder, "port": 0, "speech_voice": "none", "recording_period_s": 0.1}
    async with open_service(Settings.model_validate({**values, **settings})) as service:
        yield service


async def begin(service: Service) -> UUID:
    """A run whose robot soon asks for what somebody has stolen, and gets no answer."""
    request = RunRequest(tree="eket", world="tabletop", speed=5.0, person=Person(acts=False))
    run = (await service.runtime.start_run(request)).id
    await service.runtime.intervene(run, STEAL)
    return run


def cameras_of(event: ev.Event) -> set[str]:
    of_event = isinstance(event, ev.CamerasRecorded)
    return {each.camera for each in event.pictures} if of_event else set()


async def test_all_cameras_are_kept_around_a_fault_and_exported(tmp_path: Path) -> None:
    async with (
        recording(tmp_path, record_before_fault_s=2.0) as service,
        MendClient(service.url) as client,
    ):
        run = await begin(service)
        raised = await when(service, lambda each: isinstance(each, ev.IssueRaised))
        first = await when(service, lambda each: isinstance(each, ev.CamerasRecorded))
        assert isinstance(first, ev.CamerasRecorded)
        assert first.seq > raised.seq
        assert cameras_of(first) == CAMERAS
        assert first.pictures[0].time < raised.time
        after = await when(
            service,
            lambda each: (
                isinstance(each, ev.CamerasRecorded) and each.pictures[-1].time >= raised.time
            ),
        )
        assert cameras_of(after) == CAMERAS
        async with httpx.AsyncClient(base_url=service.url) as http:
            jpeg = (await http.get(f"/api/pictures/{first.pictures[0].picture}")).content
        assert cv2.imdecode(np.frombuffer(jpeg, np.uint8), cv2.IMREAD_COLOR) is not None
        exported = make_reader(io.BytesIO(await client.run_export(run, "mcap")))
        topics = {channel.topic for _, channel, _ in exported.iter_messages()}
        assert {f"/pictures/{first.robot}/{each}" for each in CAMERAS} <= topics
        await client.abort(run)


async def test_an_operator_has_the_cameras_recorded(tmp_path: Path) -> None:
    async with (
        recording(tmp_path, record_after_fault_s=0.0) as service,
        MendClient(service.url) as client,
    ):
        run = await begin(service)
        await when(service, lambda each: isinstance(each, ev.IssueRaised))
        begun = await client.record(run, 1.0, "anna")
        assert (begun.by, begun.seconds) == ("anna", 1.0)
        recorded = await when(service, lambda each: cameras_of(each) == CAMERAS)
        assert isinstance(recorded, ev.CamerasRecorded)
        assert recorded.seq > begun.seq
        await client.abort(run)
        with pytest.raises(RefusedError, match="the run has ended"):
            await client.record(run, 1.0, "anna")


@pytest.mark.parametrize("seconds", [0, -1, 61, "long", None])
async def test_how_long_is_told_rightly(tmp_path: Path, seconds: object) -> None:
    async with recording(tmp_path) as service, httpx.AsyncClient(base_url=service.url) as http:
        path = f"/api/runs/{UUID(int=7)}/recordings"
        answer = await http.post(path, json={"seconds": seconds, "helper": "anna"})
    assert answer.status_code == 422
    assert answer.headers["content-type"] == "application/problem+json"
    assert "seconds" in answer.json()["detail"]
