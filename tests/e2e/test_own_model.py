"""A live robot is drawn as the model that it has brought itself, as soon as it has."""

import cv2
import numpy as np
import pytest
from console_in_browser import TOKEN, OpenPage
from gated_robot import GatedRobot, gated_robot
from playwright.async_api import Page, Response, expect
from small_model import packed

from mend.server.client import MendClient
from mend.server.composition import Service
from mend.server.runtime.requests import RunRequest

# One event loop for all tests of the console, and so one browser.
pytestmark = pytest.mark.asyncio(loop_scope="session")

CANVAS = "canvas.scene-canvas[data-drawn=true]"
CLEARLY = 300
LOOKS = 100
NEXT_PICTURE = "() => new Promise((done) => requestAnimationFrame(() => setTimeout(done, 50)))"
SHOWS = {"model": "lamp", "joints": ["elbow"], "objects": []}


async def red_pixels(page: Page) -> int:
    """How much of the scene is as red as the model's box, and as nothing else there."""
    encoded = np.frombuffer(await page.locator(CANVAS).screenshot(), np.uint8)
    picture = cv2.imdecode(encoded, cv2.IMREAD_COLOR)
    assert picture is not None
    blue, green, red = (picture[..., channel].astype(np.int16) for channel in range(3))
    return int(((red > 2 * green + 40) & (red > 2 * blue + 40)).sum())


async def wait_for_red(page: Page, robot: GatedRobot, *, drawn: bool) -> None:
    for look in range(LOOKS):
        await robot.show(0.01 * look)
        if (await red_pixels(page) > CLEARLY) == drawn:
            return
        await page.evaluate(NEXT_PICTURE)
    pytest.fail(f"the model is {'not' if drawn else 'still'} drawn")


async def wait_for_meshes(page: Page, fetched: list[Response], folder: str) -> None:
    """Each is drawn as it comes."""
    wanted = {"lamp/meshes/foot.stl", "meshes/base.obj", "meshes/shade.dae"}
    came: dict[str, int] = {}
    for _ in range(LOOKS):
        came = {each.url.partition(folder)[2]: each.status for each in fetched}
        if came.keys() >= wanted:
            break
        await page.evaluate(NEXT_PICTURE)
    assert {each: came.get(each) for each in wanted} == dict.fromkeys(wanted, 200)


async def test_a_robot_is_drawn_as_the_model_that_it_brings(
    service: Service, open_page: OpenPage
) -> None:
    async with (
        MendClient(service.url, token=TOKEN) as client,
        gated_robot(service.robots_url, TOKEN, "demo", shows=SHOWS) as robot,
    ):
        robot.may_look.clear()
        run = await service.runtime.start_run(
            RunRequest.model_validate({"tree": "eket", "world": "live", "robots": ["demo"]})
        )
        page = await open_page(f"/runs/{run.id}", drawn=True)
        fetched: list[Response] = []
        page.on("response", lambda each: fetched.append(each))
        await robot.show(0.0)
        await expect(page.locator(CANVAS)).to_be_visible()
        await wait_for_red(page, robot, drawn=False)
        kept = await client.put_model("lamp", packed())
        await wait_for_red(page, robot, drawn=True)
        await wait_for_meshes(page, fetched, str(kept.urdf).removesuffix("robot.urdf"))
        assert kept in await client.models()
        await client.delete_model("lamp")
        await wait_for_red(page, robot, drawn=False)
