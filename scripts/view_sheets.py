#!/usr/bin/env python3
"""Takes a sheet of every view and state of the console: what it looks like at four sizes.

`.venv/bin/python scripts/view_sheets.py [NAME ...]`; without names all of them, into
docs/images/views, and docs/views.md, which shows them.
"""

# ruff: noqa: E402, T201
import asyncio
import sys
import tempfile
from collections.abc import Iterable, Sequence
from contextlib import AsyncExitStack
from functools import partial
from pathlib import Path

import cv2
import numpy as np
from numpy.typing import NDArray
from playwright.async_api import Browser, Page, ViewportSize, async_playwright

ROOT = Path(__file__).parents[1]
sys.path[:0] = [str(ROOT), str(ROOT / "tests" / "doubles")]

from bare_chromium import CHROMIUM, launch
from console_in_browser import TOKEN
from console_situations import SITUATIONS, Situation
from screenshots import opened

from mend.server.composition import open_service
from mend.server.settings import Settings

SHEETS = ROOT / "docs" / "images" / "views"
PAGE = ROOT / "docs" / "views.md"
SIZES = (
    ViewportSize(width=1440, height=900),
    ViewportSize(width=1024, height=768),
    ViewportSize(width=768, height=1024),
    ViewportSize(width=390, height=844),
)
"""A desk, a tablet both ways, a phone."""
SHOWN_AT = 0.5
GAP_PX = 12
BACKGROUND = 160
QUALITY = 70
# What comes after a change of size: pictures, and the scene in 3-D.
SETTLE_MS = 2_500

HEAD = """# Every view

What the console looks like in every view and state at 1440 x 900, 1024 x 768, 768 x 1024 and
390 x 844 px, taken by `make screenshots` of situations that are really played. The same ones are
looked through by axe, and for words that overlap, at 400 % too (`tests/e2e/test_every_view.py`).
"""

Pixels = NDArray[np.uint8]


async def sheet_of(browser: Browser, situation: Situation) -> Pixels:
    """Play a situation on a service of its own, and photograph it at every size."""
    async with AsyncExitStack() as stack:
        folder = Path(stack.enter_context(tempfile.TemporaryDirectory()))
        settings = Settings(
            data_dir=folder, port=0, token=TOKEN, speech_voice="none", log_level="warning"
        )
        service = await stack.enter_async_context(open_service(settings))

        open_page = partial(opened, browser, service, stack, viewport=SIZES[0])
        page = await situation(service, open_page)
        return beside_each_other([await photograph(page, size) for size in SIZES])


async def photograph(page: Page, size: ViewportSize) -> Pixels:
    await page.set_viewport_size(size)
    await page.wait_for_timeout(SETTLE_MS)
    taken = np.frombuffer(await page.screenshot(), np.uint8)
    whole = cv2.imdecode(taken, cv2.IMREAD_COLOR)
    shown = cv2.resize(whole, None, fx=SHOWN_AT, fy=SHOWN_AT, interpolation=cv2.INTER_AREA)
    return np.asarray(shown, np.uint8)


def beside_each_other(pictures: Sequence[Pixels]) -> Pixels:
    """One picture of several, whose upper edges are in line."""
    height = max(each.shape[0] for each in pictures) + 2 * GAP_PX
    width = sum(each.shape[1] + GAP_PX for each in pictures) + GAP_PX
    sheet = np.full((height, width, 3), BACKGROUND, np.uint8)
    left = GAP_PX
    for each in pictures:
        sheet[GAP_PX : GAP_PX + each.shape[0], left : left + each.shape[1]] = each
        left += each.shape[1] + GAP_PX
    return sheet


def page_of(names: Iterable[str]) -> str:
    """The page of the documentation that shows the sheets."""
    shown = []
    for name in names:
        words = name.replace("_", " ").capitalize()
        shown.append(f"\n## {words}\n\n![{words}, at four sizes](images/views/{name}.webp)\n")
    return HEAD + "".join(shown)


async def main(names: list[str]) -> None:
    unknown = set(names) - SITUATIONS.keys()
    if unknown:
        sys.exit(f"there is no view '{sorted(unknown)[0]}'; there are {', '.join(SITUATIONS)}")
    if CHROMIUM is None:
        sys.exit("there is no Chromium on this machine, and pictures need one")
    SHEETS.mkdir(parents=True, exist_ok=True)
    async with async_playwright() as playwright:
        browser = await launch(playwright)
        for name in names or SITUATIONS:
            sheet = await sheet_of(browser, SITUATIONS[name])
            _, encoded = cv2.imencode(".webp", sheet, [cv2.IMWRITE_WEBP_QUALITY, QUALITY])
            (SHEETS / f"{name}.webp").write_bytes(encoded.tobytes())
            print(f"docs/images/views/{name}.webp: {len(encoded) / 1000:.0f} kB")
        await browser.close()
    PAGE.write_text(page_of(SITUATIONS))


if __name__ == "__main__":
    asyncio.run(main(sys.argv[1:]))
