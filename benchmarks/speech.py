# ruff: noqa: T201
"""How well spoken answers are understood, on synthetic voices; without a model of one's own against
a plain JSGF grammar.

The corpus is made by espeak-ng and flite, and Festival with `--drawn`. Weights and thresholds
were set on the tuned voices and the `tuned` phrases of `speech_phrases.toml` alone; what is
printed is about `HELD_OUT_VOICES` and the `held_out` phrases, of which the last ones of each
command are not in the vocabulary, and many unrelated ones are short or sound like commands, on
purpose. It says nothing about people.
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
import tomllib
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
import numpy.typing as npt
import pocketsphinx
from scipy.io import wavfile
from scipy.signal import resample_poly

from mend.server.speech.commands import Command
from mend.server.speech.decoding import Decoder, Hypothesis
from mend.server.speech.ear import ProcessEars
from mend.server.speech.fused_decoder import FusedDecoder
from mend.server.speech.language_model import COMMAND_MARK, command_in, name, write_language_model
from mend.server.speech.moonshine import Moonshine
from mend.server.speech.recognizer import Recognizer, Utterance
from mend.server.speech.speech_model import find_speech_model
from mend.server.speech.sphinx_decoder import SphinxDecoder
from mend.server.speech.vocabulary import phrase_commands
from mend.server.speech.written_evidence import WrittenEvidence

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


# --- the corpus -------------------------------------------------------------------------------


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
        self._begun = False

    def begin(self) -> None:
        if self._begun:
            self._decoder.end_utt()
        self._decoder.start_utt()
        self._begun = True

    def take(self, sound: bytes) -> None:
        self._decoder.process_raw(sound)

    def end(self) -> Hypothesis:
        self._decoder.end_utt()
        self._begun = False
        found = self._decoder.hyp()
        words = str(found.hypstr) if found is not None else ""
        command, phrase = command_in(words) or (None, None)
        # A grammar knows nothing but its phrases, and so cannot doubt them.
        return Hypothesis(words, command, phrase, margin=math.inf)


@dataclass(frozen=True, slots=True)
class Share:
    """So many of so many."""

    count: int
    of: int

    @property
    def part(self) -> float:
        return self.count / self.of if self.of else 0.0

    def __str__(self) -> str:
        """With the bounds between which the true share lies in 95 of 100 cases (Wilson)."""
        if not self.of:
            return "-"
        center = (self.part + 1.92 / self.of) / (1 + 3.84 / self.of)
        spread = math.sqrt(self.part * (1 - self.part) / self.of + 0.96 / self.of**2)
        half = 1.96 * spread / (1 + 3.84 / self.of)
        low, high = max(0.0, center - half), min(1.0, center + half)
        return f"{self.count}/{self.of} = {self.part:.1%} ({low:.1%} to {high:.1%})"


VOCABULARY = phrase_commands()


@dataclass
class Tally:
    """What came of what was said."""

    outcomes: Counter[tuple[Spoken, Command | None]]
    latencies_ms: list[float]
    cpu_s: float = 0.0
    sound_s: float = 0.0

    def of(self, *, recorded: bool) -> "Tally":
        """The part of it by recorded voices, or by those that are computed (espeak-ng's)."""
        part = Counter(
            {
                (said, heard): count
                for (said, heard), count in self.outcomes.items()
                if said.voice.startswith("espeak-ng") is not recorded
            }
        )
        return Tally(part, [])

    def accepted(self) -> Share:
        """Unrelated speech that was taken for a command."""
        unrelated = [as_ for each, as_ in self.outcomes.elements() if each.command is None]
        return Share(sum(as_ is not None for as_ in unrelated), len(unrelated))

    def flips(self) -> Share:
        """Yes that was taken for no, or the other way round."""
        answers = [
            (said.command, heard)
            for said, heard in self.outcomes.elements()
            if said.command in (Command.YES, Command.NO)
        ]
        flipped = sum(
            heard in (Command.YES, Command.NO) and heard is not said for said, heard in answers
        )
        return Share(flipped, len(answers))

    def right(self, *, known: bool) -> Share:
        """Commands that were heard as what they meant; `known` phrases are in the vocabulary."""
        commands = [
            (said, heard)
            for said, heard in self.outcomes.elements()
            if said.command is not None and (said.phrase in VOCABULARY) is known
        ]
        return Share(sum(said.command is heard for said, heard in commands), len(commands))

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
    """Let a system hear everything, each in a conversation of its own.

    Sound comes at its own pace on a clock on which nothing but the system takes time: what a
    machine would need that does nothing else.
    """
    tally = Tally(Counter(), [])
    for seed, each in enumerate(said):
        sound, ends_s = microphone(each, condition, seed)
        recognizer = Recognizer(decoder)
        heard: list[Command | None] = []
        done_s = 0.0
        for number, start in enumerate(range(0, len(sound), FRAME_BYTES), 1):
            began_s = time.process_time()
            found = list(recognizer.feed(sound[start : start + FRAME_BYTES]))
            took_s = time.process_time() - began_s
            tally.cpu_s += took_s
            done_s = max(done_s, number * FRAME_S) + took_s
            for utterance in found:
                if isinstance(utterance, Utterance):
                    heard.append(utterance.command)
                    if utterance.command is not None:
                        tally.latencies_ms.append((done_s - ends_s) * 1000)
        tally.sound_s += len(sound) / 2 / RATE_HZ
        tally.outcomes[each, next((command for command in heard if command), None)] += 1
    return tally


async def measure_latency(said: Sequence[Spoken], model: Path | None) -> list[float]:
    """Milliseconds from the end of speech to the answer, in real time through an ear's process."""
    latencies_ms = []
    ears = ProcessEars(1, model)
    ear = await ears.open()
    for seed, each in enumerate(said):
        sound, _ = microphone(each, Condition("clean"), seed)
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
    await ears.close()
    return latencies_ms


# --- what is printed --------------------------------------------------------------------------


def print_confusion(tally: Tally) -> None:
    columns: tuple[Command | None, ...] = (*Command, None)
    names = [str(each) if each else "other" for each in columns]
    print("  said \\ heard" + "".join(f"{each:>8}" for each in names))
    for said, row in zip(columns, names, strict=True):
        counts = Counter(as_ for each, as_ in tally.outcomes.elements() if each.command is said)
        print(f"  {row:>12}" + "".join(f"{counts[each]:>8}" for each in columns))


def print_rates(system: str, tally: Tally) -> None:
    print_understood(system, tally)
    for kind, recorded in (("recorded", True), ("computed", False)):
        part = tally.of(recorded=recorded)
        if part.outcomes:
            print_understood(f"  {kind} voices", part)
    print(
        f"    end of speech to command {percentiles(tally.latencies_ms)}, in processor time; "
        f"{tally.sound_s / tally.cpu_s:.0f} streams per core"
    )


def print_understood(of: str, tally: Tally) -> None:
    print(
        f"  {of}: unrelated accepted {tally.accepted()}; yes/no flips {tally.flips()}\n"
        f"    right at once: known phrases {tally.right(known=True)}, others "
        f"{tally.right(known=False)}; yes or no within 3 tries {tally.within(3):.1%}"
    )


def percentiles(latencies_ms: Sequence[float]) -> str:
    if len(latencies_ms) < 2:
        return "not measured"
    quantiles = statistics.quantiles(latencies_ms, n=20)
    return f"p50 {quantiles[9]:.0f} ms, p95 {quantiles[18]:.0f} ms over {len(latencies_ms)}"


def compare(
    ours: Decoder, peer: Decoder | None, said: Sequence[Spoken], condition: Condition, misses: bool
) -> list[float]:
    """Print how both systems do under a condition; returns our latencies."""
    heard = listen(ours, said, condition)
    print(condition)
    print_rates("Mend", heard)
    if peer is not None:
        print_rates("JSGF", listen(peer, said, condition))
    print_confusion(heard)
    if misses:
        for each, as_ in heard.outcomes:
            if as_ is not each.command:
                print(f"    {each.voice}: '{each.phrase}' -> {as_ or 'not understood'}")
    return heard.latencies_ms


def decoder_with(model: Path | None) -> Decoder:
    """What listens: PocketSphinx, alone or with an operator's model."""
    if model is None:
        return SphinxDecoder()
    return FusedDecoder(SphinxDecoder(), WrittenEvidence(Moonshine(find_speech_model(model))))


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--quick", action="store_true", help="few voices, phrases and conditions")
    parser.add_argument("--tuned", action="store_true", help="what the weights were set with")
    parser.add_argument("--new", action="store_true", help="voices chosen after all was set")
    parser.add_argument("--drawn", type=int, help="voices drawn with this seed")
    parser.add_argument("--few", action="store_true", help="half as many phrases of each voice")
    parser.add_argument("--clean", action="store_true", help="only without noise")
    parser.add_argument("--seed", type=int, default=0, help="who says which of the phrases")
    parser.add_argument("--model", type=Path, help="a folder with a speech model of one's own")
    parser.add_argument("--misses", action="store_true", help="also print what was misheard")
    arguments = parser.parse_args()
    engines = ("espeak-ng", "flite", *(["text2wave"] if arguments.drawn is not None else []))
    for engine in engines:
        if shutil.which(engine) is None:
            sys.exit(f"{engine} is not installed: the corpus is made with {', '.join(engines)}")
    part = "tuned" if arguments.tuned else "held_out"
    voices = TUNED_VOICES if arguments.tuned else HELD_OUT_VOICES
    if arguments.new:
        voices = NEW_VOICES
    if arguments.drawn is not None:
        voices = drawn_voices(arguments.drawn)
    conditions, size = CONDITIONS, FEW if arguments.few else FULL
    if arguments.quick:
        voices, conditions, size = voices[:4], (CONDITIONS[0], CONDITIONS[1], CONDITIONS[3]), QUICK
    if arguments.clean:
        conditions = CONDITIONS[:1]
    ours = decoder_with(arguments.model)
    peer = None if arguments.model else GrammarDecoder()
    latencies_ms: list[float] = []
    for seed, condition in enumerate(conditions):
        said = corpus(part, voices, size, arguments.seed + seed)
        if seed == 0:
            print(f"{len(said)} utterances of {len(voices)} voices under each condition: {part}")
        latencies_ms += compare(ours, peer, said, condition, arguments.misses)
    print(f"end of speech to command, in processor time: {percentiles(latencies_ms)}")
    answers = [each for each in said if each.command in (Command.YES, Command.NO)]
    sample = random.Random(0).sample(answers, 8 if arguments.quick or arguments.few else 40)
    real_ms = asyncio.run(measure_latency(sample, arguments.model))
    print(f"end of speech to answer, in real time on this machine: {percentiles(real_ms)}")


if __name__ == "__main__":
    main()
