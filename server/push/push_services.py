"""The push services that this service writes to: those of the browsers, and what is added."""

import base64
import binascii
from collections.abc import Sequence
from urllib.parse import urlsplit

from cryptography.hazmat.primitives.asymmetric import ec

from mend.server.settings import is_loopback

AUTH_BYTES = 16


def why_not_endpoint(endpoint: str, services: Sequence[str]) -> str | None:
    """Why nothing may be sent to an address that a browser names; None if it may.

    A client names it and the service calls it: with any address allowed, a helper could have the
    service write to whatever it can reach.
    """
    try:
        parts = urlsplit(endpoint)
        host, port = parts.hostname, parts.port
    except ValueError:
        return "is no address"
    if host is None or parts.username is not None or parts.fragment or not endpoint.isascii():
        return "is no address of a push service"
    if not any(host == each or host.endswith(f".{each}") for each in services):
        return f"is at {host}, which is none of the setting 'push_services'"
    if is_loopback(host):
        return None if parts.scheme in ("http", "https") else "is no address of a web service"
    if parts.scheme != "https" or port not in (None, 443):
        return "must begin with https:// and have no port"
    return None


def why_not_keys(p256dh: str, auth: str) -> str | None:
    """Why nothing can be encrypted for a device's keys (RFC 8291); None if it can."""
    try:
        point, secret = _bytes(p256dh), _bytes(auth)
        ec.EllipticCurvePublicKey.from_encoded_point(ec.SECP256R1(), point)
    except (ValueError, binascii.Error):
        return "'p256dh' must be a point on the curve P-256, and both keys in base64url"
    if len(secret) != AUTH_BYTES:
        return f"'auth' must be {AUTH_BYTES} bytes in base64url"
    return None


def _bytes(text: str) -> bytes:
    return base64.b64decode(text + "=" * (-len(text) % 4), altchars=b"-_", validate=True)
