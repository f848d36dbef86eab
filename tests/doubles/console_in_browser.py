"""What tests of the console share: the service's token, and how a page is opened."""

from collections.abc import Awaitable, Callable
from dataclasses import dataclass
from uuid import UUID

from played_dialogues import PlayedDialogues
from playwright.async_api import Page

TOKEN = "correct-horse-battery"

COUNT_TONES = """() => {
  window.tones = 0;
  const start = OscillatorNode.prototype.start;
  OscillatorNode.prototype.start = function (...given) {
    window.tones += 1;
    return start.apply(this, given);
  };
}"""
"""Evaluated in a page: from then on `window.tones` counts the tones that it plays."""

NO_WEBGL = """
const contextOf = HTMLCanvasElement.prototype.getContext;
HTMLCanvasElement.prototype.getContext = function (kind, ...given) {
  return kind.startsWith("webgl") ? null : contextOf.call(this, kind, ...given);
};"""
"""Begun with in a page: it is in a browser that cannot draw in 3-D."""

OpenPage = Callable[..., Awaitable[Page]]
"""`await open_page(path, helper=name, **context_options)`: a helper who has signed in.

Scenes are drawn by software here, which takes more than all else of a page: only where `drawn=True`
says so.
"""


@dataclass(frozen=True, slots=True)
class Stage:
    """A service without robots, on which a test plays one; `run` is a run that is going on."""

    runs: PlayedDialogues
    run: UUID
    open_page: OpenPage


async def settle(page: Page) -> None:
    """Let what moves come to its end: axe would judge colours on their way."""
    await page.evaluate(
        "() => Promise.all(document.getAnimations()"
        ".filter((each) => each.effect.getComputedTiming().endTime < Infinity)"
        ".map((each) => each.finished.catch(() => null)))"
    )
