"""The address at which others reach the service."""

from typing import Annotated
from urllib.parse import urlsplit

from pydantic import AfterValidator


def _require_public_url(text: str) -> str:
    """`https://mend.example.com`, without a slash at its end. Raises `ValueError`."""
    right = "one looks like https://mend.example.com"
    try:
        parts = urlsplit(text)
        name, _ = parts.hostname, parts.port
    except ValueError:
        raise ValueError(f"{text!r} is not an address; {right}") from None
    if parts.scheme not in ("http", "https") or not name or not text.isascii() or " " in text:
        raise ValueError(f"{text!r} is not an address of a web page; {right}")
    if parts.username is not None or parts.password is not None:
        raise ValueError(f"an address that everybody reads must hold no user or password; {right}")
    if parts.path not in ("", "/") or parts.query or parts.fragment:
        raise ValueError(
            f"{text!r} has more than a name and a port: the console is at the root; {right}"
        )
    return text.rstrip("/")


PublicUrl = Annotated[str, AfterValidator(_require_public_url)]


def host_of(url: str) -> str:
    """The name in an address that was checked."""
    name = urlsplit(url).hostname
    assert name is not None, "it was checked"
    return name
