"""What does not belong in a log: tokens and sessions, and whatever is too long for a line."""

import logging
import re

from websockets.frames import Frame

SECRETS = re.compile(r"(?i)((?:authorization|cookie): )[^\r\n]*")


LONGEST_CHARS = 500
"""Whoever asks for something decides how long what is logged of it would be."""


ACCESS = "uvicorn.access"


class HideSecrets(logging.Filter):
    """Puts stars in the place of every secret of a record, and ends long ones early.

    Of what comes and goes on WebSockets only the kind and the length are kept: a token may be in
    any of it, and in pieces.
    """

    def filter(self, record: logging.LogRecord) -> bool:
        """Keep the record, without what nobody may read."""
        if record.name == ACCESS and isinstance(record.args, tuple):
            # Its formatter wants each of them.
            record.args = tuple(
                _told(each) if isinstance(each, str) else each for each in record.args
            )
            return True
        if isinstance(record.args, tuple):
            record.args = tuple(
                _kind(each) if isinstance(each, Frame) else each for each in record.args
            )
        text = record.getMessage()
        told = _told(text)
        if told != text:
            record.msg, record.args = told, ()
        return True


def _kind(frame: Frame) -> str:
    return f"{frame.opcode.name} [{len(frame.data)} bytes]"


def _told(text: str) -> str:
    hidden = SECRETS.sub(r"\1***", text)
    if len(hidden) <= LONGEST_CHARS:
        return hidden
    return f"{hidden[:LONGEST_CHARS]}... ({len(hidden)} characters)"


def hide_secrets() -> None:
    """Hide them where uvicorn logs what comes and goes on WebSockets."""
    for name in ("uvicorn.error", ACCESS):
        logger = logging.getLogger(name)
        if not any(isinstance(each, HideSecrets) for each in logger.filters):
            logger.addFilter(HideSecrets())
