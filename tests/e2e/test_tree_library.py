"""The library of task trees: upload, editor, and what can be done with a tree."""

import pytest
import pytest_asyncio
from console_in_browser import OpenPage
from legs_and_bars import LEGS, SCENE
from playwright.async_api import Locator, Page, Route, expect

from mend.server.composition import Service

# One event loop for all tests of the console, and so one browser.
pytestmark = pytest.mark.asyncio(loop_scope="session")

SHELF = """\
name: shelf
scene: legs_and_bars
tree:
  then:
    - {behavior: pick_and_place, object: green_leg, place: green_leg}
    - {behavior: pick_and_place, object: blue_leg, plce: blue_leg}
"""
CORRECT = SHELF.replace("plce", "place")

DROP = """([name, bytes]) => {
    const files = new DataTransfer();
    files.items.add(new File([new Uint8Array(bytes)], name));
    const target = document.querySelector("main h1");
    for (const type of ["dragenter", "dragover", "drop"]) {
        const event = {bubbles: true, cancelable: true, dataTransfer: files};
        target.dispatchEvent(new DragEvent(type, event));
    }
}"""


PASTE = """(area, text) => {
    area.value = text;
    area.dispatchEvent(new Event('input', { bubbles: true }));
}"""
OFFSETS = """frame => {
    const text = frame.querySelector("textarea").getBoundingClientRect();
    const number = [...frame.querySelectorAll("li")].find((each) => each.textContent === "1501");
    const index = [...number.parentElement.children].indexOf(number);
    const line = frame.querySelectorAll(".line")[index];
    const [beside, drawn] = [number, line].map((each) => each.getBoundingClientRect());
    return [drawn.top - (text.top + 24 * 1500), beside.top - drawn.top, drawn.left - text.left];
}"""


@pytest_asyncio.fixture(autouse=True, loop_scope="session")
async def bench(service: Service) -> None:
    """A scene in which a check takes a moment; and a task there."""
    await service.library.scenes.save("legs_and_bars", SCENE)
    await service.library.trees.save("legs", LEGS)


async def by_button(page: Page, name: str, content: bytes) -> None:
    file = {"name": name, "mimeType": "application/yaml", "buffer": content}
    await page.get_by_label("Upload a file").set_input_files(file)


async def by_dropping(page: Page, name: str, content: bytes) -> None:
    await page.evaluate(DROP, [name, list(content)])


async def open_library(open_page: OpenPage) -> Page:
    page = await open_page("/trees")
    await expect(page.get_by_role("link", name="eket built in")).to_be_visible()
    return page


def text_of(page: Page) -> Locator:
    return page.get_by_label("The file of the task tree")


def drawn(page: Page, name: str) -> Locator:
    return page.get_by_role("tree").get_by_role("treeitem", name=name)


async def test_wrong_file_is_put_right_saved_and_run(open_page: OpenPage) -> None:
    page = await open_library(open_page)
    await by_dropping(page, "shelf.yaml", SHELF.encode())
    await expect(page.get_by_text("shelf.yaml has 2 mistakes")).to_be_visible()
    await expect(page.get_by_role("status").filter(has_text="2 mistakes")).to_be_visible()
    await expect(page.locator(".text-editor-numbers .wrong")).to_have_text("6")
    await expect(page.get_by_role("button", name="Line 6 unknown key 'plce'")).to_be_visible()

    await text_of(page).fill(CORRECT)
    await expect(page.get_by_role("status").filter(has_text="No mistakes")).to_be_visible()
    await expect(drawn(page, "blue leg")).to_be_visible()
    await page.get_by_role("button", name="Save").click()

    await expect(page).to_have_url("/trees/shelf")
    await expect(page.get_by_role("heading", name="shelf", exact=True)).to_be_visible()
    await page.get_by_role("link", name="Start a run").click()
    await expect(page.get_by_label("Task tree")).to_have_value("shelf")
    await page.get_by_label("tabletop").check()
    await page.get_by_role("button", name="Start the run").click()
    await page.wait_for_url("**/runs/*")


async def test_right_file_is_in_the_library_at_once(open_page: OpenPage) -> None:
    page = await open_library(open_page)
    await by_button(page, "shelf.yaml", CORRECT.encode())
    await expect(page).to_have_url("/trees/shelf")
    await expect(drawn(page, "blue leg")).to_be_visible()


async def test_file_of_a_taken_name_replaces_nothing(open_page: OpenPage) -> None:
    page = await open_library(open_page)
    await by_button(page, "mine.yaml", CORRECT.replace("name: shelf", "name: eket").encode())
    await expect(page.get_by_text("There is a tree 'eket' already")).to_be_visible()
    await expect(page.get_by_label("Name", exact=True)).to_have_value("eket_copy")
    await page.get_by_role("button", name="Save").click()
    await expect(page).to_have_url("/trees/eket_copy")


async def test_file_that_is_no_text_is_refused_in_a_sentence(open_page: OpenPage) -> None:
    page = await open_library(open_page)
    await by_dropping(page, "photo.jpg", b"\xff\xd8\xff\xe0")
    await expect(page.get_by_role("alert").filter(has_text="photo.jpg is no text")).to_be_visible()
    await expect(page.get_by_role("heading", name="eket", exact=True)).to_be_visible()


async def test_drawing_follows_the_text_while_it_is_typed(open_page: OpenPage) -> None:
    page = await open_page("/edit/legs")
    await expect(drawn(page, "green leg")).to_be_visible()
    text = await text_of(page).input_value()
    await text_of(page).fill(text.replace("object: green_leg", "name: first, object: green_leg"))
    await expect(drawn(page, "first")).to_be_visible()
    await text_of(page).fill("tree: [")
    await expect(page.get_by_text("As it was before the mistakes")).to_be_visible()
    await expect(drawn(page, "first")).to_be_visible()


async def test_only_the_verdict_on_the_last_text_counts(open_page: OpenPage) -> None:
    page = await open_page("/edit/legs")
    await expect(page.get_by_role("status").filter(has_text="No mistakes")).to_be_visible()
    held: list[Route] = []

    async def hold(route: Route) -> None:
        if "slow_text" in (route.request.post_data or ""):
            held.append(route)
        else:
            await route.continue_()

    await page.route("**/api/trees/check", hold)
    async with page.expect_request("**/api/trees/check"):
        await text_of(page).fill("slow_text")
    await text_of(page).fill(CORRECT)
    await expect(drawn(page, "blue leg")).to_be_visible()
    for route in held:
        await route.abort()
    await expect(page.get_by_role("status").filter(has_text="No mistakes")).to_be_visible()


async def test_mistake_leads_to_its_line(open_page: OpenPage) -> None:
    page = await open_page("/edit")
    lines = [f"# {number}" for number in range(1, 200)]
    await text_of(page).fill("\n".join([*lines, "name: far_down", "tree: 7"]))
    await page.get_by_role("button", name="Line 201").click()
    await expect(text_of(page)).to_be_focused()
    selected = "area => area.value.slice(area.selectionStart, area.selectionEnd)"
    assert await text_of(page).evaluate(selected) == "tree: 7"
    await expect(page.locator(".text-editor .line.wrong")).to_be_in_viewport()


async def test_layers_stay_in_step_with_a_long_and_wide_text(open_page: OpenPage) -> None:
    page = await open_page("/edit")
    lines = [f"# {number}" for number in range(2000)]
    # Chromium types so long a text for many seconds; it has it at once where it is pasted.
    await text_of(page).evaluate(PASTE, "\n".join([*lines, "# " + "wide " * 100]))
    editor = page.locator(".text-editor")
    await editor.evaluate("frame => frame.scrollTo(0, 24 * 1500)")
    number = page.locator(".text-editor-numbers li").filter(has_text="1501")
    await expect(number).to_be_in_viewport()
    await editor.evaluate("frame => frame.scrollTo(300, frame.scrollTop)")
    assert await editor.evaluate(OFFSETS) == [0, 0, 0]
    area = text_of(page)
    assert await area.evaluate("area => area.scrollWidth - area.clientWidth") == 0


async def test_tab_leaves_the_text_and_enter_keeps_the_indentation(open_page: OpenPage) -> None:
    page = await open_page("/edit")
    await text_of(page).fill("tree:\n  then:\n    - a")
    await text_of(page).press("Control+End")
    await text_of(page).press("Enter")
    await text_of(page).press_sequentially("b")
    await expect(text_of(page)).to_have_value("tree:\n  then:\n    - a\n      b")
    # The mistakes come anew with each check, and Tab leads to the first of them.
    await expect(page.get_by_label("Mistakes")).to_contain_text('"a b"')
    await text_of(page).press("Tab")
    await expect(text_of(page)).not_to_be_focused()
    await page.keyboard.press("Shift+Tab")
    await expect(text_of(page)).to_be_focused()


async def test_unsaved_text_is_guarded_and_never_lost(open_page: OpenPage) -> None:
    page = await open_page("/edit/legs")
    await text_of(page).fill("my: precious")
    await page.get_by_role("link", name="Runs").click()
    await page.get_by_role("button", name="Keep editing").click()
    await expect(text_of(page)).to_have_value("my: precious")

    await page.get_by_role("link", name="Runs").click()
    await page.get_by_role("button", name="Leave").click()
    await expect(page.get_by_role("heading", name="Runs", exact=True)).to_be_visible()
    await page.goto("/edit/legs")
    await expect(text_of(page)).to_have_value("my: precious")
    await expect(page.get_by_text("changes that were not saved yet")).to_be_visible()
    await page.get_by_role("button", name="Discard changes").click()
    await page.get_by_role("button", name="Discard", exact=True).click()
    await page.goto("/edit/legs")
    await expect(page.get_by_role("status").filter(has_text="No mistakes")).to_be_visible()
    assert "precious" not in await text_of(page).input_value()


async def test_going_back_asks_too(open_page: OpenPage) -> None:
    page = await open_library(open_page)
    await page.get_by_role("link", name="Write a new one").click()
    await text_of(page).fill("my: precious")
    await page.go_back(wait_until="commit")
    await page.get_by_role("button", name="Keep editing").click()
    await expect(text_of(page)).to_have_value("my: precious")
    await expect(page).to_have_url("/edit")


async def test_refused_save_keeps_the_text(open_page: OpenPage) -> None:
    page = await open_page("/edit")
    await text_of(page).fill(CORRECT)
    await page.get_by_label("Name", exact=True).fill("tea_table")
    await page.get_by_role("button", name="Save").click()
    await expect(
        page.get_by_role("alert").filter(has_text="'tea_table' is built in")
    ).to_be_visible()
    await expect(text_of(page)).to_have_value(CORRECT)
    await page.get_by_label("Name", exact=True).fill("no good name")
    await page.get_by_role("button", name="Save").click()
    await expect(page.get_by_role("alert").filter(has_text="It was not saved")).to_be_visible()
    await expect(text_of(page)).to_have_value(CORRECT)


async def test_tree_is_deleted_after_one_question(open_page: OpenPage) -> None:
    page = await open_library(open_page)
    await by_button(page, "shelf.yaml", CORRECT.encode())
    await page.get_by_role("button", name="Delete").click()
    await page.get_by_role("button", name="Keep it").click()
    await expect(page.get_by_role("heading", name="shelf", exact=True)).to_be_visible()
    await page.get_by_role("button", name="Delete").click()
    await page.get_by_role("dialog").get_by_role("button", name="Delete").click()
    await expect(page).to_have_url("/trees")
    await expect(page.get_by_role("link", name="eket built in")).to_be_visible()
    await expect(page.get_by_role("link", name="shelf")).to_have_count(0)
