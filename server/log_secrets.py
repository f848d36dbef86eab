"""What does not belong in a log: tokens and sessions, and whatever is too long for a line."""

import logging
import re

from websockets.frames import Frame

SECRETS = re.compile(
    r"(?i)((?:authorization|cookie): )[^\r\n]*|((?:access_)?token=)[^&\s\"']*"
    r"|(mend_)[0-9a-f]{8}_[A-Za-z0-9_-]+"
)
"""What follows such words, and Mend's own tokens wherever somebody puts them."""


LONGEST_CHARS = 500
"""Whoever asks for something decides how long what is logged of it would be."""


ACCESS = "uvicorn.access"


class HideSecrets(logging.Filter):
    """Puts stars in the place of every secret of a record, and ends long ones early.

    Of what comes and goes on WebSockets only the kind and the length are kept: a token may be in
    any of it, and in pieces.
    """

    def __init__(self, token: str | None = None) -> None:
        """`token` is the service's own, which need not look like one."""
        super().__init__()
        self._own = None if token is None else re.compile(re.escape(token))

    def filter(self, record: logging.LogRecord) -> bool:
        """Keep the record, without what nobody may read."""
        if record.name == ACCESS and isinstance(record.args, tuple):
            # Its formatter wants each of them.
            record.args = tuple(
                self._told(each) if isinstance(each, str) else each for each in record.args
            )
            return True
        if isinstance(record.args, tuple):
            record.args = tuple(
                _kind(each) if isinstance(each, Frame) else each for each in record.args
            )
        text = record.getMessage()
        told = self._told(text)
        if told != text:
            record.msg, record.args = told, ()
        return True

    def _told(self, text: str) -> str:
        hidden = SECRETS.sub(_stars, text)
        if self._own is not None:
            hidden = self._own.sub("***", hidden)
        if len(hidden) <= LONGEST_CHARS:
            return hidden
        return f"{hidden[:LONGEST_CHARS]}... ({len(hidden)} characters)"


def _stars(found: re.Match[str]) -> str:
    kept = next(each for each in found.groups() if each is not None)
    return f"{kept}***"


def _kind(frame: Frame) -> str:
    return f"{frame.opcode.name} [{len(frame.data)} bytes]"


def hide_secrets(token: str | None = None) -> None:
    """Hide them, and the service's own token, where uvicorn logs what comes and goes."""
    for name in ("uvicorn.error", ACCESS):
        logger = logging.getLogger(name)
        for each in [each for each in logger.filters if isinstance(each, HideSecrets)]:
            logger.removeFilter(each)
        logger.addFilter(HideSecrets(token))
