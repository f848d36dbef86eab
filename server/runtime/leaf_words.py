"""What people say of leaves that they do themselves, in plain words. English only."""

import re
from collections.abc import Mapping
from dataclasses import dataclass
from enum import StrEnum

import numpy as np

from mend.dialogue.spoken import choice_of, spoken
from mend.errors import NotFoundError, WrongInputError
from mend.server.journal.events import NodeTaken
from mend.tasks.task_tree import TaskTree


class LeafDeed(StrEnum):
    """What somebody says that they do with a leaf."""

    TAKE = "take"
    GIVE_BACK = "give_back"


PART = "{part}"
PHRASES: Mapping[LeafDeed, tuple[str, ...]] = {
    LeafDeed.TAKE: (
        "i do {part}", "i'll do {part}", "i will do {part}", "i am doing {part}",
        "i'm doing {part}", "i can do {part}", "let me do {part}", "i take {part}",
        "i'll take {part}", "i will take {part}", "leave {part} to me",
    ),
    LeafDeed.GIVE_BACK: (
        "i give {part} back", "i'll give {part} back", "i will give {part} back",
        "i give back {part}", "i don't do {part}", "i do not do {part}", "i won't do {part}",
        "i will not do {part}", "i can't do {part}", "i cannot do {part}",
    ),
}  # fmt: skip

_LONGEST_FIRST = sorted(
    ((phrase, deed) for deed, phrases in PHRASES.items() for phrase in phrases),
    key=lambda each: -len(each[0]),
)
"""'I do not do the saucer' fits 'I do ...' too."""


@dataclass(frozen=True, slots=True)
class Said:
    """What was understood: the deed, and the part of the leaf that it is about."""

    deed: LeafDeed
    part: str


def understood(words: str) -> Said:
    """What somebody says. Raises `WrongInputError` where it is nothing of a leaf."""
    plain = " ".join(re.sub(r"[.,!?]", " ", words.replace("’", "'")).lower().split())
    for phrase, deed in _LONGEST_FIRST:
        before, _, after = phrase.partition(PART)
        if len(plain) > len(before) + len(after) and _is_between(plain, before, after):
            part = plain[len(before) : len(plain) - len(after)]
            return Said(deed, part.removeprefix("the "))
    raise WrongInputError(
        f"'{words}' says nothing of a leaf: say 'I do the ...' with the name of its part, or "
        "'I give the ... back'"
    )


def _is_between(plain: str, before: str, after: str) -> bool:
    return plain.startswith(before) and plain.endswith(after)


def leaf_meant(said: Said, helper: str, tree: TaskTree, people: Mapping[int, NodeTaken]) -> int:
    """The leaf that somebody speaks of: one of theirs, else one that can be begun.

    Raises `NotFoundError` where the task has nothing to do with such a part.
    """
    objects = tree.nodes.objects
    codes = [code for code, each in enumerate(objects) if spoken(each).lower() == said.part]
    if not codes:
        known = choice_of(tuple(objects))
        raise NotFoundError(f"the task has no part '{said.part}'; there is {known}")
    leaves = [int(each) for each in np.flatnonzero(np.isin(tree.nodes.object_codes, codes))]
    if said.deed is LeafDeed.GIVE_BACK:
        theirs = [each for each, taken in people.items() if taken.helper == helper]
        return next((each for each in leaves if each in theirs), leaves[0])
    return next((each for each in leaves if tree.eligible(each)), leaves[0])
