#!/usr/bin/env python3
"""Takes the console's pictures for the documentation: plays situations, and photographs each view.

`.venv/bin/python scripts/screenshots.py [NAME ...]`; without names all of them, into docs/images.
"""

# ruff: noqa: E402, T201
import asyncio
import shutil
import sys
import tempfile
from collections.abc import Awaitable, Callable
from contextlib import AsyncExitStack
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any

import cv2
import numpy as np
from playwright.async_api import Browser, Page, async_playwright, expect

ROOT = Path(__file__).parents[1]
sys.path[:0] = [str(ROOT), str(ROOT / "tests" / "doubles")]

import console_situations as situations
from console_in_browser import TOKEN, OpenPage

from mend.server.composition import Service, open_service
from mend.server.settings import Settings

IMAGES = ROOT / "docs" / "images"
MAX_BYTES = 200_000
SMALLER = 0.85
DESKTOP = {"width": 1440, "height": 900}
PHONE = {"width": 390, "height": 844}
# What comes after the first look: pictures, poses and the scene.
SETTLE_MS = 4_000


@dataclass(frozen=True, slots=True)
class Shot:
    """One picture: what is played, and how it is looked at."""

    situation: situations.Situation
    theme: str = "light"
    phone: bool = False


async def question_in_workcell(service: Service, open_page: OpenPage) -> Page:
    page = await open_page("/")
    await situations.ask(service, "workcell")
    await expect(page.get_by_role("button", name="YES")).to_be_visible(timeout=120_000)
    return page


async def run_in_workcell(service: Service, open_page: OpenPage) -> Page:
    run = await situations.ask(service, "workcell")
    page = await open_page(f"/runs/{run}")
    link = page.get_by_role("link", name="Questions 1")
    await expect(link).to_be_visible(timeout=120_000)
    return page


async def first_sign_in(_: Service, open_page: OpenPage) -> Page:
    page = await open_page("/")
    await page.context.clear_cookies()
    await page.reload()
    await expect(page.get_by_label("Token")).to_be_visible()
    return page


async def fresh_start(_: Service, open_page: OpenPage) -> Page:
    page = await open_page("/start/eket")
    await page.get_by_role("combobox", name="Scenario").select_option("eket_paper")
    return page


async def steered_run(service: Service, open_page: OpenPage) -> Page:
    page = await situations.steered_run(service, open_page)
    await page.locator(".side").evaluate("(side) => side.scrollTo(0, 0)")
    return page


SHOTS: dict[str, Shot] = {
    "console": Shot(run_in_workcell),
    "console_dark": Shot(run_in_workcell, theme="dark"),
    "question": Shot(question_in_workcell),
    "question_phone": Shot(question_in_workcell, phone=True),
    "question_phone_dark": Shot(question_in_workcell, theme="dark", phone=True),
    "waiting": Shot(situations.waiting_for_help),
    "run_finished": Shot(situations.finished_run_of_the_paper, theme="dark"),
    "steering": Shot(steered_run),
    "runs": Shot(situations.runs),
    "trees": Shot(situations.trees),
    "editor": Shot(situations.wrong_tree),
    "editor_dark": Shot(situations.wrong_tree, theme="dark"),
    "scene_editor": Shot(partial(situations.scene_out_of_reach, scene="eket")),
    "start_run": Shot(fresh_start),
    "fleet": Shot(situations.fleet),
    "settings": Shot(situations.settings),
    "sign_in": Shot(first_sign_in),
}


async def opened(
    browser: Browser, service: Service, stack: AsyncExitStack, path: str, **context_options: Any
) -> Page:
    """The console at a path, as a helper called Anna sees it."""
    context = await browser.new_context(base_url=service.url, **context_options)
    stack.push_async_callback(context.close)
    await context.request.post("/api/session", data={"token": TOKEN})
    await context.add_init_script("localStorage.setItem('mend.helper', '\"Anna\"')")
    page = await context.new_page()
    await page.goto(path)
    await page.get_by_role("status").filter(has_text="Connected").wait_for()
    return page


async def take(browser: Browser, name: str, shot: Shot) -> None:
    """Play one situation on a service and a journal of its own, and keep its picture."""
    async with AsyncExitStack() as stack:
        folder = Path(stack.enter_context(tempfile.TemporaryDirectory()))
        settings = Settings(data_dir=folder, port=0, token=TOKEN)
        service = await stack.enter_async_context(open_service(settings))
        open_page: Callable[[str], Awaitable[Page]] = partial(
            opened,
            browser,
            service,
            stack,
            viewport=PHONE if shot.phone else DESKTOP,
            device_scale_factor=2 if shot.phone else 1,
            color_scheme=shot.theme,
        )
        page = await shot.situation(service, open_page)
        await page.wait_for_timeout(SETTLE_MS)
        picture = small_enough(await page.screenshot())
    (IMAGES / f"{name}.png").write_bytes(picture)
    print(f"docs/images/{name}.png: {len(picture) / 1000:.0f} kB")


def small_enough(picture: bytes) -> bytes:
    """The picture as a PNG of at most `MAX_BYTES`, made smaller where it has to be."""
    pixels = cv2.imdecode(np.frombuffer(picture, np.uint8), cv2.IMREAD_COLOR)
    while True:
        _, encoded = cv2.imencode(".png", pixels, [cv2.IMWRITE_PNG_COMPRESSION, 9])
        if len(encoded) <= MAX_BYTES:
            return bytes(encoded)
        pixels = cv2.resize(pixels, None, fx=SMALLER, fy=SMALLER, interpolation=cv2.INTER_AREA)


async def main(names: list[str]) -> None:
    unknown = set(names) - SHOTS.keys()
    if unknown:
        sys.exit(f"there is no picture '{sorted(unknown)[0]}'; there are {', '.join(SHOTS)}")
    chromium = shutil.which("chromium") or shutil.which("google-chrome")
    if chromium is None:
        sys.exit("there is no Chromium on this machine, and pictures need one")
    IMAGES.mkdir(exist_ok=True)
    async with async_playwright() as playwright:
        browser = await playwright.chromium.launch(
            executable_path=chromium, headless=True, args=["--no-sandbox"]
        )
        for name in names or SHOTS:
            await take(browser, name, SHOTS[name])
        await browser.close()


if __name__ == "__main__":
    asyncio.run(main(sys.argv[1:]))
