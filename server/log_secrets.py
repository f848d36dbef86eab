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


class HideSecrets(logging.Filter):
    """Puts stars in the place of every secret of a record, and ends long ones early."""

    def filter(self, record: logging.LogRecord) -> bool:
        """Keep the record, without what nobody may read."""
        text = record.getMessage()
        hidden = SECRETS.sub(r"\1***", text)
        if len(hidden) > LONGEST_CHARS:
            hidden = f"{hidden[:LONGEST_CHARS]}... ({len(hidden)} characters)"
        if hidden != text:
            record.msg, record.args = hidden, ()
        return True


def hide_secrets() -> None:
    """Hide them where uvicorn logs what comes and goes on WebSockets."""
    for name in ("uvicorn.error", "uvicorn.access"):
        logger = logging.getLogger(name)
        if not any(isinstance(each, HideSecrets) for each in logger.filters):
            logger.addFilter(HideSecrets())
