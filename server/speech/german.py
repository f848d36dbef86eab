"""What a person can say in German, where a speech model writes it down, and what that means.

A text counts as a whole phrase or not at all: one recognizer alone has written it.
"""

import re
from collections.abc import Mapping

from mend.server.speech.commands import Command
from mend.server.speech.vocabulary import Vocabulary

_ALWAYS: Mapping[Command, tuple[str, ...]] = {
    Command.REPEAT: (
        "noch mal", "noch mal bitte", "bitte noch mal", "noch einmal", "noch einmal bitte",
        "bitte noch einmal", "bitte wiederholen", "wiederholen bitte", "wie bitte",
        "sagen sie das noch mal", "sag das noch mal", "können sie das wiederholen",
        "kannst du das wiederholen", "was hast du gesagt", "was haben sie gesagt",
    ),
    Command.HELP: (
        "bitte hilfe", "hilfe bitte", "was kann ich sagen", "was kann ich antworten",
        "was heißt das", "was bedeutet das", "was passiert dann", "ich verstehe nicht",
        "ich verstehe das nicht", "bitte erklären", "bitte erkläre das",
    ),
    Command.STOP: (
        "bitte stopp", "stopp bitte", "stopp jetzt", "sofort stopp", "stopp sofort",
        "bitte anhalten", "sofort anhalten", "halt an", "bitte halt an", "halt sofort an",
        "roboter stopp", "stopp roboter", "nicht bewegen", "stopp stopp",
    ),
}  # fmt: skip

_ANSWER: Mapping[Command, tuple[str, ...]] = {
    Command.YES: (
        "ja bitte", "ja gern", "ja gerne", "ja klar", "ja sicher", "ja natürlich", "ja genau",
        "ja mach ich", "ja mache ich", "ja das mach ich", "ja das mache ich", "ja kann ich",
        "ja ich kann", "ja okay", "ja in ordnung", "in ordnung", "ja gut", "ja das stimmt",
        "ja stimmt", "ja wird gemacht", "wird gemacht", "ja ja",
    ),
    Command.NO: (
        "nein danke", "nein bitte nicht", "bitte nicht", "nein nein", "nein leider nicht",
        "leider nicht", "nein geht nicht", "das geht nicht", "nein das geht nicht",
        "nein kann ich nicht", "nein ich kann nicht", "ich kann nicht", "das kann ich nicht",
        "nein das kann ich nicht", "nein mach ich nicht", "mach ich nicht", "mache ich nicht",
        "nein auf keinen fall", "auf keinen fall", "nein das stimmt nicht", "das stimmt nicht",
        "nein will ich nicht", "nein jetzt nicht", "jetzt nicht",
    ),
    **_ALWAYS,
}  # fmt: skip

_NOT_NOW = ("nein jetzt nicht", "jetzt nicht")

PHRASES_IN_GERMAN: Mapping[Vocabulary, Mapping[Command, tuple[str, ...]]] = {
    Vocabulary.ANSWER: _ANSWER,
    Vocabulary.WAYS: {
        **_ANSWER,
        Command.NO: tuple(each for each in _ANSWER[Command.NO] if each not in _NOT_NOW),
        Command.PLACE: (
            "ich lege es selbst hin", "ich leg es selbst hin", "das lege ich selbst hin",
            "ich mache es selbst", "ich mach es selbst", "nein ich lege es selbst hin",
        ),
        Command.LEAVE_OUT: (
            "bitte auslassen", "auslassen bitte", "lass es aus", "lassen sie es aus",
            "bitte lass es aus", "mach ohne weiter", "ohne das weiter", "weiter ohne das",
        ),
        Command.NOT_NOW: (*_NOT_NOW, "bitte später", "später bitte", "vielleicht später"),
    },
    Vocabulary.PROMISE: {
        Command.DONE: (
            "ist fertig", "es ist fertig", "ich bin fertig", "bin fertig", "alles fertig",
            "fertig bitte", "ja fertig", "ist erledigt", "es ist erledigt", "habe ich gemacht",
            "hab ich gemacht", "ist da", "es ist da", "es liegt da", "schau noch mal",
            "schau jetzt", "sieh noch mal hin", "bitte noch mal schauen", "jetzt schauen",
        ),
        Command.CANNOT: (
            "ich kann nicht", "ich kann doch nicht", "kann ich doch nicht", "das geht nicht",
            "es geht nicht", "geht doch nicht", "ich schaffe es nicht", "ich schaff es nicht",
            "leider nicht", "ich kann leider nicht", "frag jemand anderen",
            "fragen sie jemand anderen", "ich habe keine zeit", "keine zeit",
        ),
        **_ALWAYS,
    },
}  # fmt: skip
"""Each has two words or more: noise and breath are written down as short words now and then.

What a `nicht` at its end would turn round is no yes: `mach ich`, `das stimmt`."""

_WORD = re.compile(r"[a-zäöüß]+")
_HESITATION = frozenset({"äh", "ähm", "ah", "hm", "hmm", "mm", "oh", "öh", "na", "also"})
_SPELLED: Mapping[str, str] = {"ok": "okay", "stop": "stopp", "nochmal": "noch mal"}


def meaning_in_german(text: str, vocabulary: Vocabulary) -> tuple[Command | None, str | None]:
    """The command that a text is, and its phrase; None, None where it is none."""
    words = [each for each in _WORD.findall(text.lower()) if each not in _HESITATION]
    phrase = " ".join(_SPELLED.get(each, each) for each in words)
    for command, phrases in PHRASES_IN_GERMAN[vocabulary].items():
        if phrase in phrases:
            return command, phrase
    return None, None
