"""What does not belong in a log: tokens and sessions, and whatever is too long for a line."""

import logging
import re

BLANKS = r"(?:\s|\\[tnr])*"
"""As JSON has them around a colon, and as they are logged where a text is quoted."""

SECRETS = re.compile(
    rf'(?i)((?:authorization|cookie): |"token"{BLANKS}:{BLANKS}")(?:\\.|[^"\\\r\n])*'
)


LONGEST_CHARS = 500
"""Whoever asks for something decides how long what is logged of it would be."""


ACCESS = "uvicorn.access"


class HideSecrets(logging.Filter):
    """Puts stars in the place of every secret of a record, and ends long ones early."""

    def filter(self, record: logging.LogRecord) -> bool:
        """Keep the record, without what nobody may read."""
        if record.name == ACCESS and isinstance(record.args, tuple):
            # Its formatter wants each of them.
            record.args = tuple(
                _told(each) if isinstance(each, str) else each for each in record.args
            )
            return True
        text = record.getMessage()
        told = _told(text)
        if told != text:
            record.msg, record.args = told, ()
        return True


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
