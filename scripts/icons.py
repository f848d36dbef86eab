"""Draws the console's icons from `web/public/icon.svg`, as devices want them: PNG, in `icons/`."""

import asyncio
import re
import shutil
from pathlib import Path

from playwright.async_api import Page, async_playwright

PUBLIC = Path(__file__).parents[1] / "web/public"
SIZES = {"180.png": 180, "192.png": 192, "512.png": 512, "maskable.png": 512, "badge.png": 96}
FULL_BLEED = ("180.png", "maskable.png")
"""Those whose corners the device cuts off itself."""


async def draw(page: Page, name: str, size: int) -> None:
    drawing = (PUBLIC / "icon.svg").read_text()
    if name in FULL_BLEED:
        drawing = drawing.replace('rx="7"', 'rx="0"')
    if name == "badge.png":
        # Devices take its shape alone.
        drawing = re.sub(r"<rect[^>]*/>", "", drawing)
    await page.set_viewport_size({"width": size, "height": size})
    await page.set_content(
        f"<style>body{{margin:0}}svg{{display:block;width:{size}px;height:{size}px}}</style>{drawing}"
    )
    await page.screenshot(path=PUBLIC / "icons" / name, omit_background=True)


async def main() -> None:
    chromium = shutil.which("chromium") or shutil.which("google-chrome")
    async with async_playwright() as playwright:
        browser = await playwright.chromium.launch(
            executable_path=chromium, args=["--no-sandbox", "--force-device-scale-factor=1"]
        )
        page = await browser.new_page()
        for name, size in SIZES.items():
            await draw(page, name, size)
        await browser.close()


if __name__ == "__main__":
    asyncio.run(main())
