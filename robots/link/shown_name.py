"""Names as people read them, in logs, terminals and the console: with nothing that is not seen."""

import re

from pydantic import AfterValidator

INVISIBLE = re.compile(
    "[\u034f\u115f\u1160\u17b4\u17b5\u180b-\u180f\u2800\u3164\ufe00-\ufe0f\uffa0\U000e0100-\U000e01ef]"
)
"""What Unicode calls default-ignorable though it counts as a letter or mark, and the empty braille.

Letters of several scripts that look alike are told apart by nobody here.
"""


def can_be_shown(name: str) -> bool:
    """Whether all of a name can be seen: nothing turned round, invisible or blank at its ends."""
    if name == "" or name != name.strip():
        return False
    return name.isprintable() and INVISIBLE.search(name) is None


def _require_shown(name: str) -> str:
    if not can_be_shown(name):
        raise ValueError(
            "a name begins and ends with no blank, and has only characters that can be seen"
        )
    return name


SHOWN = AfterValidator(_require_shown)
"""For a field with a name: what pydantic calls its pattern tells other programs the most of it."""
