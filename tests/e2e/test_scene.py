"""The run's scene in 3-D: it draws, it moves, and a person can intervene in it."""

import math
from uuid import UUID

import cv2
import numpy as np
import pytest
from console_in_browser import OpenPage
from console_situations import begin_two_boxes
from numpy.typing import NDArray
from playwright.async_api import Locator, Page, expect

from mend.server.composition import Service
from mend.server.runtime.requests import RunRequest
from mend.tasks.intervention import Intervention

# One event loop for all tests of the console, and so one browser.
pytestmark = pytest.mark.asyncio(loop_scope="session")

# A part that the robot comes to late, so that there is time to open the page before.
LATE = "blue leg"
LONG_MS = 60_000
CANVAS = "canvas.scene-canvas[data-drawn=true]"
CLEARLY_MOVED_PX = 8
LOOKS = 600
NEXT_PICTURE = "() => new Promise((done) => requestAnimationFrame(() => setTimeout(done, 50)))"
# Relative to the 3-D view, so that scrolling the page moves nothing.
SPOT = """each => {
    const view = each.parentElement.getBoundingClientRect();
    const { x, y } = each.getBoundingClientRect();
    return [x - view.x, y - view.y];
}"""


async def start(service: Service, speed: float) -> UUID:
    run = await service.runtime.start_run(
        RunRequest(tree="eket", world="tabletop", speed=speed, seed=1)
    )
    return run.id


async def drawn_canvas(page: Page) -> Locator:
    canvas = page.locator(CANVAS)
    await expect(canvas).to_be_visible(timeout=LONG_MS)
    await canvas.scroll_into_view_if_needed()
    return canvas


async def pixels(canvas: Locator) -> NDArray[np.int16]:
    encoded = np.frombuffer(await canvas.screenshot(), np.uint8)
    picture = cv2.imdecode(encoded, cv2.IMREAD_COLOR)
    assert picture is not None
    return picture.astype(np.int16)


def orange_pixels(picture: NDArray[np.int16]) -> int:
    blue, green, red = (picture[..., channel] for channel in range(3))
    return int(((red > green + 60) & (green > blue + 60)).sum())


async def place_of_name(page: Page, name: str) -> tuple[float, float]:
    """Where the middle of an object is on the page: its name is put there."""
    mark = page.locator(".scene-name", has_text=name)
    await expect(mark.locator("span")).to_be_visible(timeout=LONG_MS)
    x, y = await mark.evaluate(SPOT)
    return x, y


async def wait_for_motion(page: Page, name: str, before: tuple[float, float]) -> None:
    """Wait until an object is drawn elsewhere in the 3-D view than it was."""
    for _ in range(LOOKS):
        if math.dist(await place_of_name(page, name), before) > CLEARLY_MOVED_PX:
            return
        await page.evaluate(NEXT_PICTURE)
    pytest.fail(f"{name} is still drawn at {before}")


async def wait_for_held_to_move(page: Page) -> None:
    """Wait until whatever the gripper holds is drawn elsewhere than where it was held first."""
    held, first = page.locator(".scene-name.held"), dict[str, tuple[float, float]]()
    for _ in range(LOOKS):
        for name in await held.all_inner_texts():
            at = await place_of_name(page, name)
            if math.dist(at, first.setdefault(name, at)) > CLEARLY_MOVED_PX:
                return
        await page.evaluate(NEXT_PICTURE)
    pytest.fail(f"none of {sorted(first)} has moved")


async def open_list(page: Page) -> None:
    """Show the objects below the scene."""
    await page.get_by_role("button", name="Objects as a list").click(timeout=LONG_MS)


async def raised_issue(service: Service, run: UUID, page: Page) -> None:
    """Wait until the robot has noticed and asks."""
    await expect(page.get_by_role("button", name="YES")).to_be_visible(timeout=LONG_MS)
    events = await service.journal.read_records(0, 1000, run)
    assert any('"type":"issue_raised"' in each.text for each in events)


async def test_scene_draws_the_parts_in_their_colours_and_moves_what_is_held(
    service: Service, open_page: OpenPage
) -> None:
    run = await start(service, 1.0)
    page = await open_page(f"/runs/{run}", drawn=True)
    canvas = await drawn_canvas(page)
    names = page.get_by_role("button", name="Names")
    await names.click()
    await place_of_name(page, "orange top")
    # The names would hide the parts.
    await names.click()
    await expect(page.locator(".scene-name").first).to_be_hidden()
    picture = await pixels(canvas)
    assert picture.std() > 8
    assert orange_pixels(picture) > 100
    await names.click()
    await wait_for_held_to_move(page)


async def asked_run(service: Service, page: Page) -> UUID:
    """A run whose robot waits for an answer, and moves no part however long the page draws."""
    run = await start(service, 2.0)
    await service.runtime.intervene(
        run, Intervention.model_validate({"act": "steal", "object": "green_leg"})
    )
    await page.goto(f"/runs/{run}")
    await raised_issue(service, run, page)
    return run


async def test_parts_are_stolen_and_moved_by_clicks_in_the_scene(
    service: Service, open_page: OpenPage
) -> None:
    page = await open_page("/settings", drawn=True)
    await asked_run(service, page)
    canvas = await drawn_canvas(page)
    await page.get_by_role("button", name="Names").click()
    x, y = await place_of_name(page, LATE)
    await canvas.click(position={"x": x, "y": y})
    menu = page.get_by_role("menu", name=LATE)
    await menu.get_by_role("menuitem", name="Steal").click()
    await expect(page.get_by_role("status").filter(has_text=LATE)).to_have_text(
        f"The {LATE} is taken away."
    )
    await open_list(page)
    await expect(page.locator(".scene-row", has_text=LATE)).to_contain_text("taken away")
    before = await place_of_name(page, "orange top")
    await page.get_by_role("button", name="Intervene: orange top").click()
    await page.get_by_role("menuitem", name="Move").click()
    box = await canvas.bounding_box()
    assert box is not None
    # The near part of the table is in the lower middle of the picture, and free.
    await canvas.click(position={"x": 0.5 * box["width"], "y": 0.6 * box["height"]})
    await expect(page.locator(".scene-note")).to_have_text("The orange top is moved.")
    await wait_for_motion(page, "orange top", before)


async def test_the_list_below_the_scene_does_it_all_with_keys_and_says_what_is_refused(
    service: Service, open_page: OpenPage
) -> None:
    page = await open_page("/settings", drawn=True)
    # A robot that waits for an answer closes its gripper on nothing that is held out to it.
    await asked_run(service, page)
    opens = page.get_by_role("button", name="Objects as a list")
    await opens.focus(timeout=LONG_MS)
    await page.keyboard.press("Enter")
    await expect(opens).to_have_attribute("aria-expanded", "true")
    button = page.get_by_role("button", name=f"Intervene: {LATE}")
    await button.focus(timeout=LONG_MS)
    await page.keyboard.press("Enter")
    await expect(page.get_by_role("menuitem", name="Steal")).to_be_focused()
    await page.keyboard.press("Escape")
    await expect(button).to_be_focused()
    await page.keyboard.press("Enter")
    await expect(page.get_by_role("menuitem", name="Steal")).to_be_focused()
    await page.keyboard.press("Enter")
    await expect(page.locator(".scene-row", has_text=LATE)).to_contain_text("taken away")
    note = page.locator(".scene-note")
    for part, said in (("purple top", "held out"), ("orange top", "already")):
        await page.get_by_role("button", name=f"Intervene: {part}").click()
        await page.get_by_role("menuitem", name="Hand over").click()
        await expect(note).to_contain_text(said)
    await page.get_by_role("button", name="Intervene: the arm’s way").click()
    await page.get_by_role("menuitem", name="Block").click()
    await expect(page.locator(".scene-row", has_text="arm’s way")).to_contain_text("blocked")


async def test_replay_shows_where_everything_was(service: Service, open_page: OpenPage) -> None:
    run = await begin_two_boxes(service, "max")
    await service.runtime.wait_for_end(run)
    page = await open_page(f"/runs/{run}", drawn=True)
    await expect(page.get_by_text("The end", exact=True)).to_be_visible(timeout=LONG_MS)
    await drawn_canvas(page)
    await page.get_by_role("button", name="Names").click()
    at_the_end = await place_of_name(page, "red box")
    await page.get_by_label("Moment of the run").fill("0")
    await wait_for_motion(page, "red box", at_the_end)
    await open_list(page)
    await expect(page.locator(".scene-row", has_text="red box")).to_be_visible()
    await expect(page.get_by_role("button", name="Intervene: red box")).to_have_count(0)


async def test_without_webgl_the_cameras_and_the_list_remain(
    service: Service, open_page: OpenPage
) -> None:
    run = await start(service, 0.5)
    page = await open_page(f"/runs/{run}", drawn=False)
    await expect(page.get_by_text("cannot draw in 3-D")).to_be_visible(timeout=LONG_MS)
    # Pictures are asked for only while they can be seen.
    await page.locator(".cameras").scroll_into_view_if_needed()
    await expect(page.get_by_role("img", name="Head camera, live")).to_be_visible(timeout=LONG_MS)
    await page.get_by_role("button", name="Intervene: green leg").click()
    await page.get_by_role("menuitem", name="Steal").click()
    await expect(page.locator(".scene-row", has_text="green leg")).to_contain_text("taken away")
