"""Ways through a dialogue script that together take every branch of it."""

from collections.abc import Iterator

from dialogue.conversation import Conversation, Phase
from dialogue.script import Script
from server.runtime.run_state import converse
from tasks.issue import Issue

Path = tuple[str, ...]

CALLS = {Phase.ASKING: ("yes", "no"), Phase.AWAITING_HELP: ("seen", "not_seen")}


def every_branch(script: Script, issue: Issue) -> list[Path]:
    """The shortest paths (calls after `open`) first, each that takes a branch none before took.

    A branch is what was said last together with the call that follows.
    """
    taken: set[tuple[str, str]] = set()
    chosen = []
    for path, branches in sorted(_paths(script, issue), key=lambda each: len(each[0])):
        if not branches <= taken:
            taken |= branches
            chosen.append(path)
    return chosen


def _paths(script: Script, issue: Issue) -> Iterator[tuple[Path, set[tuple[str, str]]]]:
    waiting: list[Path] = [()]
    while waiting:
        path = waiting.pop()
        conversation = Conversation(script, issue)
        said = str(conversation.open())
        branches = set()
        for call in path:
            branches.add((said, call))
            said = str(converse(conversation, call))
        calls = CALLS.get(conversation.phase)
        if calls is None:
            yield path, branches
        else:
            waiting += [(*path, call) for call in calls]
