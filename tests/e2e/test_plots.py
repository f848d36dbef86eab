"""Numbers of a run over its clock, gone along with the keys, and read as a table."""

from collections.abc import Awaitable, Callable

import pytest
import pytest_asyncio
from console_in_browser import OpenPage
from playwright.async_api import Page, expect
from recorded_service import recorded_events
from shown_run import hello, poses, run_state

from mend.server.composition import Service
from mend.server.journal import events as ev
from mend.server.journal.journal import Entry
from mend.server.poses.frame import encode, framed
from mend.server.poses.layout import lay_out
from mend.server.poses.record import layout_path, record_path

# One event loop for all tests of the console, and so one browser.
pytestmark = pytest.mark.asyncio(loop_scope="session")

RECORDED = recorded_events()
RUN = RECORDED[0].run


@pytest_asyncio.fixture(scope="module", loop_scope="session")
async def recorded(lasting_service: Service) -> None:
    await lasting_service.journal.append(Entry(events=RECORDED))


@pytest_asyncio.fixture(loop_scope="session")
async def plots(recorded: None, reopen: Callable[[str], Awaitable[Page]]) -> Page:  # noqa: ARG001
    page = await reopen(f"/runs/{RUN}")
    await page.get_by_role("button", name="Plots", exact=True).click()
    return page


def moment_in(url: str) -> float:
    """The moment of the run that an address shows; infinite where it shows the last of it."""
    _, _, moment = url.partition("?t=")
    return float(moment or "inf")


async def test_the_keys_go_from_value_to_value_and_the_replay_with_them(plots: Page) -> None:
    page = plots
    await page.get_by_label("Number to plot").select_option(label="node started: attempt")
    plot = page.get_by_role("slider", name="node started: attempt")
    await expect(plot.locator("canvas")).to_be_visible()
    starts = [each for each in RECORDED if isinstance(each, ev.NodeStarted)]
    await expect(plot).to_have_attribute("aria-valuemax", str(len(starts)))
    await plot.press("Home")
    await expect(plot).to_have_attribute("aria-valuetext", f"1 at {starts[0].time:.1f} s")
    await plot.press("ArrowRight")
    await expect(plot).to_have_attribute("aria-valuenow", "2")
    # The address follows what is shown a little later.
    await page.wait_for_url(lambda url: 0.0 <= moment_in(url) - starts[1].time < 0.1)
    await plot.press("ArrowLeft")
    await expect(plot).to_have_attribute("aria-valuenow", "1")
    await plot.press("End")
    await expect(plot).to_have_attribute("aria-valuenow", str(len(starts)))


async def test_a_click_on_a_plot_goes_to_its_time(plots: Page) -> None:
    page = plots
    await page.get_by_label("Number to plot").select_option(label="step started: step")
    plot = page.get_by_role("slider", name="step started: step")
    box = await plot.locator(".u-over").bounding_box()
    assert box is not None
    await plot.locator(".u-over").click(position={"x": box["width"] / 2, "y": 40})
    await page.wait_for_url(lambda url: abs(moment_in(url) - RECORDED[-1].time / 2) < 1.0)


async def test_a_plot_is_a_table_for_those_who_hear_it(plots: Page) -> None:
    page = plots
    await page.get_by_label("Number to plot").select_option(label="step started: step")
    panel = page.get_by_role("region", name="step started: step", exact=True)
    await panel.get_by_role("button", name="As a table").click()
    steps = [each for each in RECORDED if isinstance(each, ev.StepStarted)]
    rows = panel.get_by_role("row")
    await expect(rows).to_have_count(1 + len(steps))
    await expect(rows.nth(3)).to_contain_text(str(steps[2].step))
    await rows.nth(3).get_by_role("button").click()
    await expect(rows.nth(3)).to_have_attribute("aria-current", "time")
    await panel.get_by_role("button", name="Remove").click()
    await expect(panel).to_have_count(0)


async def test_recorded_poses_have_numbers_too(service: Service, open_page: OpenPage) -> None:
    shows = hello().shows
    assert shows is not None
    folder = service.settings.journal_path.with_suffix(".poses")
    folder.mkdir(exist_ok=True)
    layout = lay_out(run_state(RUN), hello(), shows, None)
    layout_path(folder, RUN).write_text(layout.model_dump_json())
    frames = [encode(number, number / 10, poses(number / 100)) for number in range(700)]
    record_path(folder, RUN).write_bytes(framed(frames))
    await service.journal.append(Entry(events=RECORDED))
    page = await open_page(f"/runs/{RUN}")
    await page.get_by_role("button", name="Plots", exact=True).click()
    await page.get_by_label("Number to plot").select_option(label="joint: elbow")
    plot = page.get_by_role("slider", name="joint: elbow")
    await expect(plot).to_have_attribute("aria-valuemax", "700")
    await plot.press("Home")
    await plot.press("PageUp")
    await expect(plot).to_have_attribute("aria-valuetext", "0.1 rad at 1.0 s")
