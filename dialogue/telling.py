"""How what a look saw, or did not see, is told."""

from collections.abc import Mapping

from mend.dialogue.script import Expectation, Felt, HelpState, Sight
from mend.dialogue.spoken import spoken
from mend.dialogue.worded import Worded, joined, worded
from mend.dialogue.wording import sentence, without_question

SEEN_NOW: Mapping[Expectation, str] = {
    Expectation.AT_PLACE: "I see the {object} at its place now.",
    Expectation.IN_REACH: "I see the {object} within my reach now.",
    Expectation.WAY_CLEAR: "I see nothing in my way now.",
    Expectation.LED_ROUND: "Another way leads round. I take it.",
    Expectation.VIEW_CLEAR: "I see what is on the table now.",
    Expectation.LOCATED: "I know where I am now.",
    Expectation.LOADED: "I feel that my basket is heavier now.",
    Expectation.UNLOADED: "I feel that my basket is lighter now.",
    Expectation.CHARGED: "I feel current now.",
    Expectation.ACCOMPANIED: "I see {person} beside me now.",
    Expectation.IN_GRIPPER: "I have the {object} between my fingers.",
}

_SIGHTS: Mapping[Sight, str] = {
    Sight.NOWHERE: "I do not see it at all.",
    Sight.UNMOVED: "I see it where it was after I asked.",
    Sight.ELSEWHERE: "I see it, but not there.",
}


def nothing_could_be_seen(why: str) -> Worded:
    """Why a look tells nothing of the help that was promised."""
    return joined(sentence(spoken(why)), worded("I cannot see whether anybody has helped."))


def asked_about(state: HelpState, felt: Felt | None) -> str:
    """The question about help that was not seen, where a basket may feel something else."""
    return state.not_seen if felt is None else state.not_felt.get(felt, state.not_seen)


def not_yet(asked: str, sight: Sight | None) -> str:
    """That help was not seen yet, as the script's question states it, and what was instead."""
    said = without_question(asked) or "I do not see that help yet."
    return said if sight is None else f"{said} {_SIGHTS[sight]}"
