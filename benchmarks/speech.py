# ruff: noqa: T201
"""How well spoken answers are understood, on synthetic voices, against a plain JSGF grammar.

The corpus is made by espeak-ng and flite. The weights were set on `TUNED_VOICES` alone; what is
printed is about `HELD_OUT_VOICES`, and about phrases of which the last of each command are not in
the vocabulary. It says nothing about people.
"""

import argparse
import asyncio
import hashlib
import math
import random
import shutil
import statistics
import subprocess
import sys
import time
from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
import numpy.typing as npt
import pocketsphinx
from scipy.io import wavfile
from scipy.signal import resample_poly

from server.speech.commands import Command, phrase_commands
from server.speech.ear import ProcessEars
from server.speech.language_model import COMMAND_MARK, name, write_language_model
from server.speech.recognizer import Decoder, Recognizer, SphinxDecoder, Utterance

CACHE = Path("out/speech")
RATE_HZ = 16_000
FRAME_BYTES = 640

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

SPOKEN: dict[Command, tuple[str, ...]] = {
    Command.YES: (
        "yes", "yeah", "yes please", "okay", "sure", "yep", "go ahead", "of course", "yes i will",
        "all right", "absolutely", "yes thank you", "yes you can do that",
    ),
    Command.NO: (
        "no", "nope", "no thanks", "no thank you", "not now", "no i can't", "don't do it",
        "no don't", "no sorry", "i don't think so", "no way", "no not today",
        "no that is not right",
    ),
    Command.REPEAT: (
        "repeat", "say that again", "pardon", "what did you say", "can you repeat that please",
        "say it one more time for me",
    ),
    Command.HELP: (
        "help", "help me", "what can i say", "what does that mean", "i don't understand",
        "give me some help with this",
    ),
    Command.STOP: (
        "stop", "stop the robot", "please stop", "stop now", "pause", "stop what you are doing",
    ),
}  # fmt: skip
"""The last of each is not in the vocabulary."""

UNRELATED = (
    "the meeting is on the third floor", "the weather is nice today", "have you seen my keys",
    "can you pass me the salt", "i will be there in five minutes", "we need more coffee",
    "what time is it", "i think the printer is broken", "call me when you arrive",
    "the yellow one is better", "nobody knows what happened", "he bought a new car",
    "we should go for lunch", "did you finish the report", "the train was late again",
    "turn off the lights", "my phone is ringing", "that movie was really good",
    "open the window please", "put it over there", "the box is too heavy", "one two three four",
    "hello", "maybe", "good morning everyone", "i don't know", "yesterday", "snow is falling",
    "where are you going", "nice to meet you", "i left it on the kitchen table", "wait a minute",
    "this song is great", "she is on holiday until monday", "let me think about it",
)  # fmt: skip

Sound = npt.NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class Spoken:
    """One phrase by one voice; `command` None for unrelated speech."""

    voice: str
    phrase: str
    command: Command | None


@dataclass(frozen=True, slots=True)
class Condition:
    """What else is to be heard."""

    noise: str
    snr_db: float = math.inf

    def __str__(self) -> str:
        return self.noise if math.isinf(self.snr_db) else f"{self.noise} {self.snr_db:g} dB"


CONDITIONS = (
    Condition("clean"), Condition("pink", 20), Condition("motor", 20), Condition("pink", 10),
    Condition("motor", 10), Condition("babble", 10),
)  # fmt: skip


# --- the corpus -------------------------------------------------------------------------------


def render(voice: str, phrase: str) -> Sound:
    """A phrase by a voice, kept on disk; peaks at a third of full scale."""
    path = CACHE / (hashlib.sha256(f"{voice}|{phrase}".encode()).hexdigest()[:24] + ".wav")
    if not path.exists():
        CACHE.mkdir(parents=True, exist_ok=True)
        engine, which, *speed = voice.split(":")
        arguments = (
            ["-v", which, "-s", speed[0], "-w", str(path), phrase]
            if engine == "espeak-ng"
            else ["-voice", which, "-t", phrase, "-o", str(path)]
        )
        subprocess.run([engine, *arguments], check=True, stdout=subprocess.DEVNULL)
    rate_hz, samples = wavfile.read(path)
    common = math.gcd(rate_hz, RATE_HZ)
    sound: Sound = resample_poly(samples.astype(float), RATE_HZ // common, rate_hz // common)
    return sound / np.abs(sound).max() * 32768 / 3


def corpus(voices: Sequence[str], phrases: int, unrelated: int) -> list[Spoken]:
    """What is said by whom; every voice says other unrelated things."""
    said = []
    for number, voice in enumerate(voices):
        for command, known in SPOKEN.items():
            share = phrases if command in (Command.YES, Command.NO) else (phrases + 1) // 2
            chosen = known if share >= len(known) else (*known[: share - 1], known[-1])
            said.extend(Spoken(voice, phrase, command) for phrase in chosen)
        others = random.Random(number).sample(UNRELATED, min(unrelated, len(UNRELATED)))
        said.extend(Spoken(voice, phrase, None) for phrase in others)
    return said


def noise_of(kind: str, length: int, generator: np.random.Generator) -> Sound:
    """Noise of standard deviation 1."""
    if kind == "babble":
        noise = np.zeros(length)
        for voice in generator.choice(TUNED_VOICES, 4):
            talk = np.concatenate([render(voice, each) for each in generator.choice(UNRELATED, 4)])
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


def microphone(said: Spoken, condition: Condition, seed: int) -> bytes:
    """What a microphone sends: a second of the room before it, another after it."""
    speech = render(said.voice, said.phrase)
    sound = np.concatenate([np.zeros(RATE_HZ), speech, np.zeros(RATE_HZ)])
    if not math.isinf(condition.snr_db):
        power = float(np.mean(speech[np.abs(speech) > 200] ** 2))
        noise = noise_of(condition.noise, len(sound), np.random.default_rng(seed))
        sound += noise * math.sqrt(power) * 10 ** (-condition.snr_db / 20)
    return np.clip(sound, -32768, 32767).astype(np.int16).tobytes()


# --- the systems ------------------------------------------------------------------------------


class GrammarDecoder:
    """The peer: a JSGF grammar of the same phrases, which has to choose one of them."""

    def __init__(self) -> None:
        model = Path(pocketsphinx.get_model_path("en-us"))
        with TemporaryDirectory() as folder:
            dictionary, _ = write_language_model(Path(folder), model / "cmudict-en-us.dict")
            self._decoder = pocketsphinx.Decoder(
                hmm=str(model / "en-us"), dict=str(dictionary), lm=None, loglevel="FATAL"
            )
        words = " | ".join(COMMAND_MARK + name(each) for each in phrase_commands())
        grammar = f"#JSGF V1.0;\ngrammar commands;\npublic <command> = {words};\n"
        self._decoder.add_jsgf_string("commands", grammar)
        self._decoder.activate_search("commands")

    def decode(self, sound: bytes) -> str:
        self._decoder.start_utt()
        for start in range(0, len(sound), FRAME_BYTES):
            self._decoder.process_raw(sound[start : start + FRAME_BYTES])
        self._decoder.end_utt()
        found = self._decoder.hyp()
        return str(found.hypstr) if found is not None else ""


@dataclass
class Tally:
    """What came of what was said."""

    outcomes: Counter[tuple[Spoken, Command | None]]
    cpu_s: float = 0.0
    sound_s: float = 0.0

    def rate(self, said: Command | None, heard: Command | None) -> float:
        """The share of what meant `said` that was taken for `heard`."""
        of = [(each, as_) for each, as_ in self.outcomes.elements() if each.command is said]
        return sum(as_ is heard for _, as_ in of) / len(of)

    @property
    def accepted(self) -> float:
        """The share of unrelated speech that was taken for a command."""
        return 1.0 - self.rate(None, None)

    @property
    def flips(self) -> tuple[int, int]:
        """How many yes were taken for no or the other way round, of how many."""
        answers = [
            (said.command, heard)
            for said, heard in self.outcomes.elements()
            if said.command in (Command.YES, Command.NO)
        ]
        flipped = sum(
            heard in (Command.YES, Command.NO) and heard is not said for said, heard in answers
        )
        return flipped, len(answers)

    def right(self) -> float:
        """The share of commands that were heard as what they meant."""
        commands = [each for each in self.outcomes.elements() if each[0].command is not None]
        return sum(said.command is heard for said, heard in commands) / len(commands)

    def within(self, tries: int) -> float:
        """The share of answers given by voice, where a try that is not understood is repeated.

        Exact for phrases drawn at random: each voice means each of yes and no equally often.
        """
        shares = []
        for voice in {said.voice for said, _ in self.outcomes}:
            for command in (Command.YES, Command.NO):
                heard = [
                    as_
                    for said, as_ in self.outcomes.elements()
                    if said.voice == voice and said.command is command
                ]
                right = sum(as_ is command for as_ in heard) / len(heard)
                again = sum(as_ not in (Command.YES, Command.NO) for as_ in heard) / len(heard)
                shares.append(right * sum(again**number for number in range(tries)))
        return statistics.mean(shares)


def listen(decoder: Decoder, said: Sequence[Spoken], condition: Condition) -> Tally:
    """Let a system hear everything, each in a conversation of its own."""
    tally = Tally(Counter())
    for seed, each in enumerate(said):
        sound = microphone(each, condition, seed)
        recognizer = Recognizer(decoder)
        began_s = time.process_time()
        heard = [
            utterance.command
            for start in range(0, len(sound), FRAME_BYTES)
            for utterance in recognizer.feed(sound[start : start + FRAME_BYTES])
            if isinstance(utterance, Utterance)
        ]
        tally.cpu_s += time.process_time() - began_s
        tally.sound_s += len(sound) / 2 / RATE_HZ
        tally.outcomes[each, next((command for command in heard if command), None)] += 1
    return tally


async def measure_latency(said: Sequence[Spoken]) -> list[float]:
    """Milliseconds from the end of speech to the answer, in real time through an ear's process."""
    latencies_ms = []
    ear = await ProcessEars(1).open()
    for seed, each in enumerate(said):
        sound = microphone(each, Condition("clean"), seed)
        report = asyncio.create_task(ear.report())
        began_s = time.monotonic()
        for start in range(0, len(sound), FRAME_BYTES):
            ear.hear(sound[start : start + FRAME_BYTES])
            await asyncio.sleep(max(0.0, began_s + start / 2 / RATE_HZ - time.monotonic()))
            if report.done():
                if report.result().kind == "utterance":
                    latencies_ms.append(report.result().latency_s * 1000)
                report = asyncio.create_task(ear.report())
        report.cancel()
        ear.interrupt()
        await asyncio.gather(report, return_exceptions=True)
    await ear.close()
    return latencies_ms


# --- what is printed --------------------------------------------------------------------------


def print_confusion(tally: Tally) -> None:
    columns: tuple[Command | None, ...] = (*Command, None)
    names = [str(each) if each else "other" for each in columns]
    print("  said \\ heard" + "".join(f"{each:>8}" for each in names))
    for said, row in zip(columns, names, strict=True):
        counts = Counter(as_ for each, as_ in tally.outcomes.elements() if each.command is said)
        print(f"  {row:>12}" + "".join(f"{counts[each]:>8}" for each in columns))


def lines(system: str, tally: Tally) -> Iterator[str]:
    flipped, answers = tally.flips
    yield (
        f"  {system:<10} command right {tally.right():6.1%}   unrelated accepted "
        f"{tally.accepted:6.1%}   yes/no flips {flipped}/{answers}   "
        f"answered within 3 tries {tally.within(3):6.1%}   "
        f"streams per core {tally.sound_s / tally.cpu_s:.0f}"
    )


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--quick", action="store_true", help="few voices, phrases and conditions")
    parser.add_argument("--tuned", action="store_true", help="the voices that were tuned on")
    parser.add_argument("--misses", action="store_true", help="also print what was misheard")
    arguments = parser.parse_args()
    for engine in ("espeak-ng", "flite"):
        if shutil.which(engine) is None:
            sys.exit(f"{engine} is not installed: the corpus is made with espeak-ng and flite")
    voices = TUNED_VOICES if arguments.tuned else HELD_OUT_VOICES
    conditions = (CONDITIONS[0], CONDITIONS[1], CONDITIONS[3]) if arguments.quick else CONDITIONS
    said = corpus(voices[:4], 5, 8) if arguments.quick else corpus(voices, 13, 20)
    which = "tuned" if arguments.tuned else "held-out"
    print(f"{len(said)} utterances of {len({each.voice for each in said})} {which} voices")
    ours, peer = SphinxDecoder(), GrammarDecoder()
    for condition in conditions:
        heard, chosen = listen(ours, said, condition), listen(peer, said, condition)
        print(condition)
        for line in (*lines("Mend", heard), *lines("JSGF", chosen)):
            print(line)
        print_confusion(heard)
        if arguments.misses:
            for each, as_ in heard.outcomes:
                if as_ is not each.command:
                    print(f"    {each.voice}: '{each.phrase}' -> {as_ or 'not understood'}")
        if not heard.accepted:
            print("  ratio of unrelated speech accepted: none against the grammar's")
        else:
            print(f"  ratio of unrelated speech accepted: {chosen.accepted / heard.accepted:.1f}")
    answers = [each for each in said if each.command in (Command.YES, Command.NO)]
    sample = random.Random(0).sample(answers, 8 if arguments.quick else 40)
    latencies_ms = asyncio.run(measure_latency(sample))
    quantiles = statistics.quantiles(latencies_ms, n=20)
    print(
        f"end of speech to answer, in real time: p50 {quantiles[9]:.0f} ms, "
        f"p95 {quantiles[18]:.0f} ms over {len(latencies_ms)}"
    )


if __name__ == "__main__":
    main()
