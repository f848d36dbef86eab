"""The key that push services know the service by is made once, and stays its owner's."""

from pathlib import Path

import pytest

from mend.server.push.push_key import push_key
from mend.server.push.push_services import why_not_endpoint, why_not_keys

SERVICES = ["push.example.org", "127.0.0.1"]


def test_it_is_made_once_and_kept_for_its_owner_alone(tmp_path: Path) -> None:
    file = tmp_path / "journal.push_key"
    made = push_key(file)
    assert push_key(file) == made
    assert file.stat().st_mode & 0o777 == 0o600
    assert file.read_bytes() == made.private_pem
    assert len(made.public) == 87


def test_each_service_has_its_own(tmp_path: Path) -> None:
    assert push_key(tmp_path / "a").public != push_key(None).public


@pytest.mark.parametrize("held", [b"", b"half a key"])
def test_a_spoilt_file_is_made_anew(
    tmp_path: Path, held: bytes, caplog: pytest.LogCaptureFixture
) -> None:
    file = tmp_path / "journal.push_key"
    file.write_bytes(held)
    assert push_key(file) == push_key(file)
    assert "holds no key for push services" in caplog.messages[0]


def test_where_it_cannot_be_kept_it_lasts_for_now(
    tmp_path: Path, caplog: pytest.LogCaptureFixture
) -> None:
    assert push_key(tmp_path / "missing" / "key").public
    assert "devices have to ask to be called again" in caplog.messages[0]


@pytest.mark.parametrize(
    "endpoint",
    [
        "https://push.example.org/send/1",
        "https://eu.push.example.org:443/send/1",
        "http://127.0.0.1:9999/send",
    ],
)
def test_push_services_of_the_setting_are_written_to(endpoint: str) -> None:
    assert why_not_endpoint(endpoint, SERVICES) is None


@pytest.mark.parametrize(
    ("endpoint", "why"),
    [
        ("https://169.254.169.254/latest", "is at 169.254.169.254"),
        ("https://localhost/", "is at localhost"),
        ("https://evilpush.example.org.attacker.com/", "none of the setting 'push_services'"),
        ("https://notpush.example.org/", "none of the setting"),
        ("http://push.example.org/send", "must begin with https://"),
        ("https://push.example.org:8443/send", "must begin with https://"),
        ("https://user@push.example.org/", "is no address of a push service"),
        ("ftp://127.0.0.1/", "is no address of a web service"),
        ("push", "is no address of a push service"),
        ("https://[", "is no address"),
    ],
)
def test_nothing_else_is_written_to(endpoint: str, why: str) -> None:
    assert why in (why_not_endpoint(endpoint, SERVICES) or "")


@pytest.mark.parametrize("p256dh", ["", "AAAA", "BAAA" + "A" * 83, "not base64!"])
def test_keys_that_nothing_can_be_encrypted_for_are_refused(p256dh: str) -> None:
    assert "'p256dh' must be a point" in (why_not_keys(p256dh, "A" * 22) or "")


def test_a_secret_of_another_length_is_refused() -> None:
    assert "'auth' must be 16 bytes" in (why_not_keys(push_key(None).public, "AAAA") or "")
