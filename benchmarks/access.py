# ruff: noqa: T201
"""What looking at a token costs per request, beside a slow hash of it.

python benchmarks/access.py
"""

import hashlib
import tempfile
import time
from collections.abc import Callable
from datetime import UTC, datetime
from pathlib import Path
from statistics import median

from starlette.requests import HTTPConnection

from mend.server.access.access import Access
from mend.server.access.changes import PrincipalsEditor
from mend.server.access.known_principals import KnownPrincipals
from mend.server.access.permissions import needed_for_request
from mend.server.access.roles import Role

PRINCIPALS = 200
ROUNDS = 2_000


def main() -> None:
    """Print the median of each."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "principals.yaml"
        editor = PrincipalsEditor(path, by="benchmark")
        tokens = [
            editor.add(f"helper {number}", Role.HELPER, datetime.now(UTC))
            for number in range(PRINCIPALS)
        ]
        access = Access(None, principals=KnownPrincipals(path, time.time), wall_time_s=time.time)
        bearer = _connection(b"authorization", f"Bearer {tokens[-1]}")
        principal = access.of_token(tokens[-1])
        assert principal is not None
        cookie = _connection(b"cookie", f"mend_session={access.sessions.new(principal)[1]}")
        told = {
            "a bearer, with a look at the file": lambda: access.by_request(bearer).caller,
            "a session cookie, with a look at the file": lambda: access.by_request(cookie).caller,
            "the role that a request needs": lambda: needed_for_request("GET", "/metrics"),
        }
        for what, work in told.items():
            assert work() is not None
            _tell(what, work, ROUNDS)
        slow = tokens[-1].encode()
        _tell("peer: scrypt (N=2^14, r=8) of the token", lambda: _scrypt(slow), 20)


def _connection(name: bytes, value: str) -> HTTPConnection:
    return HTTPConnection({"type": "http", "headers": [(name, value.encode())]})


def _scrypt(token: bytes) -> bytes:
    return hashlib.scrypt(token, salt=b"benchmark", n=2**14, r=8, p=1)


def _tell(what: str, work: Callable[[], object], rounds: int) -> None:
    took = []
    for _ in range(rounds):
        began = time.perf_counter()
        work()
        took.append(time.perf_counter() - began)
    print(f"{what:45} {median(took) * 1e6:10.1f} µs")


if __name__ == "__main__":
    main()
