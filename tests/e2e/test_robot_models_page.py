"""How robots are drawn, in the console: models are listed, given, refused, fetched and deleted."""

import pytest
from console_in_browser import TOKEN, OpenPage
from console_situations import give_model
from gated_robot import gated_robot
from playwright.async_api import Page, expect
from small_model import BARE, packed
from test_tree_library import DROP

from mend.server.client import MendClient
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


async def test_a_german_page_says_in_german_why_the_service_refuses_a_model(
    service: Service, open_page: OpenPage
) -> None:
    await give_model(service, "lamp", packed())
    page = await open_page("/models", locale="de-DE", connected="Verbunden")

    async def told(name: str, file: str, content: bytes) -> str:
        """What the page says of it, as a whole."""
        given = {"name": file, "mimeType": "application/octet-stream", "buffer": content}
        await page.get_by_label("Ein Modell geben").set_input_files(given)
        form = page.get_by_role("form")
        await form.locator("input").fill(name)
        await form.get_by_role("button", name="Als Modell behalten").click()
        await expect(form.get_by_role("alert")).not_to_be_empty()
        said = await form.get_by_role("alert").inner_text()
        await form.get_by_role("button", name="Abbrechen").click()
        return said

    assert (
        await told("a", "a.zip", b"no ZIP")
        == "das Archiv kann nicht gelesen werden: es ist kein ZIP"
    )
    assert await told("a", "a.zip", packed({"meshes/base.obj": None})) == (
        "robot.urdf braucht meshes/base.obj, und das ist nicht im Archiv"
    )
    assert await told("a", "a.urdf", b"<robot>") == (
        "robot.urdf, Zeile 1: es ist kein XML (kein Element gefunden)"
    )
    twice = BARE.replace("</robot>", "<link name='post'/></robot>").encode()
    assert await told("a", "a.urdf", twice) == (
        "robot.urdf: das Glied „post“ gibt es mehr als einmal"
    )
    busy = "too many robot models wait to be read and checked already; try it again later"
    problem = {"type": "about:blank", "title": "", "status": 503, "detail": busy}
    await page.route("**/api/models/busy", lambda route: route.fulfill(status=503, json=problem))
    assert (await told("busy", "a.zip", packed())).startswith("zu viele Robotermodelle warten")
    large = {**problem, "status": 413, "detail": "the body is larger than 32 MiB"}
    await page.route("**/api/models/large", lambda route: route.fulfill(status=413, json=large))
    assert await told("large", "a.zip", packed()) == "was gesendet wird, ist größer als 32 MiB"
    # Somebody else has deleted it meanwhile.
    await page.unroute_all()
    async with MendClient(service.url, token=TOKEN) as client:
        await client.delete_model("lamp")
    await page.get_by_role("button", name="lamp löschen").click()
    await page.get_by_role("dialog").get_by_role("button", name="Löschen").click()
    await expect(page.get_by_text("es gibt kein Robotermodell „lamp“")).to_be_visible()
