"""Whether a script's table is sound: everything can be reached, and every path closes."""

from collections.abc import Iterator
from dataclasses import fields

from mend.dialogue.script import (
    AskState,
    CloseState,
    Expectation,
    Help,
    HelpState,
    LeaveState,
    Script,
    State,
    ToldState,
)
from mend.dialogue.wording import FIELDS, unknown_fields
from mend.errors import MendError
from mend.tasks.resolution import Resolution


class UnsoundScriptError(MendError):
    """A script's table cannot be used; `problems` has one sentence per mistake."""

    def __init__(self, name: str, problems: list[str]) -> None:
        super().__init__(f"the dialogue script '{name}' cannot be used: {'; '.join(problems)}")
        self.problems = problems


def _problems(script: Script) -> list[str]:
    problems = [*_dangling(script)]
    if not problems:
        problems += [*_unreachable(script), *_endless(script)]
    problems += [*_badly_worded(script), *_unverified(script)]
    if script.reasks < 0:
        problems.append(f"it asks again {script.reasks} times; 0 is the least")
    for each in sorted(script.denied - set(script.put_right)):
        problems.append(f"it denies '{each}', for which it does not watch")
    for sensed, variant in script.variants.items():
        problems += [f"if it was {sensed}: {each}" for each in _problems(variant)]
    if script.without_object is not None:
        problems += [f"without an object: {each}" for each in _problems(script.without_object)]
    return problems


def check_script(name: str, script: Script) -> None:
    """Raise `UnsoundScriptError` unless every walk through the table ends in a close."""
    problems = _problems(script)
    if problems:
        raise UnsoundScriptError(name, problems)


def _following(state: State) -> tuple[str, ...]:
    match state:
        case AskState(yes=yes, no=no, unanswered=unanswered):
            return (yes, no, *([unanswered] if unanswered else []))
        case HelpState(otherwise=otherwise) | ToldState(otherwise=otherwise):
            return (otherwise,)
        case CloseState() | LeaveState():
            return ()


def _dangling(script: Script) -> Iterator[str]:
    for opening in script.openings:
        if opening not in script.states:
            yield f"its opening state '{opening}' is not in the table"
    for name, state in script.states.items():
        for following in _following(state):
            if following not in script.states:
                yield f"state '{name}' leads to '{following}', which is not in the table"


def _unreachable(script: Script) -> Iterator[str]:
    reached = set(script.openings)
    waiting = [*script.openings]
    while waiting:
        new = set(_following(script.states[waiting.pop()])) - reached
        reached |= new
        waiting += new
    for name in script.states:
        if name not in reached:
            yield f"state '{name}' can never be reached from '{script.opening}'"


def _endless(script: Script) -> Iterator[str]:
    closing: set[str] = set()
    while grown := {
        name
        for name, state in script.states.items()
        if name not in closing and closing.issuperset(_following(state))
    }:
        closing |= grown
    if endless := [f"'{name}'" for name in script.states if name not in closing]:
        yield f"a conversation could go round for ever through {', '.join(endless)}"


def _badly_worded(script: Script) -> Iterator[str]:
    for name, state in script.states.items():
        for field, text in sentences_in(state):
            where = f"'{field}' of state '{name}'"
            if not text.strip() and field not in _MAY_BE_EMPTY:
                yield f"{where} is empty"
            try:
                unknown = unknown_fields(text)
            except ValueError as error:
                yield f"{where} cannot be filled in: {error}"
                continue
            for each in unknown:
                known = ", ".join(f"{{{one}}}" for one in sorted(FIELDS))
                yield f"{where} has the field {{{each}}}; there are only {known}"


def sentences_in(state: State) -> Iterator[tuple[str, str]]:
    """All that a state says, by what it is called there."""
    for field in _SENTENCES[type(state)]:
        yield field, getattr(state, field)
    if isinstance(state, HelpState):
        yield from ((f"not_felt: {felt}", text) for felt, text in state.not_felt.items())
        yield from ((f"deeds_felt: {felt}", text) for felt, text in state.deeds_felt.items())


def _unverified(script: Script) -> Iterator[str]:
    """Nothing may count as placed by the helper that no camera has seen at its place."""
    rule = "the leaf would be done without the object seen at its place"
    for name, state in script.states.items():
        match state:
            case (
                CloseState(resolution=Resolution.HUMAN_FINISH)
                | ToldState(resolution=Resolution.HUMAN_FINISH)
            ):
                yield f"state '{name}' closes with human_finish on a mere word; {rule}"
            case HelpState(resolution=Resolution.HUMAN_FINISH, help=promised):
                if promised is not Help.PLACE:
                    yield f"state '{name}' takes '{promised}' for human_finish; {rule}"
    for seen, resolution in script.put_right.items():
        if resolution is Resolution.HUMAN_FINISH and seen is not Expectation.AT_PLACE:
            yield f"seeing '{seen}' puts it right with human_finish; {rule}"


_NOT_SENTENCES = {
    "yes",
    "no",
    "unanswered",
    "if_refused",
    "otherwise",
    "help",
    "resolution",
    "guess",
    "not_felt",
    "deeds_felt",
}
_MAY_BE_EMPTY = {"deed", "headline"}
_SENTENCES: dict[type, list[str]] = {
    kind: [field.name for field in fields(kind) if field.name not in _NOT_SENTENCES]
    for kind in (AskState, HelpState, ToldState, CloseState, LeaveState)
}
