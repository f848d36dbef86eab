"""Which way of help is chosen by what somebody has said."""

from collections.abc import Sequence

from mend.server.journal.events import WayOption
from mend.server.speech.commands import Command

_NAMES = {Command.PLACE: "place", Command.LEAVE_OUT: "left_out"}
CHOICES = (*_NAMES, Command.NOT_NOW)
"""What chooses a way, and answers nothing by itself."""


def way_meant(command: Command | None, ways: Sequence[WayOption]) -> str | None:
    """The way that a command chooses; None where it chooses none of these."""
    if command is Command.NOT_NOW:
        return next((each.way for each in ways if "yes" not in each.answers), None)
    name = None if command is None else _NAMES.get(command)
    return next((each.way for each in ways if each.way == name), None)
