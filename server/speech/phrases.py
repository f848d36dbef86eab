"""What the robot says besides the prompts: the fixed phrases, and what the answers will do."""

from collections.abc import Mapping, Sequence

from mend.server.journal.events import AnswerOption

SORRY = "Sorry, please say yes or no."

PROMISE_SORRY = "Sorry, please say done, or I can't."
PROMISE_HELP = (
    "If you say done, I look again. If you say I can't, you take your promise back. "
    "You can also say: repeat, or stop."
)

FIXED: Mapping[str, str] = {
    "sorry": SORRY,
    "commands": "You can say yes or no. You can also say: repeat, help, or stop.",
    "promise_sorry": PROMISE_SORRY,
    "promise_help": PROMISE_HELP,
    "buttons": "I did not understand. Please use the buttons.",
}
"""By the name under which their sound is served."""


def help_text(answers: Sequence[AnswerOption]) -> str:
    """What yes and no will each do, and what else can be said."""
    effects = [f"If you say {each.value}: {each.effect}" for each in answers]
    return " ".join([*effects, "You can also say: repeat, or stop."])


def effect_text(answer: AnswerOption) -> str:
    """What was answered and what that will do, for whoever may still take it back."""
    return f"{answer.value.capitalize()}. {answer.effect}"
