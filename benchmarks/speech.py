# ruff: noqa: T201
"""How well spoken answers are understood, on synthetic voices, against a peer that hears the same:
a plain JSGF grammar, or with a model of one's own (`--model`) PocketSphinx alone.

What is said is made by `speech_corpus.py`. Printed is what comes of `HELD_OUT_VOICES` (or `--new`,
or `--drawn` ones) and the `held_out` phrases of `speech_phrases.toml`, of which the last ones of
each command are not in the vocabulary, and many unrelated ones are short or sound like commands, on
purpose. It says nothing about people.
"""

import argparse
import asyncio
import math
import random
import shutil
import statistics
import sys
import time
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory

import pocketsphinx
from speech_corpus import (
    CONDITIONS,
    FEW,
    FRAME_BYTES,
    FRAME_S,
    FULL,
    HELD_OUT_VOICES,
    NEW_VOICES,
    QUICK,
    RATE_HZ,
    TUNED_VOICES,
    Condition,
    Spoken,
    corpus,
    drawn_voices,
    microphone,
)

from mend.server.speech.commands import Command
from mend.server.speech.decoding import Decoder, Hypothesis
from mend.server.speech.ear import ProcessEars
from mend.server.speech.fused_decoder import FusedDecoder
from mend.server.speech.language_model import COMMAND_MARK, command_in, name, write_language_model
from mend.server.speech.moonshine import Moonshine
from mend.server.speech.recognizer import Recognizer, Utterance
from mend.server.speech.speech_model import SpeechModelError, find_speech_model
from mend.server.speech.sphinx_decoder import SphinxDecoder
from mend.server.speech.vocabulary import phrase_commands
from mend.server.speech.written_evidence import WrittenEvidence

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
class Peer:
    """What hears the same beside us."""

    name: str
    decoder: Decoder


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
    ours: Decoder, peer: Peer, said: Sequence[Spoken], condition: Condition, misses: bool
) -> list[float]:
    """Print how both systems do under a condition; returns our latencies."""
    heard, by_peer = listen(ours, said, condition), listen(peer.decoder, said, condition)
    print(condition)
    print_rates("Mend", heard)
    print_rates(peer.name, by_peer)
    print(
        f"  {peer.name} to Mend: unrelated accepted {_ratio(by_peer.accepted(), heard.accepted())},"
        f" known phrases right at once {_ratio(by_peer.right(known=True), heard.right(known=True))}"
    )
    print_confusion(heard)
    if misses:
        for each, as_ in heard.outcomes:
            if as_ is not each.command:
                print(f"    {each.voice}: '{each.phrase}' -> {as_ or 'not understood'}")
    return heard.latencies_ms


def _ratio(peers: Share, ours: Share) -> str:
    return f"{peers.part / ours.part:.2f}" if ours.count else f"{peers.count} to none"


def decoder_with(model: Path | None) -> Decoder:
    """What listens: PocketSphinx, alone or with an operator's model."""
    if model is None:
        return SphinxDecoder()
    try:
        moonshine = Moonshine(find_speech_model(model))
    except SpeechModelError as error:
        sys.exit(str(error))
    return FusedDecoder(SphinxDecoder(), WrittenEvidence(moonshine))


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
    peer = (
        Peer("PocketSphinx", SphinxDecoder()) if arguments.model else Peer("JSGF", GrammarDecoder())
    )
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
