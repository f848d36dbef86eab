# ruff: noqa: T201
"""How smoothly the console's 3-D scene is drawn: pictures per second in a browser without a GPU.

The scene is drawn from the poses of a running tabletop world; the naive way, one picture for each
frame of poses that comes, is counted in the same run.
"""

import argparse
import asyncio
import shutil
import tempfile
from pathlib import Path
from typing import TypedDict

from playwright.async_api import async_playwright

from mend.server.composition import open_service
from mend.server.runtime.requests import RunRequest
from mend.server.settings import Settings

# Counts from outside: a picture is an animation frame in which the scene was drawn.
COUNT = """
window.counted = {pictures: 0, frames: 0, drawn: false};
const draw = WebGL2RenderingContext.prototype.drawElements;
WebGL2RenderingContext.prototype.drawElements = function (...given) {
  window.counted.drawn = true;
  return draw.apply(this, given);
};
const tick = () => {
  if (window.counted.drawn) window.counted.pictures += 1;
  window.counted.drawn = false;
  requestAnimationFrame(tick);
};
requestAnimationFrame(tick);
window.WebSocket = class extends WebSocket {
  constructor(...given) {
    super(...given);
    this.addEventListener('message', ({data}) => {
      if (data instanceof ArrayBuffer) window.counted.frames += 1;
    });
  }
};
"""

MEASURE = """async (seconds) => {
  const before = {...window.counted};
  const start = performance.now();
  await new Promise((done) => setTimeout(done, 1000 * seconds));
  const passed = (performance.now() - start) / 1000;
  return {
    pictures: (window.counted.pictures - before.pictures) / passed,
    frames: (window.counted.frames - before.frames) / passed,
  };
}"""


class Rates(TypedDict):
    """Per second."""

    pictures: float
    frames: float


async def measure(world: str, seconds: float) -> Rates:
    """Open the run view of a new run and count."""
    with tempfile.TemporaryDirectory() as folder:
        settings = Settings(data_dir=Path(folder), port=0)
        async with open_service(settings) as service, async_playwright() as playwright:
            browser = await playwright.chromium.launch(
                executable_path=shutil.which("chromium") or shutil.which("google-chrome"),
                headless=True,
                args=["--no-sandbox"],
            )
            run = await service.runtime.start_run(RunRequest(tree="eket", world=world))
            page = await browser.new_page(
                base_url=service.url, viewport={"width": 1440, "height": 900}
            )
            await page.add_init_script("localStorage.setItem('mend.helper', '\"bench\"')")
            await page.add_init_script(COUNT)
            await page.goto(f"/runs/{run.id}")
            canvas = page.locator("canvas.scene-canvas[data-drawn=true]")
            await canvas.wait_for(timeout=120_000)
            await canvas.scroll_into_view_if_needed()
            rates: Rates = await page.evaluate(MEASURE, seconds)
            await browser.close()
            return rates


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--quick", action="store_true", help="three seconds instead of fifteen")
    parser.add_argument("--world", default="tabletop", choices=["tabletop", "workcell"])
    options = parser.parse_args()
    rates = asyncio.run(measure(options.world, 3.0 if options.quick else 15.0))
    pictures, frames = rates["pictures"], rates["frames"]
    print(f"frames of poses that came:   {frames:5.1f} per second")
    print(f"pictures of the scene drawn: {pictures:5.1f} per second (wanted: 30)")
    if frames > 0:
        print(f"ratio to a picture for each frame: {pictures / frames:.2f}")


if __name__ == "__main__":
    main()
