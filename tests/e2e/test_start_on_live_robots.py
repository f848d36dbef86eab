"""Starting a run on live robots: who is connected, and who stands where."""

from pathlib import Path

import pytest
from console_in_browser import TOKEN, OpenPage
from gated_robot import gated_robot
from playwright.async_api import expect

from mend.server.composition import Service
from mend.server.journal.run_index import RunPage

# One event loop for all tests of the console, and so one browser.
pytestmark = pytest.mark.asyncio(loop_scope="session")

TOGETHER = """
name: together
scene: kit_for_two
tree:
  and:
    - {behavior: pick_and_place, object: bolt_1, place: bolt_1}
    - {behavior: pick_and_place, object: nut_1, place: nut_1}
"""
EXAMPLES = Path(__file__).parents[2] / "examples" / "two_arms"


async def test_connected_robots_are_chosen_from(service: Service, open_page: OpenPage) -> None:
    page = await open_page("/start/eket")
    await page.get_by_role("radio", name="live Real robots").check()
    robots = page.get_by_role("group", name="Robots")
    await expect(robots).to_contain_text("No robot is connected.")
    async with gated_robot(service.robots_url, TOKEN, "demo") as demo:
        demo.may_look.clear()
        await robots.get_by_role("checkbox", name="demo").check()
        await page.get_by_role("button", name="Start the run").click()
        await page.wait_for_url("**/runs/*-*")
        (run,) = await service.runtime.runs(RunPage())
    assert (run.world, run.robots) == ("live", ["demo"])


async def test_who_stands_where_in_the_scene_is_asked(
    service: Service, open_page: OpenPage
) -> None:
    scene = (EXAMPLES / "kit_for_two.yaml").read_text()
    await service.library.scenes.save("kit_for_two", scene)
    await service.library.trees.save("together", TOGETHER)
    async with (
        gated_robot(service.robots_url, TOKEN, "one") as one,
        gated_robot(service.robots_url, TOKEN, "two") as two,
    ):
        one.may_look.clear()
        two.may_look.clear()
        page = await open_page("/start/together")
        await page.get_by_role("radio", name="live Real robots").check()
        await page.get_by_role("combobox", name="left").select_option("two")
        await page.get_by_role("combobox", name="right").select_option("one")
        await page.get_by_role("button", name="Start the run").click()
        await page.wait_for_url("**/runs/*-*")
        (run,) = await service.runtime.runs(RunPage())
        options = (await service.runtime.run(run.id)).options
    assert run.robots == ["two", "one"]
    assert options["robots"] == {"left": "two", "right": "one"}
