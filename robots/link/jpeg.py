"""Pictures in messages: JPEG as base64."""

import base64

from mend.errors import MendError

BEGIN = b"\xff\xd8\xff"
END = b"\xff\xd9"


class NotJpegError(MendError, ValueError):
    """What should be a picture is none; the message says why, without a subject."""


def read_jpeg(text: str) -> bytes:
    """The picture in a message. Raises `NotJpegError` for what no browser would show as one."""
    try:
        jpeg = base64.b64decode(text, validate=True)
    except ValueError as error:
        raise NotJpegError("is not base64") from error
    if not (jpeg.startswith(BEGIN) and jpeg.endswith(END)):
        raise NotJpegError("is not a JPEG")
    return jpeg
