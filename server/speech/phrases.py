"""What the robot says besides the prompts: the fixed phrases, and what the answers will do."""

from collections.abc import Mapping, Sequence

from mend.server.journal.events import AnswerOption, WayOption
from mend.server.speech.chosen_way import way_meant
from mend.server.speech.commands import Command
from mend.server.speech.vocabulary import SpokenLanguage

SORRY = "Sorry, please say yes or no."

PROMISE_SORRY = "Sorry, please say done, or I can't."
PROMISE_HELP = (
    "If you say done, I look again. If you say I can't, you take your promise back. "
    "You can also say: repeat, or stop."
)

SORRY_IN_GERMAN = "Sorry, please say in German: ja bitte, or nein danke."
PROMISE_SORRY_IN_GERMAN = "Sorry, please say in German: ist fertig, or ich kann nicht."

FIXED: Mapping[str, str] = {
    "sorry": SORRY,
    "commands": "You can say yes or no. You can also say: repeat, help, or stop.",
    "promise_sorry": PROMISE_SORRY,
    "promise_help": PROMISE_HELP,
    "sorry_in_german": SORRY_IN_GERMAN,
    "promise_sorry_in_german": PROMISE_SORRY_IN_GERMAN,
    "buttons": "I did not understand. Please use the buttons.",
}
"""By the name under which their sound is served."""


def sorry_name(language: SpokenLanguage, *, promised: bool) -> str:
    """Which fixed phrase says that somebody was not understood."""
    name = "promise_sorry" if promised else "sorry"
    return name if language is SpokenLanguage.ENGLISH else f"{name}_in_german"


_SAID = {Command.PLACE: "I'll place it myself", Command.LEAVE_OUT: "leave it out"}


def help_text(answers: Sequence[AnswerOption], ways: Sequence[WayOption] = ()) -> str:
    """What yes and no will each do, and what else can be said."""
    effects = [f"If you say {each.value}: {each.effect}" for each in answers]
    chosen = [said for command, said in _SAID.items() if way_meant(command, ways) not in _of(ways)]
    more = ", ".join([*chosen, *(["not now"] if len(ways) > 2 else []), "repeat"])
    return " ".join([*effects, f"You can also say: {more}, or stop."])


def _of(ways: Sequence[WayOption]) -> tuple[str | None, ...]:
    """What need not be told: what there is not, and what yes does."""
    return (None, *(each.way for each in ways[:1]))


def effect_text(answer: AnswerOption) -> str:
    """What was answered and what that will do, for whoever may still take it back."""
    return f"{answer.value.capitalize()}. {answer.effect}"
