"""How a script's sentences are filled in, so that a busy person can take them in by ear."""

from string import Formatter

from tasks.issue import Issue

FIELDS = frozenset({"object", "place", "name", "robot"})


def word(text: str, issue: Issue) -> str:
    """Fill in a sentence; a leaf without an object or place is spoken of by its own name."""
    return text.format(
        object=_spoken(issue.object or issue.name),
        place=_spoken(issue.place or issue.name),
        name=_spoken(issue.name),
        robot=_spoken(issue.robot),
    )


def unknown_fields(text: str) -> list[str]:
    """The fields of a sentence that `word` cannot fill in.

    Raises `ValueError` when its braces do not match.
    """
    fields = [field for _, field, _, _ in Formatter().parse(text) if field is not None]
    return [field for field in fields if field not in FIELDS]


def _spoken(identifier: str) -> str:
    return identifier.replace("_", " ").replace("-", " ")
