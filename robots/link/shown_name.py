"""Names as people read them, in logs, terminals and the console: none that looks like another."""

from pydantic import AfterValidator


def can_be_shown(name: str) -> bool:
    """Whether all of a name can be seen: nothing turned round, invisible or blank at its ends."""
    return name.isprintable() and name == name.strip() and name != ""


def _require_shown(name: str) -> str:
    if not can_be_shown(name):
        raise ValueError(
            "a name begins and ends with no blank, and has only characters that can be seen"
        )
    return name


SHOWN = AfterValidator(_require_shown)
"""For a field with a name: what pydantic calls its pattern tells other programs the most of it."""
