"""Which kind of file a document is, where it was given as another one."""

from mend.documents.document import LinedMapping
from mend.documents.problem import Problem

_KEYS = {
    "a building": ({"building", "floors"}, "`mend building scene` makes a scene of it"),
    "a request file": ({"requests"}, "`mend building run` has robots meet them"),
    "a task tree": ({"tree"}, "`mend run` runs it"),
    "a scene": ({"objects", "places"}, "a task tree names it as its 'scene'"),
    "a scenario": ({"interventions"}, "`mend run --scenario` plays it"),
}
"""What only files of each kind have, and what is done with one."""


def not_the_kind(content: LinedMapping, wanted: str) -> Problem | None:
    """That it is a file of another kind than the `wanted` one; None where nothing says so."""
    if content.keys() & _KEYS[wanted][0]:
        return None
    for kind, (keys, use) in _KEYS.items():
        if keys <= content.keys():
            return Problem(content.line, None, f"this is {kind}, and not {wanted}: {use}")
    return None
