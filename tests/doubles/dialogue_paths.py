"""Ways through dialogue scripts that together take every branch, or every kind of branch."""

from collections.abc import Hashable, Iterable, Iterator, Mapping
from dataclasses import dataclass
from typing import TypeVar

from mend.dialogue.calls import ConversationPhase
from mend.dialogue.conversation import Conversation
from mend.dialogue.outlook import Outlook
from mend.dialogue.script import Ask, Script, Turn
from mend.server.runtime.dialogue_state import converse
from mend.tasks.issue import Issue

Path = tuple[str, ...]

CALLS = {
    ConversationPhase.ASKING: ("yes", "no"),
    ConversationPhase.AWAITING_HELP: ("seen:moved", "not_seen"),
}


@dataclass(frozen=True)
class Branch:
    """One call of a path: the call `before` it ("open" at the start), what was said, what is."""

    before: str
    said: tuple[Turn, ...]
    call: str
    then: tuple[Turn, ...]


def every_branch(script: Script, issue: Issue) -> list[Path]:
    """Paths (calls after `open`) that together take every branch, in few calls.

    A branch is what was said last together with the call that follows. A dialogue without
    branches has one path, which has no calls.
    """
    return _fewest(
        (path, len(path), {(str(each.said), each.call) for each in branches})
        for path, branches in _paths(script, issue)
    )


def every_kind_of_answer(scripts: Mapping[str, Script], issue: Issue) -> list[tuple[str, Path]]:
    """Dialogues, each with a path, that together hold every kind of answer, in few calls.

    A kind is yes or no, to a question that opens the dialogue, follows an answer or a look, final
    or not, and what follows: a question, the wait for help or the end.
    """
    return _fewest(
        (
            (name, path),
            len(path),
            {_kind(each) for each in branches if isinstance(each.said[-1], Ask)},
        )
        for name, script in sorted(scripts.items())
        for path, branches in _paths(script, issue)
    )


def shortest_of_each(scripts: Mapping[str, Script], issue: Issue) -> list[tuple[str, Path]]:
    """Each dialogue with the fewest calls that take it from its opening to its end."""
    return [
        (name, min((path for path, _ in _paths(script, issue)), key=len))
        for name, script in sorted(scripts.items())
    ]


def _kind(branch: Branch) -> Hashable:
    asked = branch.said[-1]
    assert isinstance(asked, Ask)
    final = asked.yes_final if branch.call == "yes" else asked.no_final
    came = "answer" if branch.before in CALLS[ConversationPhase.ASKING] else branch.before
    return came, branch.call, final, type(branch.then[-1])


T = TypeVar("T")


def _fewest(candidates: Iterable[tuple[T, int, set[Hashable]]]) -> list[T]:
    """Some candidates, each with its length, that together hold what all of them hold (greedy)."""
    all_ = list(candidates)
    left = set().union(*(held for *_, held in all_))
    chosen: list[T] = []
    while left or not chosen:
        best, _, held = max(all_, key=lambda each: len(each[2] & left) / (1 + each[1]))
        chosen.append(best)
        left -= held
    return chosen


def _paths(script: Script, issue: Issue) -> Iterator[tuple[Path, list[Branch]]]:
    waiting: list[Path] = [()]
    while waiting:
        path = waiting.pop()
        conversation = Conversation(script, issue, Outlook())
        before, said = "open", tuple(conversation.open())
        branches = []
        for call in path:
            then = tuple(converse(conversation, call))
            branches.append(Branch(before, said, call, then))
            before, said = call, then
        calls = CALLS.get(conversation.phase)
        if calls is None:
            yield path, branches
        else:
            waiting += [(*path, call) for call in calls]
