"""What can happen to a question besides an answer: undo, withdrawal, silence, a queue."""

import re
from collections.abc import Awaitable, Callable

import pytest
from console_in_browser import Stage
from playwright.async_api import Page, expect

pytestmark = pytest.mark.asyncio(loop_scope="session")


async def to_the_final_question(page: Page) -> None:
    """Refuse the first offer: what is asked then cannot be taken back."""
    await page.locator(".answer.no").click()
    await expect(page.get_by_role("heading", name="Will you place the yellow bar")).to_be_visible()


async def by_key(page: Page, _: str) -> None:
    await page.keyboard.press("y")


async def by_button(page: Page, answer: str) -> None:
    # By force: an answer that is given too early finds a button that does not take it yet.
    await page.locator(f".answer.{answer}").click(force=True)


@pytest.mark.parametrize("give", [by_key, by_button], ids=["key", "button"])
async def test_answer_to_a_question_that_nobody_can_have_read_is_not_taken_and_told(
    stage: Stage, give: Callable[[Page, str], Awaitable[None]]
) -> None:
    page = await stage.open_page()
    too_early = page.get_by_text("This question has only just come")
    await page.clock.install(time=0)
    await page.clock.pause_at(60_000)
    dialogue = await stage.runs.open(stage.run, "dropped")
    for question, answer in (("I lost hold", "no"), ("Will you place the yellow bar", "yes")):
        await expect(page.get_by_role("heading", name=question)).to_be_visible()
        await give(page, "yes")
        await expect(too_early).to_be_visible()
        assert stage.runs.dialogue_now(dialogue).awaiting == "answer"
        # Its time begins once it is drawn, and so with the frame after that.
        await page.clock.run_for(1_000)
        await expect(page.locator(f".answer.{answer}")).to_be_enabled()
        await page.keyboard.press(answer[0])
        await expect(too_early).to_be_hidden()
    await page.clock.run_for(1_000)
    await expect(page.get_by_text("It goes on by itself as soon as")).to_be_visible()


async def test_final_answer_can_be_undone(stage: Stage) -> None:
    page = await stage.open_page()
    dialogue = await stage.runs.open(stage.run, "dropped")
    await page.clock.install()
    await to_the_final_question(page)
    await page.locator(".answer.no").click()
    await page.get_by_role("button", name="Undo").click()
    await page.clock.fast_forward(10_000)
    await expect(page.get_by_role("button", name="Undo")).to_be_hidden()
    assert stage.runs.dialogue_now(dialogue).awaiting == "answer"
    await page.keyboard.press("n")
    await expect(page.get_by_role("button", name="Undo")).to_be_visible()
    await page.keyboard.press("Escape")
    await expect(page.get_by_role("button", name="Undo")).to_be_hidden()
    await page.locator(".answer.no").click()
    await page.clock.fast_forward(3_100)
    await expect(page.get_by_text("I try again (attempt 2 of 3)").first).to_be_visible()
    assert stage.runs.dialogue_now(dialogue).answered_by == "anna"


async def test_held_answer_is_sent_when_the_page_is_left(stage: Stage) -> None:
    page = await stage.open_page()
    other = await stage.open_page(helper="bob")
    await stage.runs.open(stage.run, "dropped")
    await to_the_final_question(page)
    await page.clock.install()
    await page.locator(".answer.no").click()
    await page.goto("/icon.svg")
    await expect(other.get_by_text("No robot asks anything")).to_be_visible()


async def test_held_answer_is_dropped_when_somebody_else_answers(stage: Stage) -> None:
    page = await stage.open_page()
    dialogue = await stage.runs.open(stage.run, "dropped")
    await to_the_final_question(page)
    await page.clock.install()
    await page.locator(".answer.no").click()
    await expect(page.get_by_role("button", name="Undo")).to_be_visible()
    prompt = stage.runs.dialogue_now(dialogue).prompt
    assert prompt is not None
    await stage.runs.dialogues.answer(dialogue, prompt.prompt, "yes", "bob")
    await expect(page.get_by_text("Your NO was not sent: bob answered first.")).to_be_visible()
    await page.clock.fast_forward(10_000)
    await expect(page.get_by_text("The robot watches for the yellow bar")).to_be_visible()


async def test_card_closes_by_itself_and_says_why(lasting_stage: Stage) -> None:
    page = await lasting_stage.open_page()
    for call, words in (
        ("put_right:in_reach:appeared", "I see the yellow bar within my reach now"),
        ("silence", "no help was seen"),
        ("abort", "the robot has stopped this task"),
    ):
        dialogue = await lasting_stage.runs.open(lasting_stage.run, "dropped")
        await expect(page.locator(".answer.yes")).to_be_visible()
        await lasting_stage.runs.call(dialogue, call)
        told = page.get_by_role("status", name="What became of questions")
        await expect(told).to_contain_text(words)
        await expect(told).to_contain_text("yellow bar")
        await expect(page.locator(".answer")).to_have_count(0)
        await told.get_by_role("button", name="Dismiss").click()
        await expect(told).to_be_empty()


async def test_a_robot_that_does_not_wait_says_so_and_takes_help_at_once(
    lasting_stage: Stage,
) -> None:
    page = await lasting_stage.open_page()
    told = page.get_by_role("status", name="What became of questions")
    dialogue = await lasting_stage.runs.open(lasting_stage.run, "positioning", interrupts=False)
    await expect(page.get_by_text("It does not wait")).to_be_visible()
    await expect(page.get_by_role("timer")).to_have_count(0)
    await expect(page.get_by_role("button", name="More time")).to_have_count(0)
    await lasting_stage.runs.call(dialogue, "abort")
    await expect(told).to_contain_text("the robot did not wait for an answer")
    dialogue = await lasting_stage.runs.open(lasting_stage.run, "positioning", interrupts=False)
    await page.get_by_role("button", name="YES").click()
    await expect(page.get_by_role("button", name="Undo")).to_have_count(0)
    await expect(page.get_by_role("button", name="YES")).to_have_count(0)
    assert lasting_stage.runs.dialogue_now(dialogue).answered_by == "anna"


async def test_more_time_moves_the_deadline(lasting_stage: Stage) -> None:
    page = await lasting_stage.open_page()
    lasting_stage.runs.deadline_s = 24.0
    await lasting_stage.runs.open(lasting_stage.run, "dropped")
    await expect(page.get_by_text("Less than 25 seconds are left")).to_be_attached()
    await page.get_by_role("button", name="More time").click()
    await expect(page.get_by_role("timer")).to_contain_text(re.compile(r"0:[345]\d"))
    await expect(page.get_by_text("Less than 25 seconds are left")).not_to_be_attached()


async def test_questions_queue_and_another_one_can_be_chosen(lasting_stage: Stage) -> None:
    page = await lasting_stage.open_page()
    await lasting_stage.runs.open(lasting_stage.run, "dropped", "yellow_bar")
    await lasting_stage.runs.open(lasting_stage.run, "missed", "blue_leg")
    await expect(page).to_have_title("(2) Mend")
    await expect(page.get_by_role("heading", name="I lost hold of the yellow bar")).to_be_visible()
    await page.get_by_role("button", name="the blue leg is not in it").click()
    await expect(page.get_by_role("heading", name="I missed the blue leg")).to_be_visible()
    await expect(page.get_by_role("heading", name="I lost hold of the yellow bar")).to_be_hidden()


async def test_other_views_lead_to_the_question(lasting_stage: Stage) -> None:
    page = await lasting_stage.open_page("/settings")
    await lasting_stage.runs.open(lasting_stage.run, "dropped")
    said = page.get_by_role("alert").filter(has_text="Will you put it back on the table?")
    await expect(said).to_be_attached()
    await page.get_by_role("link", name="Answer").click()
    await expect(page.get_by_role("heading", name="I lost hold of the yellow bar")).to_be_visible()


async def test_keys_can_be_changed_and_switched_off(lasting_stage: Stage) -> None:
    page = await lasting_stage.open_page("/settings")
    await page.get_by_label("Yes", exact=True).fill("j")
    await page.get_by_label("Yes", exact=True).press("Tab")
    await page.get_by_role("navigation").get_by_role("link", name="Questions").click()
    dialogue = await lasting_stage.runs.open(lasting_stage.run, "dropped")
    await expect(page.locator(".answer.yes")).to_be_enabled()
    await page.keyboard.press("y")
    await page.keyboard.press("j")
    await expect(page.get_by_text("It goes on by itself as soon as")).to_be_visible()
    await page.get_by_role("link", name="anna").click()
    await page.get_by_label("Answer with single keys").uncheck()
    await page.get_by_role("navigation").get_by_role("link", name="Questions").click()
    await lasting_stage.runs.see(dialogue, fulfilled=False)
    await expect(page.locator(".answer.yes")).to_be_enabled()
    await page.keyboard.press("j")
    await page.keyboard.press("n")
    await page.locator(".answer.no").focus()
    assert lasting_stage.runs.dialogue_now(dialogue).awaiting == "answer"


async def test_seconds_before_the_fault_can_be_scrubbed_by_key(lasting_stage: Stage) -> None:
    page = await lasting_stage.open_page()
    await lasting_stage.runs.open(lasting_stage.run, "dropped")
    slider = page.get_by_role("slider", name="Moment before the fault")
    picture = page.get_by_role("img", name="camera saw")
    await expect(slider).to_have_attribute("aria-valuetext", "the moment of the fault")
    at_fault = await picture.get_attribute("src")
    await expect(page.locator(".overlay .seen")).to_be_visible()
    await slider.press("ArrowLeft")
    await expect(slider).to_have_attribute("aria-valuetext", "0.2 seconds before the fault")
    await expect(picture).not_to_have_attribute("src", str(at_fault))
    await expect(page.locator(".overlay")).to_have_count(0)
    await page.get_by_role("button", name="Play the seconds before").click()
    await expect(slider).to_have_attribute("aria-valuetext", "the moment of the fault")


async def test_phone_shows_question_picture_and_answers_at_once(stage: Stage) -> None:
    page = await stage.open_page(viewport={"width": 390, "height": 844})
    await stage.runs.open(stage.run, "dropped")
    for width, height in ((390, 844), (360, 640)):
        await page.set_viewport_size({"width": width, "height": height})
        await expect(page.locator(".question").get_by_role("heading", level=2)).to_be_in_viewport(
            ratio=1
        )
        await expect(page.get_by_role("img", name="camera saw")).to_be_in_viewport(ratio=0.7)
        for button in await page.locator(".way").all():
            await expect(button).to_be_in_viewport(ratio=1)
            box = await button.bounding_box()
            assert box is not None
            assert min(box["width"], box["height"]) >= 64
        assert await page.evaluate("document.documentElement.scrollWidth") <= width


async def test_whoever_promised_help_sees_how_much_longer_it_is_waited_for(
    lasting_stage: Stage,
) -> None:
    page = await lasting_stage.open_page()
    dialogue = await lasting_stage.runs.open(lasting_stage.run, "dropped")
    await page.locator(".answer.yes").click()
    await expect(page.get_by_text(re.compile(r"It gives you [01]:\d\d more\."))).to_be_visible()
    await lasting_stage.runs.see(dialogue)
    await expect(page.get_by_text("It gives you")).to_have_count(0)
