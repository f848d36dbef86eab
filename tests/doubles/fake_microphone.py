"""Browsers whose microphone is a sound file: flite says the words."""

import subprocess
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from bare_chromium import launch
from playwright.async_api import Browser, Playwright
from scipy.io import wavfile

RATE_HZ = 48_000
"""What browsers expect of such a file."""

LEAD_S = 1.6
"""Long enough for a console to begin to listen."""
PAUSE_S = 3.0


def utter(words: str, file: Path) -> None:
    """Write a microphone's sound: some silence, the words, and silence again."""
    # Takes long to import, and hardly any process that collects the tests needs it.
    from scipy.signal import resample_poly

    subprocess.run(["flite", "-voice", "slt", "-t", words, "-o", file], check=True)
    rate_hz, said = wavfile.read(file)
    resampled = resample_poly(said.astype(float), RATE_HZ, rate_hz)
    sound = np.pad(resampled, (round(LEAD_S * RATE_HZ), round(PAUSE_S * RATE_HZ)))
    wavfile.write(file, RATE_HZ, np.clip(sound, -32768, 32767).astype(np.int16))


@dataclass(slots=True)
class Person:
    """Who says something into the microphone of a browser each time that it is opened."""

    browser: Browser
    sound: Path
    said: str

    def will_say(self, words: str) -> None:
        """From the next time on at which the microphone is opened."""
        if words != self.said:
            utter(words, self.sound)
            self.said = words


async def launch_speaking(
    playwright: Playwright, words: str, folder: Path, *, again: bool
) -> Person:
    """Have a browser in which somebody says the words each time the microphone is opened.

    `again`: and then every few seconds.
    """
    sound = folder / "microphone.wav"
    utter(words, sound)
    browser = await launch(
        playwright,
        "--use-fake-device-for-media-stream",
        "--use-fake-ui-for-media-stream",
        f"--use-file-for-fake-audio-capture={sound}{'' if again else '%noloop'}",
        "--autoplay-policy=no-user-gesture-required",
    )
    return Person(browser, sound, words)
