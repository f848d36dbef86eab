"""A Chromium without a window, which begins none of the pages of its own around ours."""

import shutil
from collections.abc import Sequence

from playwright.async_api import Browser, Playwright

WHOLE = shutil.which("chromium") or shutil.which("google-chrome")
CHROMIUM = shutil.which("chromium-headless-shell") or WHOLE
"""The shell has no window to leave out: it opens a page for two thirds of what the whole one takes.

It has no notifications.
"""

# For each page of ours it would draw the list under a location bar that nobody sees, and hold
# another process ready: more work than our page itself.
UNSEEN = ("WebUIOmniboxPopup", "WebUIOmniboxAimPopup", "SpareRendererForSitePerProcess")
# The shell ends a page that may ask for it, as it has nothing behind it.
NOTHING_BEHIND = ("OnDeviceWebSpeechAvailable",)
# Of several lists only the last one counts: these Playwright itself switches off on Linux.
SWITCHED_OFF = (
    "AvoidUnnecessaryBeforeUnloadCheckSync",
    "DestroyProfileOnBrowserClose",
    "HttpsUpgrades",
    "HttpsFirstBalancedModeAutoEnable",
    "LensOverlay",
    "MediaRouter",
    "PaintHolding",
    "ThirdPartyStoragePartitioning",
    "AvoidCorsURLLoaderRestartOnRedirect",
    "OptimizationHints",
    "NetworkTimeServiceQuerying",
    "AimEnabled",
    "PreconnectToSearch",
)


async def launch(playwright: Playwright, *arguments: str) -> Browser:
    return await _launch(playwright, CHROMIUM, arguments)


async def launch_whole(playwright: Playwright) -> Browser:
    """One that shows notifications."""
    return await _launch(playwright, WHOLE, ())


async def _launch(playwright: Playwright, program: str | None, arguments: Sequence[str]) -> Browser:
    off = ",".join((*SWITCHED_OFF, *UNSEEN, *NOTHING_BEHIND))
    return await playwright.chromium.launch(
        executable_path=program,
        headless=True,
        args=["--no-sandbox", f"--disable-features={off}", *arguments],
    )
