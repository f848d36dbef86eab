"""Where answers come from: lists, chance, nobody, or live helpers."""

from typing import Literal

import pytest

from mend.server.dialogues.answers import (
    SILENCE,
    AnswerSource,
    ListedAnswers,
    NoAnswers,
    RandomAnswers,
    ScriptedAnswer,
    answer_source,
)
from mend.server.runtime.requests import RunRequest
from mend.tasks.scenario import Scenario


def test_listed_answers_come_in_turn_and_silence_follows() -> None:
    source = ListedAnswers(["yes", "silence", "no"], delay_s=1.5)
    assert [source.next_answer(ask) for ask in range(1, 6)] == [
        ScriptedAnswer("yes", 1.5),
        SILENCE,
        ScriptedAnswer("no", 1.5),
        SILENCE,
        SILENCE,
    ]


def test_a_random_answer_depends_on_the_seed_and_its_number_alone() -> None:
    forwards = [RandomAnswers(7).next_answer(ask) for ask in range(1, 40)]
    backwards = [RandomAnswers(7).next_answer(ask) for ask in range(39, 0, -1)]
    assert forwards == backwards[::-1]
    assert forwards != [RandomAnswers(8).next_answer(ask) for ask in range(1, 40)]


def test_random_answers_are_of_every_kind() -> None:
    answers = {RandomAnswers(3).next_answer(ask).answer for ask in range(1, 60)}
    assert answers == {"yes", "no", None}


@pytest.mark.parametrize(
    ("answers", "source"),
    [
        ("random", RandomAnswers(5)),
        ("none", NoAnswers(live=False)),
        (["no"], ListedAnswers(("no",), 2.0)),
        ([], ListedAnswers((), 2.0)),
        ("live", NoAnswers(live=True)),
        (None, NoAnswers(live=True)),
    ],
)
def test_a_request_says_where_its_answers_come_from(
    answers: list[Literal["yes", "no", "silence"]] | Literal["random", "none", "live"] | None,
    source: object,
) -> None:
    assert answer_source(RunRequest(tree="eket", seed=5, answers=answers), None) == source


def test_the_answers_of_a_request_come_before_those_of_its_scenario() -> None:
    scenario = Scenario(name="short", tree="eket", answers=["yes"], answer_delay_s=4.0)
    request = RunRequest(tree="eket")
    assert answer_source(request, scenario) == ListedAnswers(("yes",), 4.0)
    request = RunRequest(tree="eket", answers=["no"])
    assert answer_source(request, scenario) == ListedAnswers(("no",), 4.0)
    assert answer_source(RunRequest(tree="eket", answers="live"), scenario).live


def test_a_scenario_without_answers_leaves_them_to_live_helpers() -> None:
    scenario = Scenario(name="short", tree="eket")
    assert answer_source(RunRequest(tree="eket"), scenario).live


def test_only_live_helpers_hold_the_clock_back() -> None:
    sources: list[AnswerSource] = [ListedAnswers(["yes"]), RandomAnswers(1), NoAnswers(live=False)]
    assert not any(source.live for source in sources)
    assert NoAnswers(live=True).live
