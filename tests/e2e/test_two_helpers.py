"""Two helpers at the same question: who is on it, who takes it over, who is faster."""

import asyncio

import pytest
from console_in_browser import COUNT_TONES, Stage
from playwright.async_api import expect

pytestmark = pytest.mark.asyncio(loop_scope="session")


async def test_others_see_who_is_answering_and_can_take_over(lasting_stage: Stage) -> None:
    anna, bob = await lasting_stage.open_page(), await lasting_stage.open_page(helper="bob")
    dialogue = await lasting_stage.runs.open(lasting_stage.run, "dropped")
    await anna.locator(".answer.yes").focus()
    await expect(anna.get_by_text("You are on it")).to_be_visible()
    await expect(bob.get_by_text("anna is answering.")).to_be_visible()
    await bob.get_by_role("button", name="Take over").click()
    await expect(bob.get_by_text("You are on it")).to_be_visible()
    await expect(anna.get_by_text("bob is answering.")).to_be_visible()
    await lasting_stage.runs.release_expired(dialogue, "bob")
    await expect(anna.get_by_text("Nobody is on it yet.")).to_be_visible()


async def test_claimed_question_steps_behind_for_the_others(lasting_stage: Stage) -> None:
    anna, bob = await lasting_stage.open_page(), await lasting_stage.open_page(helper="bob")
    await lasting_stage.runs.open(lasting_stage.run, "dropped", "yellow_bar")
    await lasting_stage.runs.open(lasting_stage.run, "missed", "blue_leg")
    await anna.get_by_role("button", name="I am on it").click()
    await expect(bob.get_by_role("heading", name="I missed the blue leg")).to_be_visible()
    await expect(anna.get_by_role("heading", name="I lost hold of the yellow bar")).to_be_visible()
    await expect(bob.get_by_role("button", name="anna is on it")).to_be_visible()


async def test_claim_never_keeps_anybody_from_answering(lasting_stage: Stage) -> None:
    anna, bob = await lasting_stage.open_page(), await lasting_stage.open_page(helper="bob")
    dialogue = await lasting_stage.runs.open(lasting_stage.run, "dropped")
    await anna.get_by_role("button", name="I am on it").click()
    await expect(bob.get_by_text("anna is answering.")).to_be_visible()
    await bob.locator(".answer.yes").click()
    await expect(anna.get_by_text("bob answered YES.")).to_be_visible()
    assert lasting_stage.runs.dialogue_now(dialogue).answered_by == "bob"


async def test_of_two_helpers_who_race_one_wins_and_the_other_is_told(lasting_stage: Stage) -> None:
    anna, bob = await lasting_stage.open_page(), await lasting_stage.open_page(helper="bob")
    for _ in range(3):
        dialogue = await lasting_stage.runs.open(lasting_stage.run, "dropped")
        for page in (anna, bob):
            await expect(page.locator(".answer.yes")).to_be_enabled()
        await asyncio.gather(
            anna.evaluate("document.querySelector('.answer.yes')?.click()"),
            bob.evaluate("document.querySelector('.answer.yes')?.click()"),
        )
        winner = {"anna": bob, "bob": anna}
        for page in (anna, bob):
            await expect(page.get_by_text("The robot watches for the yellow bar")).to_be_visible()
        by = lasting_stage.runs.dialogue_now(dialogue).answered_by
        assert by is not None
        told = winner[by].get_by_role("status", name="What became of questions")
        await expect(told).to_contain_text(f"{by} ")
        await lasting_stage.runs.see(dialogue)
        for page in (anna, bob):
            await expect(page.get_by_text("No robot asks anything")).to_be_visible()


async def test_who_is_asked_is_called_and_the_others_see_it_and_may_take_it(
    lasting_stage: Stage,
) -> None:
    anna, bob = await lasting_stage.open_page(), await lasting_stage.open_page(helper="bob")
    for page in (anna, bob):
        await page.evaluate(COUNT_TONES)
    lasting_stage.runs.to = "anna"
    dialogue = await lasting_stage.runs.open(lasting_stage.run, "dropped")
    await expect(anna.get_by_text("You are asked now.")).to_be_visible()
    await expect(bob.get_by_text("anna is asked now.")).to_be_visible()
    await expect(anna).to_have_title("(1) Mend")
    await expect(bob).to_have_title("Mend")
    await anna.wait_for_function("window.tones > 0")
    assert await bob.evaluate("window.tones") == 0
    lasting_stage.runs.to = "bob"
    await lasting_stage.runs.ask_again(dialogue)
    await expect(bob.get_by_text("You are asked now.")).to_be_visible()
    await bob.wait_for_function("window.tones > 0")
    await expect(anna.get_by_text("bob is asked now.")).to_be_visible()
    await anna.get_by_role("button", name="Take it").click()
    await expect(bob.get_by_text("anna is answering.")).to_be_visible()
