"""A push service on loopback, and devices that decrypt what comes there as a browser does."""

import base64
import os
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from typing import Any

import jwt
from cryptography.hazmat.primitives import hashes, serialization
from cryptography.hazmat.primitives.asymmetric import ec
from cryptography.hazmat.primitives.ciphers.aead import AESGCM
from cryptography.hazmat.primitives.kdf.hkdf import HKDF
from pydantic import TypeAdapter

from mend.server.push.messages import PushMessage

Message: TypeAdapter[Any] = TypeAdapter(PushMessage)


@dataclass(frozen=True)
class Pushed:
    """One request as it came, `at_s` seconds after the epoch."""

    path: str
    headers: dict[str, str]
    body: bytes
    at_s: float = field(default_factory=time.time)


@dataclass
class PushService:
    """What has come, and what is answered: each path's statuses in turn, then 201."""

    url: str
    pushed: list[Pushed] = field(default_factory=list)
    statuses: dict[str, list[int]] = field(default_factory=dict)
    retry_after: str | None = None
    arrived: threading.Condition = field(default_factory=threading.Condition)

    def of(self, device: "PushDevice") -> list[Any]:
        """The messages that one device got, decrypted."""
        return [device.read(each) for each in self.pushed if each.path == device.path]

    def take(self, pushed: Pushed) -> int:
        with self.arrived:
            self.pushed.append(pushed)
            self.arrived.notify_all()
        waiting = self.statuses.get(pushed.path, [])
        return waiting.pop(0) if waiting else 201


class PushDevice:
    """A browser's side of a subscription (RFC 8291, RFC 8292)."""

    def __init__(self, service: PushService, name: str) -> None:
        self._key = ec.generate_private_key(ec.SECP256R1())
        self._auth = os.urandom(16)
        self.name, self.path = name, f"/to/{name}"
        self.endpoint = service.url + self.path

    @property
    def subscription(self) -> dict[str, Any]:
        """What the device sends to be called."""
        keys = {"p256dh": encoded(self._public), "auth": encoded(self._auth)}
        return {"endpoint": self.endpoint, "keys": keys, "device": self.name}

    def read(self, pushed: Pushed) -> Any:
        """A pushed message. Raises what `cryptography` does for one that is for others."""
        assert pushed.headers["content-encoding"] == "aes128gcm"
        salt, sender = pushed.body[:16], pushed.body[21 : 21 + pushed.body[20]]
        theirs = ec.EllipticCurvePublicKey.from_encoded_point(ec.SECP256R1(), sender)
        info = b"WebPush: info\x00" + self._public + sender
        secret = _derived(self._auth, self._key.exchange(ec.ECDH(), theirs), info, 32)
        key = _derived(salt, secret, b"Content-Encoding: aes128gcm\x00", 16)
        nonce = _derived(salt, secret, b"Content-Encoding: nonce\x00", 12)
        plain = AESGCM(key).decrypt(nonce, pushed.body[21 + pushed.body[20] :], None)
        assert plain.endswith(b"\x02"), "the last record ends so"
        return Message.validate_json(plain[:-1])

    @property
    def _public(self) -> bytes:
        return self._key.public_key().public_bytes(
            serialization.Encoding.X962, serialization.PublicFormat.UncompressedPoint
        )


def signed_claims(pushed: Pushed, application_key: str) -> dict[str, Any]:
    """What the sender has signed with this key. Raises `jwt.InvalidTokenError`."""
    scheme, _, parts = pushed.headers["authorization"].partition(" ")
    assert scheme == "vapid"
    shown = dict(part.strip().split("=", 1) for part in parts.split(","))
    assert shown["k"] == application_key
    point = base64.urlsafe_b64decode(shown["k"] + "=" * (-len(shown["k"]) % 4))
    key: Any = ec.EllipticCurvePublicKey.from_encoded_point(ec.SECP256R1(), point)
    claims: dict[str, Any] = jwt.decode(
        shown["t"], key, algorithms=["ES256"], audience="http://127.0.0.1"
    )
    return claims


@contextmanager
def push_service() -> Iterator[PushService]:
    """Serve one on a free port."""

    class Handler(BaseHTTPRequestHandler):
        def do_POST(self) -> None:
            body = self.rfile.read(int(self.headers["content-length"]))
            headers = {name.lower(): value for name, value in self.headers.items()}
            self.send_response(service.take(Pushed(self.path, headers, body)))
            if service.retry_after is not None:
                self.send_header("Retry-After", service.retry_after)
            self.send_header("Content-Length", "0")
            self.end_headers()

        def log_message(self, *_: object) -> None:
            """Nothing is to be read there."""

    server = ThreadingHTTPServer(("127.0.0.1", 0), Handler)
    service = PushService(f"http://127.0.0.1:{server.server_address[1]}")
    thread = threading.Thread(target=server.serve_forever, args=(0.01,))
    thread.start()
    try:
        yield service
    finally:
        server.shutdown()
        thread.join()
        server.server_close()


def encoded(raw: bytes) -> str:
    return base64.urlsafe_b64encode(raw).rstrip(b"=").decode()


def _derived(salt: bytes, secret: bytes, info: bytes, length: int) -> bytes:
    return HKDF(hashes.SHA256(), length, salt, info).derive(secret)
