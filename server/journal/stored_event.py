"""From the text of an event in the journal to the event."""

from pydantic import ValidationError

from mend.server.journal.events import Event, any_event
from mend.server.journal.journal import JournalReadError
from mend.server.journal.upgrades import UnknownEventVersionError, current_version, upgrade_text


class UnreadableEventError(JournalReadError):
    """An event is not what any Mend writes; the message says which."""


def read_event(seq: int, body: str, version: int | None = None, where: str = "") -> Event:
    """An event as a version of Mend wrote it, the current one unless given.

    `where` (" of 'journal.db'") goes into the message. Raises `UnreadableEventError`.
    """
    text = current_text(seq, body, version or current_version(), where)
    try:
        event: Event = any_event.validate_json(text)
    except ValidationError as error:
        first = error.errors(include_url=False, include_input=False, include_context=False)[0]
        at = "".join(f"{each}: " for each in [".".join(map(str, first["loc"]))] if each)
        raise UnreadableEventError(
            f"event {seq}{where} cannot be read: {at}{first['msg']}"
        ) from error
    return event


def current_text(seq: int, body: str, version: int, where: str = "") -> str:
    """An event's text as the current version would have written it.

    Raises `UnreadableEventError`.
    """
    try:
        return upgrade_text(body, version)
    except (UnknownEventVersionError, ValueError, KeyError, TypeError) as error:
        raise UnreadableEventError(f"event {seq}{where} cannot be read: {error}") from error
