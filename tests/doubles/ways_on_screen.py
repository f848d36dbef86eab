"""What somebody reads who has never seen a question, and whether a button keeps its word.

They know nothing but what stands on the screen: the headline, the buttons, what each does.
"""

import re
from collections.abc import Callable
from typing import Any

from playwright.async_api import Page, expect

from mend.server.journal import events as ev
from mend.tasks.resolution import Resolution

MOST_WORDS = 25
"""As many may have to be read before the right button."""

AS_SEEN = """(card) => {
  const texts = document.createTreeWalker(card, NodeFilter.SHOW_TEXT);
  const seen = [];
  while (texts.nextNode()) {
    const { parentElement, data } = texts.currentNode;
    if (parentElement.closest(".unseen") === null) seen.push(data);
  }
  return seen.join(" ");
}"""
"""What stands on a card in its order, without what is only for those who have it read to them."""

Events = list[ev.Event]
ENDS: dict[str, Callable[[Events], bool]] = {
    r"counts .* as left out by you": lambda events: of(events, ev.NodeLeftOut)[0].helper == "anna",
    r"^Attempt (\d) of 3 has failed": lambda events: of(events, ev.NodeReset)[0].failed_attempt,
    r"both of us have done it": lambda events: resolved(events) == (Resolution.COLLAB_FINISH, True),
    r"slowly by myself": lambda events: resolved(events) == (Resolution.ROBOT_FINISH, False),
    r"^I take your word": lambda events: resolved(events) == (Resolution.ROBOT_FINISH, True),
    r"^You put .* at its place; it is done once": lambda events: (
        resolved(events) == (Resolution.HUMAN_FINISH, True)
        and of(events, ev.NodeDone)[0].by == "human"
    ),
    r"^You .*I try again": lambda events: resolved(events) == (Resolution.ROBOT_RETRY, True),
    r"^You .*(I go on|and go on|I take it|I pick it up|I place it|I ride on)": lambda events: (
        resolved(events) == (Resolution.ROBOT_FINISH, True)
    ),
    r"^I look whether what I see agrees": lambda events: (
        resolved(events) == (Resolution.ROBOT_FINISH, True)
    ),
}
"""What is so in the journal where it came as a button said, by words of what it said."""


def of(events: Events, kind: type[Any]) -> list[Any]:
    return [each for each in events if isinstance(each, kind)]


def resolved(events: Events) -> tuple[Resolution, bool]:
    [end] = of(events, ev.Resolved)
    return end.resolution, end.helped


def came_as_said(said: str, events: Events) -> bool:
    """Whether what a button said came true in the events of its dialogue.

    Raises `ValueError` where nobody knows what it means.
    """
    came = [so for words, so in ENDS.items() if re.search(words, said)]
    if not came:
        raise ValueError(f"nobody knows what {said!r} means")
    return all(so(events) for so in came)


async def labels_on(page: Page) -> list[str]:
    keys = re.compile(r"\s*\d$")
    return [keys.sub("", each) for each in await page.locator(".way").all_inner_texts()]


async def read_before(page: Page, last: str) -> list[str]:
    """All words of the card from its top to that button, in the order in which they stand."""
    await expect(page.locator("article.question > header + h2 + .question-answers")).to_be_visible()
    card = await page.locator("article.question").evaluate(AS_SEEN)
    headline = await page.locator(".question-text").inner_text()
    top = card[: card.index(headline) + len(headline)]
    below = card[len(top) :]
    before = top + below[: below.index(last) + len(last)]
    return [each for each in re.findall(r"[\w:’']+", before) if not re.fullmatch(r"\d", each)]


async def effect_of(page: Page, label: str) -> str:
    """What the page says that a button does."""
    term = page.locator(".way-effects > div").filter(
        has=page.locator("dt", has_text=re.compile(f"^{re.escape(label)}$"))
    )
    return await term.locator("dd").inner_text()
