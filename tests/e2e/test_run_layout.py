"""A run's columns are drawn and remembered; its robots' cameras are shown, and large."""

from pathlib import Path

import pytest
from console_in_browser import TOKEN, OpenPage
from console_situations import ask
from gated_robot import gated_robot
from playwright.async_api import Locator, expect
from test_start_on_live_robots import EXAMPLES, TOGETHER

from mend.server.composition import Service
from mend.server.runtime.requests import RunRequest

# One event loop for all tests of the console, and so one browser.
pytestmark = pytest.mark.asyncio(loop_scope="session")


async def width(part: Locator) -> float:
    box = await part.bounding_box()
    assert box is not None
    return box["width"]


async def test_columns_are_drawn_and_remembered(service: Service, open_page: OpenPage) -> None:
    run = await ask(service)
    page = await open_page(f"/runs/{run}", viewport={"width": 1440, "height": 900})
    scene, side = page.locator(".run-area.world"), page.locator(".run-area.side")
    edge = page.get_by_role("separator", name="Width of the scene")
    before, beside = await width(scene), await width(side)
    box = await edge.bounding_box()
    assert box is not None
    await page.mouse.move(box["x"] + 6, box["y"] + 100)
    await page.mouse.down()
    await page.mouse.move(box["x"] + 106, box["y"] + 100)
    await page.mouse.up()
    assert await width(scene) == pytest.approx(before + 100, abs=2)
    at_the_side = page.get_by_role("separator", name="Width of the column at the side")
    await at_the_side.press("ArrowLeft")
    assert await width(side) == pytest.approx(beside + 20, abs=1)
    drawn = await width(scene)
    await page.reload()
    await expect(edge).to_be_visible()
    assert await width(scene) == pytest.approx(drawn, abs=1)
    await edge.press("Enter")
    await at_the_side.press("Enter")
    assert await width(scene) == pytest.approx(before, abs=1)
    assert await width(side) == pytest.approx(beside, abs=1)


async def test_a_camera_is_shown_large(service: Service, open_page: OpenPage) -> None:
    run = await ask(service)
    page = await open_page(f"/runs/{run}", viewport={"width": 1440, "height": 900})
    cameras = page.get_by_role("region", name="Cameras")
    await cameras.get_by_role("button", name="Enlarge: Head camera").click()
    large = page.get_by_role("dialog", name="Head camera")
    picture = large.get_by_role("img", name="Head camera, live")
    await expect(picture).to_be_visible()
    assert await width(picture) > 800
    await page.keyboard.press("Escape")
    await expect(large).to_have_count(0)


async def test_the_cameras_of_each_robot_are_shown(service: Service, open_page: OpenPage) -> None:
    scene = (Path(EXAMPLES) / "kit_for_two.yaml").read_text()
    await service.library.scenes.save("kit_for_two", scene)
    await service.library.trees.save("together", TOGETHER)
    async with (
        gated_robot(service.robots_url, TOKEN, "one") as one,
        gated_robot(service.robots_url, TOKEN, "two") as two,
    ):
        one.may_look.clear()
        two.may_look.clear()
        run = await service.runtime.start_run(
            RunRequest(tree="together", world="live", robots={"left": "one", "right": "two"})
        )
        page = await open_page(f"/runs/{run.id}")
        whose = page.get_by_label("Whose cameras")
        await expect(whose).to_have_value("one")
        async with page.expect_request("**/cameras/*?robot=two"):
            await whose.select_option("two")
