"""What the tests of the run view share: what its page shows, and what it should."""

import json
from collections.abc import Sequence
from typing import Any

from playwright.async_api import Page

from mend.server.journal import events as ev
from mend.server.runtime.run_state import RunState
from mend.server.runtime.run_views import RunViewing
from mend.server.runtime.views import NodeView, RunResult
from mend.server.transcript import Transcript

SHOWN = """() => JSON.stringify([...document.querySelectorAll('[role=treeitem]')].map((node) => ({
    node: node.dataset.path,
    state: node.dataset.state,
    level: node.querySelector('title').textContent.match(/level ([0-9.]+)/)[1],
})))"""
"""A JavaScript function that tells what the page's tree shows."""

WAIT_MS = 60_000


def node_state(view: NodeView, talked_about: set[str], result: RunResult | None) -> str:
    """The word for a node's state in the page; `result` once the run has ended."""
    if view.done:
        return "done"
    if view.abandoned:
        return "abandoned"
    if result is not None:
        return "failed" if view.node == result.node else "left"
    if view.node in talked_about:
        return "in_dialogue"
    if view.active:
        return "active"
    return "eligible" if view.activation_level > 0 else "waiting"


def told(
    views: Sequence[NodeView], talked_about: set[str], result: RunResult | None = None
) -> list[dict[str, Any]]:
    """What the page's tree must show of a run."""
    return [
        {
            "node": each.node,
            "state": node_state(each, talked_about, result),
            "level": f"{each.activation_level:.2f}",
        }
        for each in views
    ]


async def told_after(state: RunState) -> list[dict[str, Any]]:
    """What the page's tree must show after the events that `state` has folded."""
    view = await RunViewing(state, state.time, [0.0] * len(state.tree), None).view()
    talked_about = {each.opened.node for each in state.open_dialogues}
    return told(view.nodes, talked_about, state.result)


async def wait_for_tree(page: Page, expected: list[dict[str, Any]]) -> None:
    """Wait until the page's tree shows what it must."""
    text = json.dumps(expected, separators=(",", ":"))
    await page.wait_for_function(f"(text) => ({SHOWN})() === text", arg=text, timeout=WAIT_MS)


def texts_in_order(events: Sequence[ev.Event]) -> list[str]:
    """What the service's transcript tells of a run, with names as people write them."""
    transcript = Transcript()
    return [line.text.replace("_", " ") for each in events for line in transcript.lines(each)]
