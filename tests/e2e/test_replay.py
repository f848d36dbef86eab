"""Any moment of a run that has ended: its tree, its transcript and its choices."""

import math
from collections.abc import Awaitable, Callable, Sequence
from dataclasses import dataclass

import pytest
import pytest_asyncio
from long_run import long_run
from playwright.async_api import Browser, Locator, Page, expect
from recorded_service import recorded_events
from run_page import WAIT_MS, texts_in_order, told_after, wait_for_tree
from sampled import sample

from mend.dialogue.registry import load_scripts
from mend.server.composition import Service
from mend.server.journal import events as ev
from mend.server.journal.journal import Entry
from mend.server.runtime.run_state import RunState

# One event loop for all tests of the console, and so one browser.
pytestmark = pytest.mark.asyncio(loop_scope="session")


@dataclass(frozen=True)
class Replay:
    """The page of a run of the paper's scenario that has ended, and its events."""

    page: Page
    events: Sequence[ev.Event]

    @property
    def slider(self) -> Locator:
        return self.page.get_by_role("slider", name="Moment of the run")

    def first(self, kind: type[ev.Event]) -> ev.Event:
        return next(each for each in self.events if isinstance(each, kind))


@pytest_asyncio.fixture(scope="module", loop_scope="session")
async def recorded(lasting_service: Service) -> Sequence[ev.Event]:
    """The events of the run, which is in the service."""
    events = recorded_events()
    await lasting_service.journal.append(Entry(events=events))
    return await lasting_service.journal.read(0, 10_000, events[0].run)


@pytest_asyncio.fixture(loop_scope="session")
async def shown(recorded: Sequence[ev.Event], reopen: Callable[[str], Awaitable[Page]]) -> Replay:
    page = await reopen(f"/runs/{recorded[0].run}")
    await expect(page.get_by_role("tree")).to_be_visible()
    await expect(page).to_have_url(f"/runs/{recorded[0].run}")
    return Replay(page, recorded)


def folded(events: Sequence[ev.Event]) -> RunState:
    started = events[0]
    assert isinstance(started, ev.RunStarted)
    state = RunState(started, load_scripts())
    for event in events[1:]:
        state.fold(event)
    return state


async def test_tree_is_right_after_every_event(shown: Replay) -> None:
    await shown.slider.press("Home")
    # Several events may share the first moment; from the first one on, one at a time.
    first = next(i for i, each in enumerate(shown.events) if each.time > shown.events[0].time)
    # The first faults are among so many: what is later is looked at by scrubbing.
    last = sample(min(first + 40, len(shown.events)), len(shown.events))
    for count in range(first, last + 1):
        await wait_for_tree(shown.page, await told_after(folded(shown.events[:count])))
        if count < last:
            await shown.page.get_by_role("button", name="One event on").click()


async def test_scrubbing_shows_what_had_happened_by_then(shown: Replay) -> None:
    end = shown.events[-1].time
    for share in (0.8, 0.33, 0.5):
        time = round(end * share, 1)
        await shown.slider.fill(str(time))
        await expect(shown.page.get_by_text("You are looking at")).to_be_visible()
        past = [each for each in shown.events if each.time <= time]
        await wait_for_tree(shown.page, await told_after(folded(past)))
    await shown.page.get_by_role("button", name="To the end").click()
    await expect(shown.page.get_by_text("You are looking at")).to_have_count(0)
    await wait_for_tree(shown.page, await told_after(folded(shown.events)))


async def test_a_click_on_a_fault_goes_to_its_moment(shown: Replay) -> None:
    lane = shown.page.get_by_role("group", name="Faults")
    await lane.get_by_role("button").first.click()
    fault = shown.first(ev.IssueRaised)
    past = [each for each in shown.events if each.seq <= fault.seq]
    await wait_for_tree(shown.page, await told_after(folded(past)))
    await expect(shown.page.locator(".line[aria-current]")).to_contain_text("dropped")


async def test_a_click_on_the_timeline_goes_to_its_time(shown: Replay) -> None:
    ground = shown.page.locator(".timeline .ground")
    box = await ground.bounding_box()
    assert box is not None
    await shown.page.mouse.click(box["x"] + box["width"] / 2, box["y"] + 3)
    time = float(await shown.slider.input_value())
    assert abs(time - shown.events[-1].time / 2) < 1.0


async def test_candidates_behind_every_choice_are_shown(shown: Replay) -> None:
    choices = [
        each
        for each in shown.events
        if isinstance(each, ev.NodeStarted) and len(each.candidates) > 1
    ]
    assert choices
    for choice in choices:
        start = shown.page.locator(f".timeline [data-seq='{choice.seq}']")
        await start.focus()
        await shown.page.keyboard.press("Enter")
        panel = shown.page.get_by_role("region", name="Choice")
        rows = panel.get_by_role("rowgroup").nth(1).get_by_role("row")
        await expect(rows).to_have_count(len(choice.candidates))
        for row, candidate in zip(await rows.all(), choice.candidates, strict=True):
            await expect(row).to_contain_text(candidate.name.replace("_", " "))
            await expect(row.get_by_role("cell").nth(0)).to_have_text(f"{candidate.level:.2f}")
            await expect(row.get_by_role("cell").nth(1)).to_have_text(f"{candidate.potential:.2f}")
            await expect(row.get_by_role("cell").nth(2)).to_have_text(str(candidate.attempts))
        await expect(panel).to_contain_text("had the highest potential")


async def test_transcript_has_every_line_of_the_service_in_order(shown: Replay) -> None:
    text = await shown.page.get_by_role("log").text_content() or ""
    position = 0
    for said in texts_in_order(shown.events):
        position = text.index(said, position) + len(said)
    await expect(shown.page.get_by_role("log").locator(".line.fault")).to_have_count(6)


async def test_a_line_of_the_transcript_goes_to_its_moment(shown: Replay) -> None:
    answered = shown.first(ev.Answered)
    line = shown.page.locator(".line.answered").first
    await line.get_by_role("button").click()
    await expect(line).to_have_attribute("aria-current", "time")
    past = [each for each in shown.events if each.seq <= answered.seq]
    await wait_for_tree(shown.page, await told_after(folded(past)))


async def test_playing_comes_to_the_end(shown: Replay) -> None:
    await shown.page.get_by_label("Speed").select_option("8")
    await shown.slider.fill(str(round(shown.events[-1].time - 4, 1)))
    await shown.page.get_by_role("button", name="Play", exact=True).click()
    await expect(shown.page.get_by_text("The end", exact=True)).to_be_visible(timeout=WAIT_MS)
    await expect(shown.page.get_by_role("button", name="Play", exact=True)).to_be_visible()
    await wait_for_tree(shown.page, await told_after(folded(shown.events)))


async def test_everything_can_be_reached_with_the_keyboard(shown: Replay) -> None:
    page = shown.page
    await page.get_by_role("treeitem").first.focus()
    for key in ("ArrowRight", "ArrowDown", "ArrowRight", "Enter"):
        await page.keyboard.press(key)
    pink_bar = page.get_by_role("treeitem", name="pink bar")
    await expect(pink_bar).to_be_focused()
    await expect(pink_bar).to_have_attribute("aria-selected", "true")
    await expect(page.get_by_role("region", name="Choice")).to_contain_text("pink bar")
    await page.get_by_role("group", name="Steps").get_by_role("button").first.focus()
    await page.keyboard.press("ArrowRight")
    await page.keyboard.press("ArrowDown")
    await expect(
        page.get_by_role("group", name="Faults").get_by_role("button").first
    ).to_be_focused()
    await page.keyboard.press("Enter")
    await expect(page.get_by_text("You are looking at")).to_be_visible()
    before = float(await shown.slider.input_value())
    await shown.slider.focus()
    await page.keyboard.press("ArrowRight")
    assert float(await shown.slider.input_value()) > before
    await page.keyboard.press("End")
    await expect(page.get_by_text("The end", exact=True)).to_be_visible()


async def test_timeline_is_a_list_for_those_who_hear_it(shown: Replay) -> None:
    await shown.page.get_by_role("button", name="Events as a list").click()
    entries = shown.page.get_by_role("list", name="Timeline as a list").get_by_role("button")
    await entries.filter(has_text="Fault").first.click()
    await expect(shown.page.get_by_text("You are looking at")).to_be_visible()
    await expect(shown.page.locator(".timeline-list [aria-current]")).to_have_count(1)


async def test_a_long_run_of_a_large_tree_stays_readable(
    lasting_service: Service, reopen: Callable[[str], Awaitable[Page]]
) -> None:
    events = long_run(groups=21, leaves=20)
    last = events[-1]
    finished = ev.RunFinished(time=last.time, wall_time=last.wall_time, run=last.run, missing=[])
    await lasting_service.journal.append(Entry(events=[*events, finished]))
    page = await reopen(f"/runs/{last.run}")
    await expect(page.get_by_text("The end", exact=True)).to_be_visible(timeout=WAIT_MS)
    await expect(page.locator(".line.choice")).to_have_count(420, timeout=WAIT_MS)
    # Folded away but for what fits, and open where the run is at the moment.
    assert await page.get_by_role("treeitem").count() <= 121
    await page.get_by_role("slider", name="Moment of the run").fill("4104.5")
    at_work = page.get_by_role("treeitem", name="part 410,")
    await expect(at_work).to_have_attribute("data-state", "active", timeout=WAIT_MS)
    await expect(at_work).to_be_in_viewport()
    await expect(page.locator(".line[aria-current]")).to_be_in_viewport()


async def test_a_link_leads_others_to_the_same_moment(shown: Replay, browser: Browser) -> None:
    raised = shown.first(ev.IssueRaised)
    await shown.slider.fill(f"{raised.time:.1f}")
    where = shown.page.get_by_text("You are looking at")
    await expect(where).to_be_visible()
    told = await where.inner_text()
    await shown.page.wait_for_url(f"**/runs/*?t={raised.time:.1f}")
    signed_in = await shown.page.context.storage_state()
    others = await browser.new_context(storage_state={**signed_in, "origins": []})
    await others.add_init_script("localStorage.setItem('mend.helper', '\"bob\"')")
    other = await others.new_page()
    await other.goto(shown.page.url)
    await expect(other.get_by_text("You are looking at")).to_have_text(told)
    await others.close()
    await shown.page.get_by_role("button", name="To the end").click()
    await shown.page.wait_for_url(lambda url: "?" not in url)


async def test_buttons_and_keys_go_from_fault_to_fault(shown: Replay) -> None:
    raised = [each for each in shown.events if isinstance(each, ev.IssueRaised)]
    before = shown.page.get_by_role("button", name="Previous fault")
    after = shown.page.get_by_role("button", name="Next fault")
    await expect(after).to_be_disabled()
    for fault in reversed(raised):
        await before.click()
        past = [each for each in shown.events if each.seq <= fault.seq]
        await wait_for_tree(shown.page, await told_after(folded(past)))
    await expect(before).to_be_disabled()
    await shown.page.get_by_role("tree").focus()
    await shown.page.keyboard.press("Shift+ArrowRight")
    past = [each for each in shown.events if each.seq <= raised[1].seq]
    await wait_for_tree(shown.page, await told_after(folded(past)))
    await expect(shown.page.get_by_role("region", name="Choice")).to_contain_text(
        raised[1].name.replace("_", " ")
    )
    await shown.slider.focus()
    await shown.page.keyboard.press("Shift+ArrowLeft")
    past = [each for each in shown.events if each.seq <= raised[0].seq]
    await wait_for_tree(shown.page, await told_after(folded(past)))
    # A link to it shows it, though the address has tenths of seconds alone.
    linked_s = math.ceil(raised[0].time * 10) / 10
    await shown.page.wait_for_url(f"**/runs/*?t={linked_s:.1f}")
    await shown.page.reload()
    past = [each for each in shown.events if each.time <= linked_s]
    assert raised[0] in past
    await wait_for_tree(shown.page, await told_after(folded(past)))


@pytest.mark.parametrize("form", ["csv", "mcap"])
async def test_a_run_is_kept_as_a_file(shown: Replay, form: str) -> None:
    link = shown.page.get_by_role("group", name="Export").get_by_role("link", name=form.upper())
    async with shown.page.expect_download() as download:
        await link.click()
    file = await download.value
    assert file.suggested_filename.startswith("eket-2026")
    assert file.suggested_filename.endswith(f".{form}")
    assert (await file.path()).stat().st_size > 10_000
