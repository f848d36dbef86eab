"""What is said in the benchmarks of speech, by which voices, and what a microphone makes of it.

Made by espeak-ng and flite, and Festival for voices that are drawn. Weights and thresholds are set
on `TUNED_VOICES` (and `MORE_TUNED_VOICES`) and the `tuned` phrases of `speech_phrases.toml` alone.
"""

import hashlib
import math
import random
import subprocess
import tomllib
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import numpy.typing as npt
from scipy.io import wavfile
from scipy.signal import resample_poly

from mend.server.speech.commands import Command

CACHE = Path("out/speech")
PHRASES = tomllib.loads(Path(__file__).with_name("speech_phrases.toml").read_text())
RATE_HZ = 16_000
FRAME_BYTES = 640
FRAME_S = 0.02
AUDIBLE = 200
"""Of 32768: what is fainter is no voice."""

TUNED_VOICES = (
    "espeak-ng:en-us+m3:150", "espeak-ng:en-gb+f2:170", "espeak-ng:en-us+f4:160",
    "espeak-ng:en-gb-x-rp+m5:160", "flite:slt", "flite:rms",
)  # fmt: skip
HELD_OUT_VOICES = (
    "flite:awb", "espeak-ng:en-us:165", "flite:kal16", "espeak-ng:en-us+f1:160",
    "espeak-ng:en-gb:165", "espeak-ng:en-us+m7:170", "espeak-ng:en-gb-scotland+f3:160",
    "espeak-ng:en-us+linda:150", "espeak-ng:en-gb-x-gbcwmd:160", "espeak-ng:en-us+m1:150",
    "espeak-ng:en-us-nyc:160", "flite:kal",
)  # fmt: skip

NEW_VOICES = (
    "espeak-ng:en-us+belinda:165", "espeak-ng:en-gb+m4:155", "espeak-ng:en-us+f5:150",
    "espeak-ng:en-us+paul:160", "espeak-ng:en-us+anika:160", "espeak-ng:en-029:155",
    "espeak-ng:en-gb-x-gbclan+f4:165", "espeak-ng:en-us+m2:140", "espeak-ng:en-gb+benjamin:160",
    "espeak-ng:en-us+steph3:165",
)  # fmt: skip

MORE_TUNED_VOICES = (
    "espeak-ng:en-us+Alex:160", "espeak-ng:en-gb+Andrea:155", "espeak-ng:en-us+m8:165",
    "espeak-ng:en-us+Michael:150", "espeak-ng:en-gb-x-gbclan+m3:160", "espeak-ng:en-us+steph:160",
)  # fmt: skip
"""With these and `TUNED_VOICES` the weights were set of PocketSphinx and a model together."""

ACCENTS = (
    "en-us", "en-gb", "en-gb-scotland", "en-gb-x-gbclan", "en-gb-x-rp", "en-gb-x-gbcwmd", "en-029",
    "en-us-nyc",
)  # fmt: skip
VARIANTS = (
    "Alicia", "Andy", "Annie", "Diogo", "Gene", "Henrique", "Hugo", "Jacky", "Lee", "Marco",
    "Mario", "Mike", "adam", "antonio", "aunty", "boris", "caleb", "david", "ed", "edward",
    "grandma", "grandpa", "gustave", "john", "marcelo", "max", "michel", "miguel", "norbert",
    "pablo", "pedro", "quincy", "rob", "robert", "sandro", "shelby", "steph2", "travis", "victor",
    "zac",
)  # fmt: skip
"""People's voices of espeak-ng that are in none of the lists above."""

Sound = npt.NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class Spoken:
    """One phrase by one voice; `command` None for unrelated speech."""

    voice: str
    phrase: str
    command: Command | None


@dataclass(frozen=True, slots=True)
class Size:
    """How many phrases each voice says under each condition; `answers` of yes and of no each."""

    answers: int
    others: int
    unrelated: int


QUICK, FEW, FULL = Size(5, 1, 10), Size(6, 2, 16), Size(12, 4, 40)


@dataclass(frozen=True, slots=True)
class Condition:
    """What else is to be heard."""

    noise: str
    snr_db: float = math.inf

    def __str__(self) -> str:
        return self.noise if math.isinf(self.snr_db) else f"{self.noise} {self.snr_db:g} dB"


CONDITIONS: tuple[Condition, ...] = (
    Condition("clean"), Condition("pink", 20), Condition("motor", 20), Condition("pink", 10),
    Condition("motor", 10), Condition("babble", 10),
)  # fmt: skip


def drawn_voices(seed: int) -> tuple[str, ...]:
    """Voices that nobody has chosen: with speeds and pitches that are drawn as well.

    Eight are espeak-ng's, each with an accent of its own; of the recorded ones three are flite's
    held-out ones, spoken otherwise, and one is Festival's.
    """
    drawn = random.Random(seed)
    formant = [
        f"espeak-ng:{accent}+{variant}:{drawn.randint(140, 180)}:{drawn.randint(30, 70)}"
        for accent, variant in zip(ACCENTS, drawn.sample(VARIANTS, len(ACCENTS)), strict=True)
    ]
    recorded = [
        f"flite:{voice}:{drawn.uniform(0.9, 1.2):.2f}:{drawn.uniform(0.85, 1.2):.2f}"
        for voice in ("awb", "kal16", "kal")
    ]
    return (*formant, *recorded, "festival:ked_diphone")


def speaker(voice: str, phrase: str, path: Path) -> list[str]:
    """The command that has a voice say a phrase, into a file."""
    engine, which, *manner = voice.split(":")
    if engine == "festival":
        text = path.with_suffix(".txt")
        text.write_text(phrase)
        return ["text2wave", "-eval", f"(voice_{which})", "-o", str(path), str(text)]
    if engine == "espeak-ng":
        pitch = ["-p", manner[1]] if len(manner) > 1 else []
        return [engine, "-v", which, "-s", manner[0], *pitch, "-w", str(path), phrase]
    features = zip(("duration_stretch", "f0_shift"), manner, strict=False)
    spoken = [each for name, value in features for each in ("--setf", f"{name}={value}")]
    return [engine, "-voice", which, *spoken, "-t", phrase, "-o", str(path)]


def render(voice: str, phrase: str) -> Sound:
    """A phrase by a voice, kept on disk; peaks at a third of full scale."""
    path = CACHE / (hashlib.sha256(f"{voice}|{phrase}".encode()).hexdigest()[:24] + ".wav")
    if not path.exists():
        CACHE.mkdir(parents=True, exist_ok=True)
        subprocess.run(speaker(voice, phrase, path), check=True, stdout=subprocess.DEVNULL)
    rate_hz, samples = wavfile.read(path)
    common = math.gcd(rate_hz, RATE_HZ)
    sound: Sound = resample_poly(samples.astype(float), RATE_HZ // common, rate_hz // common)
    return sound / np.abs(sound).max() * 32768 / 3


def corpus(part: str, voices: Sequence[str], size: Size, seed: int) -> list[Spoken]:
    """What is said by whom: every voice says its own choice of the phrases."""
    said: list[Spoken] = []
    for voice in voices:
        chosen = random.Random(f"{voice} {seed}")
        for command in map(Command, PHRASES[part]["commands"]):
            known = PHRASES[part]["commands"][command]
            count = size.answers if command in (Command.YES, Command.NO) else size.others
            phrases = chosen.sample(known, min(count, len(known)))
            said.extend(Spoken(voice, phrase, command) for phrase in phrases)
        for unrelated in PHRASES[part]["unrelated"].values():
            phrases = chosen.sample(unrelated, min(size.unrelated // 2, len(unrelated)))
            said.extend(Spoken(voice, phrase, None) for phrase in phrases)
    return said


def noise_of(kind: str, length: int, generator: np.random.Generator) -> Sound:
    """Noise of standard deviation 1."""
    if kind == "babble":
        noise = np.zeros(length)
        for voice in generator.choice(TUNED_VOICES, 4):
            talk = np.concatenate(
                [
                    render(voice, each)
                    for each in generator.choice(PHRASES["tuned"]["unrelated"]["long"], 4)
                ]
            )
            noise += np.resize(np.roll(talk, int(generator.integers(len(talk)))), length)
    else:
        frequency = np.fft.rfftfreq(length, 1 / RATE_HZ)
        spectrum = generator.normal(size=(2, len(frequency))).T @ np.array([1, 1j])
        slope = np.sqrt(np.maximum(frequency, 20)) if kind == "pink" else np.maximum(frequency, 100)
        noise = np.fft.irfft(spectrum / slope, length)
        noise /= noise.std()
        if kind == "motor":
            seconds = np.arange(length) / RATE_HZ
            for harmonic in range(1, 12):
                phase = generator.uniform(0, 2 * math.pi)
                noise += 0.6 / harmonic * np.sin(2 * math.pi * 97 * harmonic * seconds + phase)
    scaled: Sound = noise / noise.std()
    return scaled


def microphone(said: Spoken, condition: Condition, seed: int) -> tuple[bytes, float]:
    """What a microphone sends: a second of the room before it, another after it.

    Also when the voice ends, in seconds.
    """
    speech = render(said.voice, said.phrase)
    audible = np.abs(speech) > AUDIBLE
    sound = np.concatenate([np.zeros(RATE_HZ), speech, np.zeros(RATE_HZ)])
    if not math.isinf(condition.snr_db):
        power = float(np.mean(speech[audible] ** 2))
        noise = noise_of(condition.noise, len(sound), np.random.default_rng(seed))
        sound += noise * math.sqrt(power) * 10 ** (-condition.snr_db / 20)
    ends_s = 1.0 + float(np.flatnonzero(audible)[-1]) / RATE_HZ
    return np.clip(sound, -32768, 32767).astype(np.int16).tobytes(), ends_s
