"""The key of browser sessions outlives the service, and is read by nobody else."""

from pathlib import Path

import pytest
from starlette.requests import HTTPConnection

from mend.server.access.access import Access
from mend.server.access.sessions import KEY_BYTES
from mend.server.session_key import session_key


def test_the_key_is_kept_for_its_owner_alone(tmp_path: Path) -> None:
    file = tmp_path / "session.key"
    key = session_key(file)
    assert len(key) == KEY_BYTES
    assert session_key(file) == key
    assert file.stat().st_mode & 0o777 == 0o600
    assert list(tmp_path.iterdir()) == [file]


def test_each_service_has_its_own(tmp_path: Path) -> None:
    assert session_key(tmp_path / "a") != session_key(tmp_path / "b")


def test_a_spoilt_file_is_made_anew(tmp_path: Path) -> None:
    file = tmp_path / "session.key"
    file.write_bytes(b"half")
    key = session_key(file)
    assert (len(key), file.read_bytes()) == (KEY_BYTES, key)


def test_where_it_cannot_be_kept_it_lasts_for_now(
    tmp_path: Path, caplog: pytest.LogCaptureFixture
) -> None:
    for file in (tmp_path / "missing" / "session.key", tmp_path):
        assert len(session_key(file)) == KEY_BYTES
    assert "browsers have to sign in again" in caplog.messages[0]
    assert len(caplog.messages) == 2


def test_a_session_lasts_as_long_as_the_key_and_the_token() -> None:
    def access(token: str, key: bytes) -> Access:
        return Access(token, wall_time_s=lambda: 1000.0, session_key=key)

    key, other = b"k" * KEY_BYTES, b"o" * KEY_BYTES
    begun = access("token", key)
    holder = begun.of_token("token")
    assert holder is not None
    _, cookie = begun.sessions.new(holder)
    request = HTTPConnection(
        {"type": "http", "headers": [(b"cookie", f"mend_session={cookie}".encode())]}
    )
    assert access("token", key).by_request(request).caller is not None
    assert access("token", other).by_request(request).caller is None
    assert access("changed", key).by_request(request).caller is None
