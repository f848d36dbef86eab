"""The question card: what a helper sees and does while a robot waits."""

import json

import pytest
from console_in_browser import COUNT_TONES, OpenPage, Stage
from console_situations import STOLEN
from playwright.async_api import expect
from two_boxes import BENCH, BOTH

from mend.server.composition import Service
from mend.server.journal import events as ev
from mend.server.runtime.requests import RunRequest
from mend.tasks.intervention import Intervention

# One event loop for all tests of the console, and so one browser.
pytestmark = pytest.mark.asyncio(loop_scope="session")


async def test_question_is_shown_and_answered_with_a_button(
    service: Service, open_page: OpenPage
) -> None:
    page = await open_page()
    await expect(page.get_by_text("No robot asks anything")).to_be_visible()
    run = await service.runtime.start_run(RunRequest(tree="eket", world="tabletop", speed=5.0))
    await service.runtime.intervene(
        run.id, Intervention.model_validate({"act": "steal", "object": "green_leg"})
    )
    await expect(page.locator(".question").get_by_role("heading", level=2)).to_contain_text(
        "green leg", timeout=60_000
    )
    await page.get_by_role("button", name="YES").click()
    await expect(page.locator(".question").get_by_role("heading", level=2)).to_be_hidden()


@pytest.mark.parametrize(
    ("step", "words"),
    [
        (5, "The pink bar is no longer in the gripper."),
        (2, "The gripper closed, but the pink bar is not in it."),
    ],
    ids=["dropped", "missed"],
)
async def test_fault_of_a_robot_is_told_in_plain_words_with_its_picture(
    service: Service, open_page: OpenPage, step: int, words: str
) -> None:
    page = await open_page()
    part = "pink_bar"
    steal = Intervention.model_validate({"act": "steal", "object": part})
    with service.journal.subscribe(service.journal.head, 10_000) as events:
        run = await service.runtime.start_run(RunRequest(tree="eket", world="tabletop", speed=3.0))
        async for record in events:
            event = json.loads(record.text)
            if event["type"] == "step_started" and (event["name"], event["step"]) == (part, step):
                await service.runtime.intervene(run.id, steal)
                break
    await expect(page.get_by_text(words)).to_be_visible(timeout=60_000)
    await expect(page.get_by_role("img", name="forearm camera")).to_be_visible()
    await expect(page.locator(".overlay .expected")).to_be_visible()
    await expect(page.get_by_role("tree")).to_contain_text("pink bar")
    await expect(page.get_by_role("slider", name="Moment before the fault")).to_be_visible()


async def test_a_question_is_heard_though_the_page_is_in_front(
    stage: Stage,
) -> None:
    page = await stage.open_page()
    await page.bring_to_front()
    await page.evaluate(COUNT_TONES)
    assert await page.evaluate("document.visibilityState === 'visible' && document.hasFocus()")
    await stage.runs.open(stage.run, "dropped")
    await page.wait_for_function("window.tones > 0")


async def test_nobody_is_called_to_a_run_that_a_script_answers(
    service: Service, open_page: OpenPage
) -> None:
    page = await open_page()
    await page.evaluate(COUNT_TONES)
    # Something is stolen, and the script never answers what is asked about it.
    unanswered = {**STOLEN, "name": "unanswered", "answers": ["silence"] * 9}
    await service.library.scenes.save("small_bench", BENCH)
    await service.library.trees.save("both", BOTH)
    await service.library.scenarios.save("unanswered", json.dumps(unanswered))
    request = RunRequest(
        tree="both", world="tabletop", speed="max", scenario="unanswered", seed=2, max_attempts=1
    )
    run = await service.runtime.start_run(request)
    await expect(page.get_by_text("not all is well")).to_be_visible()
    events = await service.journal.read(0, 10_000, run.id)
    assert any(isinstance(each, ev.Prompt) and each.kind == "ask" for each in events)
    assert await page.title() == "Mend"
    assert await page.evaluate("window.tones") == 0
