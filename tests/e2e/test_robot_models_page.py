"""How robots are drawn, in the console: models are listed, given, refused, fetched and deleted."""

import pytest
from console_in_browser import TOKEN, OpenPage
from console_situations import give_model
from gated_robot import gated_robot
from playwright.async_api import Page, expect
from small_model import BARE, packed
from test_tree_library import DROP

from mend.server.composition import Service

# One event loop for all tests of the console, and so one browser.
pytestmark = pytest.mark.asyncio(loop_scope="session")

SHOWS = {"model": "lamp", "joints": ["elbow"], "objects": []}


async def choose(page: Page, name: str, content: bytes) -> None:
    file = {"name": name, "mimeType": "application/octet-stream", "buffer": content}
    await page.get_by_label("Give a model").set_input_files(file)


async def test_a_model_is_given_for_a_robot_and_deleted(
    service: Service, open_page: OpenPage
) -> None:
    async with gated_robot(service.robots_url, TOKEN, "demo", shows=SHOWS):
        page = await open_page("/models")
        rows = page.locator(".model-row")
        await expect(rows.filter(has_text="lamp")).to_contain_text(
            "Named by demo; a gripper stands for it."
        )
        await page.evaluate(DROP, ["arm.zip", list(packed())])
        name = page.get_by_label("Name, as robots say it")
        await expect(name).to_be_focused()
        await expect(name).to_have_value("lamp")
        await page.keyboard.press("Enter")
        await expect(rows.filter(has_text="lamp")).to_contain_text("4 files")
        await expect(rows.filter(has_text="lamp")).to_contain_text("Named by demo.")
        async with page.expect_download() as downloading:
            await page.get_by_role("link", name="Download lamp").click()
        assert (await downloading.value).suggested_filename == "lamp.zip"
        delete = page.get_by_role("button", name="Delete lamp")
        await delete.click()
        await expect(page.get_by_role("dialog")).to_contain_text("A gripper then stands for demo")
        await page.get_by_role("button", name="Keep it", exact=True).click()
        await delete.click()
        await page.get_by_role("dialog").get_by_role("button", name="Delete").click()
        await expect(rows.filter(has_text="lamp")).to_contain_text("not given")
    assert (await page.get_by_role("alert").all_inner_texts()).count("") > 0


async def test_what_is_refused_is_said_and_leaves_what_was_there(
    service: Service, open_page: OpenPage
) -> None:
    await give_model(service, "lamp", packed())
    page = await open_page("/models")
    await choose(page, "lamp.zip", packed({"meshes/base.obj": None}))
    await expect(page.get_by_text("It takes the place of the one that is there.")).to_be_visible()
    keep = page.get_by_role("button", name="Keep it as a model")
    await keep.click()
    await expect(page.get_by_text("robot.urdf needs meshes/base.obj")).to_be_visible()
    await page.get_by_label("Name, as robots say it").fill("pr2")
    await choose(page, "post.urdf", BARE.encode())
    await page.get_by_label("Name, as robots say it").fill("a/b")
    await keep.click()
    await expect(page.get_by_text("A model's name has no “/”")).to_be_visible()
    await page.get_by_role("button", name="Cancel").click()
    await choose(page, "notes.txt", b"no model")
    await expect(page.get_by_text("notes.txt is neither a ZIP")).to_be_visible()
    await page.reload()
    await expect(page.locator(".model-row").filter(has_text="lamp")).to_contain_text("4 files")
