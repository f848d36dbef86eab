"""Ways through a dialogue script that together take every branch of it."""

from collections.abc import Collection, Iterator

from dialogue.conversation import Conversation, Phase
from dialogue.outlook import Outlook
from dialogue.script import Script
from server.runtime.run_state import converse
from tasks.issue import Issue

Path = tuple[str, ...]

CALLS = {Phase.ASKING: ("yes", "no"), Phase.AWAITING_HELP: ("seen:moved", "not_seen")}


ALL_CALLS = tuple(call for calls in CALLS.values() for call in calls)


def every_branch(script: Script, issue: Issue, calls: Collection[str] = ALL_CALLS) -> list[Path]:
    """Paths (calls after `open`) that together take every branch of these calls, in few calls.

    A branch is what was said last together with the call that follows. A dialogue without
    branches has one path, which has no calls.
    """
    paths = list(_paths(script, issue))
    left = {branch for _, branches in paths for branch in branches if branch[1] in calls}
    chosen: list[Path] = []
    while left or not chosen:
        path, branches = max(paths, key=lambda each: len(each[1] & left) / (1 + len(each[0])))
        chosen.append(path)
        left -= branches
    return chosen


def _paths(script: Script, issue: Issue) -> Iterator[tuple[Path, set[tuple[str, str]]]]:
    waiting: list[Path] = [()]
    while waiting:
        path = waiting.pop()
        conversation = Conversation(script, issue, Outlook())
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
