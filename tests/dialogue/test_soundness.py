"""A script whose table cannot be walked to a close is refused with a sentence."""

from dataclasses import replace

import pytest

from mend.dialogue.registry import load_scripts, make_script
from mend.dialogue.script import (
    AskState,
    CloseState,
    Expectation,
    Help,
    HelpState,
    Script,
    ScriptWithParameters,
    State,
)
from mend.dialogue.soundness import UnsoundScriptError, check_script
from mend.documents.strict_model import StrictModel
from mend.tasks.plugins import PluginError
from mend.tasks.resolution import Resolution

LATER = CloseState("I will try again later.", Resolution.ROBOT_RETRY)


def ask(yes: str, no: str, text: str = "Shall I?") -> AskState:
    return AskState(text, yes, "I do.", no, "I do not.")


def awaiting(promised: Help, resolution: Resolution, otherwise: str) -> HelpState:
    return HelpState(
        "Please do.", promised, resolution, "Thanks.", "So it is.", "Not yet?", otherwise, "I stop."
    )


def problems_of(states: dict[str, State], opening: str = "first") -> list[str]:
    with pytest.raises(UnsoundScriptError) as caught:
        check_script("slipping", Script(opening, states))
    return caught.value.problems


@pytest.mark.parametrize(("kind", "script"), sorted(load_scripts().items()))
def test_every_installed_script_is_sound(kind: str, script: Script) -> None:
    check_script(kind, script)


def test_every_issue_of_the_house_has_a_script() -> None:
    kinds = {"missed", "dropped", "unreachable", "positioning", "missing", "blocked"}
    assert kinds <= set(load_scripts())


def test_a_state_that_leads_nowhere_is_refused() -> None:
    states: dict[str, State] = {"first": ask("later", "nowhere"), "later": LATER}
    assert problems_of(states) == ["state 'first' leads to 'nowhere', which is not in the table"]


def test_an_opening_that_is_not_there_is_refused() -> None:
    assert problems_of({"later": LATER}, opening="hello") == [
        "its opening state 'hello' is not in the table"
    ]


def test_a_state_that_nothing_leads_to_is_refused() -> None:
    states: dict[str, State] = {"first": LATER, "island": LATER}
    assert problems_of(states) == ["state 'island' can never be reached from 'first'"]


def test_a_conversation_that_could_go_round_for_ever_is_refused() -> None:
    states: dict[str, State] = {
        "first": ask("help", "later"),
        "help": awaiting(Help.PUT_BACK, Resolution.ROBOT_RETRY, "first"),
        "later": LATER,
    }
    assert problems_of(states) == ["a conversation could go round for ever through 'first', 'help'"]


def test_a_field_that_no_sentence_has_is_refused() -> None:
    states: dict[str, State] = {"first": CloseState("The {colour} one.", Resolution.ROBOT_RETRY)}
    assert problems_of(states) == [
        "'text' of state 'first' has the field {colour}; "
        "there are only {again}, {attempt}, {doing}, {fetch}, {go_on}, {guess_1}, {guess_2}, "
        "{guess_3}, {it}, {item}, {later}, {message}, {name}, {object}, {person}, {place}, "
        "{put_in}, {robot}, {times}, {why}, {with_object}"
    ]


@pytest.mark.parametrize(
    ("text", "problem"), [(" ", "is empty"), ("An {object", "cannot be filled in")]
)
def test_a_sentence_that_cannot_be_spoken_is_refused(text: str, problem: str) -> None:
    (only,) = problems_of({"first": CloseState(text, Resolution.ROBOT_RETRY)})
    assert problem in only


def test_a_mere_word_never_finishes_a_leaf() -> None:
    states: dict[str, State] = {"first": CloseState("Thanks.", Resolution.HUMAN_FINISH)}
    (only,) = problems_of(states)
    assert "closes with human_finish on a mere word" in only


def test_only_help_seen_at_its_place_finishes_a_leaf() -> None:
    states: dict[str, State] = {
        "first": awaiting(Help.PUT_BACK, Resolution.HUMAN_FINISH, "later"),
        "later": LATER,
    }
    (only,) = problems_of(states)
    assert "takes 'put_back' for human_finish" in only


def test_a_part_within_reach_is_not_placed() -> None:
    script = Script(
        "first",
        {"first": ask("later", "later"), "later": LATER},
        put_right={Expectation.IN_REACH: Resolution.HUMAN_FINISH},
    )
    with pytest.raises(UnsoundScriptError, match="in_reach"):
        check_script("slipping", script)


def test_asking_again_less_than_never_is_refused() -> None:
    with pytest.raises(UnsoundScriptError, match="0 is the least"):
        check_script("slipping", replace(Script("first", {"first": LATER}), reasks=-1))


def test_a_parameter_changes_how_often_a_script_asks_again() -> None:
    assert load_scripts({"missed": {"reasks": 5}})["missed"].reasks == 5


@pytest.mark.parametrize(
    ("parameters", "sentence"),
    [
        ({"missed": {"reasks": -1}}, "parameter 'reasks' of the dialogue script 'missed'"),
        ({"positioning": {"reasks": 1}}, "'positioning' has no parameters"),
        ({"unheard_of": {}}, "no dialogue script 'unheard_of'"),
    ],
)
def test_a_parameter_that_does_not_fit_is_refused(
    parameters: dict[str, dict[str, int]], sentence: str
) -> None:
    with pytest.raises(PluginError, match=sentence):
        load_scripts(parameters)


def test_a_script_of_another_package_may_have_parameters_of_its_own() -> None:
    class Politeness(StrictModel):
        please: str = "Please"

    def table(politeness: Politeness) -> Script:
        states = {"only": CloseState(f"{politeness.please} wait.", Resolution.ROBOT_RETRY)}
        return Script("only", states)

    provided = ScriptWithParameters(Politeness, table)
    script = make_script("slipping", provided, {"please": "Kindly"})
    assert script.states["only"].text == "Kindly wait."


@pytest.mark.parametrize(
    ("provided", "sentence"),
    [
        ("not a script", "it has to be a Script"),
        (Script("first", {}), "its opening state 'first' is not in the table"),
    ],
)
def test_what_another_package_provides_is_checked_when_it_is_loaded(
    provided: object, sentence: str
) -> None:
    with pytest.raises(PluginError, match=sentence):
        make_script("slipping", provided, {})
