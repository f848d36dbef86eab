"""Sentences that know what they were made of, and that every language has all of them."""

import json
import re
from collections.abc import Iterator
from pathlib import Path

import pytest

from mend.dialogue import spoken
from mend.dialogue.conversation import Conversation
from mend.dialogue.outlook import Next, Outlook, Sequel
from mend.dialogue.registry import load_scripts
from mend.dialogue.script import Ask, Remark, Script
from mend.dialogue.soundness import sentences_in
from mend.dialogue.worded import Sentence, Worded, filled_in, joined, sentences_of, worded
from mend.tasks.issue import Issue

SCRIPTS = load_scripts()
TEXTS = Path(__file__).parents[2] / "web" / "texts"
LANGUAGES = sorted(each.name for each in TEXTS.iterdir())
ISSUE = Issue("missed", "pr2", "/0", "red_leg", "red_leg", "top", 3, reason="red_leg slipped")


def in_english(text: str) -> str:
    """A text put together again of what it says that it is made of."""
    return " ".join(_filled(each) for each in sentences_of(text))


def _filled(sentence: Sentence) -> str:
    args = {name: in_english(each) for name, each in sentence.args.items()}
    text = sentence.key.format(**args)
    return f"{text[:1].upper()}{text[1:]}" if sentence.key[-1:] in ".?:" else text


def test_texts_are_joined_but_for_empty_ones() -> None:
    text = joined(worded("I go on"), "", "Plain.")
    assert text == "I go on Plain."
    assert text.sentences == (Sentence("I go on"), Sentence("Plain."))


def test_each_sentence_of_a_text_is_one_by_itself() -> None:
    why = Worded(" It slipped.", (Sentence("It slipped."),))
    text = filled_in("I missed the {object}.{why} Will you help?", {"object": "cup", "why": why})
    assert text == "I missed the cup. It slipped. Will you help?"
    assert text.sentences == (
        Sentence("I missed the {object}.", {"object": "cup"}),
        Sentence("It slipped."),
        Sentence("Will you help?"),
    )


def test_a_reason_that_is_not_told_leaves_no_gap() -> None:
    text = filled_in("I missed it.{why} Will you help?", {"why": ""})
    assert text == in_english(text) == "I missed it. Will you help?"


@pytest.mark.parametrize("kind", SCRIPTS)
def test_what_a_dialogue_says_is_made_of_what_it_says_that_it_is(kind: str) -> None:
    failed = Sequel(Next.ANY_OF, ("cup", "saucer", "spoon"))
    outlook = Outlook(attempt=2, times=2, failed=failed, helped=Sequel(Next.OTHERS_FIRST, ("cup",)))
    conversation = Conversation(SCRIPTS[kind], ISSUE, outlook)
    for turn in conversation.open():
        match turn:
            case Ask(ways=ways):
                said = [turn.text, turn.yes_effect, turn.no_effect, turn.timeout_effect]
                for text in [*said, *(way.effect for way in ways)]:
                    assert in_english(text) == text
            case Remark(text=text):
                assert in_english(text) == text


@pytest.mark.parametrize("language", LANGUAGES)
def test_every_sentence_of_the_dialogues_is_in_every_language(language: str) -> None:
    texts = json.loads((TEXTS / language / "sentences.json").read_text())
    wanted = {key for script in SCRIPTS.values() for key in _keys(script)}
    assert sorted(wanted - set(texts)) == []


@pytest.mark.parametrize("language", LANGUAGES)
@pytest.mark.parametrize("following", Next)
@pytest.mark.parametrize("alone", [True, False])
def test_every_outlook_is_in_every_language(language: str, following: Next, alone: bool) -> None:
    texts = json.loads((TEXTS / language / "sentences.json").read_text())
    for count in range(5):
        sequel = Sequel(following, ("a", "b", "c", "d")[:count])
        outlook = Outlook(failed=sequel, helped=sequel, times=count, alone=alone)
        clauses = (outlook.if_it_fails(), outlook.after_help(), outlook.going_on())
        for clause in (*clauses, outlook.attempt_spoken, spoken.count_of(7 * count)):
            assert set(_keys_of(clause)) <= set(texts)


def _keys(script: Script) -> Iterator[str]:
    for state in script.states.values():
        for _, text in sentences_in(state):
            fields = dict.fromkeys(re.findall(r"\{(\w+)\}", text), "x") | {"why": ""}
            yield from (each.key for each in filled_in(text, fields).sentences if each.key)
    for variant in script.variants.values():
        yield from _keys(variant)
    if script.without_object is not None:
        yield from _keys(script.without_object)


def _keys_of(text: str) -> Iterator[str]:
    for sentence in sentences_of(text):
        yield sentence.key
        for each in sentence.args.values():
            if isinstance(each, Worded):
                yield from _keys_of(each)
