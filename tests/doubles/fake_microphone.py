"""Browsers whose microphone is a sound file: flite says the words."""

import subprocess
from pathlib import Path
from shutil import which

from playwright.async_api import Browser, Playwright

LEAD_S = 1.2
"""Long enough for a console to begin to listen."""
PAUSE_S = 3.0


def utter(words: str, folder: Path) -> Path:
    """A microphone's sound: some silence, the words, and silence again."""
    name = words.replace(" ", "_")
    said, file = folder / f"{name}.said.wav", folder / f"{name}.wav"
    subprocess.run(["flite", "-voice", "slt", "-t", words, "-o", said], check=True)
    subprocess.run(
        ["sox", said, "-r", "48000", "-b", "16", file, "pad", str(LEAD_S), str(PAUSE_S)],
        check=True,
    )
    return file


async def launch_speaking(
    playwright: Playwright, words: str, folder: Path, *, again: bool
) -> Browser:
    """A browser in which somebody says the words each time the microphone is opened.

    `again`: and then every few seconds.
    """
    sound = f"{utter(words, folder)}{'' if again else '%noloop'}"
    return await playwright.chromium.launch(
        executable_path=which("chromium") or which("google-chrome"),
        headless=True,
        args=[
            "--no-sandbox",
            "--use-fake-device-for-media-stream",
            "--use-fake-ui-for-media-stream",
            f"--use-file-for-fake-audio-capture={sound}",
            "--autoplay-policy=no-user-gesture-required",
        ],
    )
