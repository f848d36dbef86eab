"""What axe finds on a page of the console."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from playwright.async_api import Page

AXE = Path(__file__).parents[2] / "web/node_modules/axe-core/axe.min.js"
WCAG = {"type": "tag", "values": ["wcag2a", "wcag2aa", "wcag21a", "wcag21aa", "wcag22aa"]}


async def load_axe(page: Page) -> None:
    # As from a debugger: the page's own policy lets no other script in.
    await page.evaluate(AXE.read_text("utf-8"))


async def violations(page: Page, only: Mapping[str, Any]) -> list[str]:
    """What axe finds against WCAG on a page as it is shown now."""
    found: list[dict[str, Any]] = await page.evaluate(
        "async (only) => (await axe.run({runOnly: only, resultTypes: ['violations']})).violations",
        only,
    )
    return [
        f"{each['id']}: {node['target']} {node['failureSummary']}"
        for each in found
        for node in each["nodes"]
    ]
