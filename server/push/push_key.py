"""The key pair by which push services know this service (VAPID, RFC 8292)."""

import logging
from dataclasses import dataclass
from pathlib import Path

from cryptography.hazmat.primitives import serialization
from cryptography.hazmat.primitives.asymmetric import ec
from webpush.vapid import VAPID

from mend.server.kept_secret import keep_secret

log = logging.getLogger(__name__)


@dataclass(frozen=True, slots=True)
class PushKey:
    """Both halves in PEM; `public` is what a browser takes as its `applicationServerKey`."""

    private_pem: bytes
    public_pem: bytes
    public: str


def push_key(file: Path | None) -> PushKey:
    """The key in the file, which is made when there is none; without a file a new one.

    Where it cannot be read or kept, a new one lasts until the service stops.
    """
    if file is None:
        return _new()
    try:
        return _read(file.read_bytes())
    except FileNotFoundError:
        pass
    except (ValueError, TypeError):
        log.warning("%s holds no key for push services: a new one takes its place", file)
    except OSError as error:
        return _for_now(file, "read", error)
    key = _new()
    try:
        keep_secret(key.private_pem, file)
    except OSError as error:
        return _for_now(file, "kept", error)
    return key


def _new() -> PushKey:
    private, public, application = VAPID.generate_keys()
    return PushKey(private, public, application)


def _read(pem: bytes) -> PushKey:
    private = serialization.load_pem_private_key(pem, password=None)
    if not isinstance(private, ec.EllipticCurvePrivateKey) or private.curve.name != "secp256r1":
        raise ValueError("push services take keys on the curve P-256 alone")
    public = private.public_key()
    public_pem = public.public_bytes(
        serialization.Encoding.PEM, serialization.PublicFormat.SubjectPublicKeyInfo
    )
    return PushKey(pem, public_pem, VAPID.get_application_server_key(public))


def _for_now(file: Path, done: str, error: OSError) -> PushKey:
    log.warning(
        "%s cannot be %s (%s): devices have to ask to be called again after the next start",
        file, done, error.strerror,
    )  # fmt: skip
    return _new()
