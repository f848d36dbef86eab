"""Every way to answer a question and those that follow its no, so that one may be chosen at once.

A dialogue asks for one way of help after the other. Whoever chooses the second has said no to the
first and yes to the second: the same answers, in the same order, to the same questions.
"""

from collections.abc import Iterator
from dataclasses import dataclass, replace

from mend.dialogue.reading import ScriptReading
from mend.dialogue.script import Answer, AskState, Felt, HelpState, Way

NOT_NOW = "Not now"
"""What a helper says who refuses every way of help."""


@dataclass(frozen=True, slots=True)
class Choice:
    """The ways to answer a question; empty where one of them has no deed.

    `headline`: what is asked of the helper, the deed of the first way unless the question has its
    own.
    """

    ways: tuple[Way, ...] = ()
    headline: str = ""


def ways_of(reading: ScriptReading, asked: AskState) -> Choice:
    """The ways to answer a question of the script."""
    return _choice(reading, [*_from(reading, asked, ())], asked.headline)


def ways_of_repeated(
    reading: ScriptReading, name: str, promised: HelpState, effect: str, felt: Felt | None
) -> Choice:
    """The ways to answer whether promised help, the state `name`, still comes.

    `effect`: what a yes does; `felt`: what the robot feels instead.
    """
    still = _way(reading, name, _deed_about(promised, felt), effect, ("yes",))
    others = _after_no(reading, promised.otherwise, promised.otherwise_effect, ("no",))
    return _choice(reading, [still, *others], "")


def _choice(reading: ScriptReading, found: list[Way | None], headline: str) -> Choice:
    ways = tuple(each for each in found if each is not None)
    if len(ways) < len(found):
        return Choice()
    said = reading.word(headline) if headline else ways[0].deed
    if not reading.names_object(said):
        ways = tuple(replace(each, label=each.deed) for each in ways)
    return Choice(ways, said)


def _from(reading: ScriptReading, asked: AskState, nos: tuple[Answer, ...]) -> Iterator[Way | None]:
    effect = reading.effect(asked.yes, asked.yes_effect)
    yield _way(reading, asked.yes, _deed(reading, asked.yes), effect, (*nos, "yes"))
    yield from _after_no(reading, asked.no, asked.no_effect, (*nos, "no"))


def _after_no(
    reading: ScriptReading, name: str, effect: str, nos: tuple[Answer, ...]
) -> Iterator[Way | None]:
    following = reading.script.states[reading.following(name)]
    if isinstance(following, AskState):
        yield from _from(reading, following, nos)
    else:
        deed = _deed(reading, name) or NOT_NOW
        yield _way(reading, name, deed, reading.effect(name, effect), nos)


def _way(
    reading: ScriptReading, name: str, deed: str, effect: str, answers: tuple[Answer, ...]
) -> Way | None:
    """A way; None where there is no word for it."""
    if not deed:
        return None
    return Way(
        name=reading.following(name),
        deed=reading.word(deed),
        label=reading.word(deed, named=True),
        effect=effect,
        answers=answers,
        final=reading.is_final(name),
    )


def _deed(reading: ScriptReading, name: str) -> str:
    state = reading.state(name)
    return "" if isinstance(state, AskState) else state.deed


def _deed_about(promised: HelpState, felt: Felt | None) -> str:
    return promised.deed if felt is None else promised.deeds_felt.get(felt, promised.deed)
