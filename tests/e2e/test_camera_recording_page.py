"""Cameras are recorded by a button, and the replay shows what each of them saw."""

import pytest
from awaited_events import when
from console_in_browser import OpenPage
from console_situations import ask
from playwright.async_api import expect

from mend.server.composition import Service
from mend.server.journal import events as ev

# One event loop for all tests of the console, and so one browser.
pytestmark = pytest.mark.asyncio(loop_scope="session")


def shows_both(event: ev.Event) -> bool:
    recorded = isinstance(event, ev.CamerasRecorded)
    return recorded and len({each.camera for each in event.pictures}) == 2


async def test_what_is_recorded_is_seen_in_the_replay(
    service: Service, open_page: OpenPage
) -> None:
    run = await ask(service)
    page = await open_page(f"/runs/{run}")
    cameras = page.get_by_role("region", name="Cameras")
    await expect(page.get_by_role("button", name="YES").first).to_be_visible()
    await cameras.get_by_role("button", name="Record").click()
    await expect(cameras.get_by_role("button", name="Recording …")).to_be_disabled()
    log = page.get_by_role("log")
    await expect(log).to_contain_text("has the cameras recorded for 10 s")
    recorded = await when(service, shows_both)
    assert isinstance(recorded, ev.CamerasRecorded)
    await service.runtime.abort(run)
    time = recorded.pictures[0].time
    await page.goto(f"/runs/{run}?t={time:.1f}")
    for camera in ("Head camera", "Forearm camera"):
        picture = cameras.get_by_role("img", name=camera)
        await expect(picture).to_be_visible()
        assert await picture.evaluate("each => each.decode().then(() => each.naturalWidth)") > 0


async def test_a_run_that_is_over_is_recorded_no_more(
    service: Service, open_page: OpenPage
) -> None:
    run = await ask(service)
    page = await open_page(f"/runs/{run}")
    cameras = page.get_by_role("region", name="Cameras")
    await expect(cameras.get_by_role("button", name="Record")).to_be_visible()
    await service.runtime.abort(run)
    await expect(cameras.get_by_role("button", name="Record")).to_have_count(0)
