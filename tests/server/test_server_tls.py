"""A certificate that cannot be used is refused with a sentence that says why."""

import ssl
from pathlib import Path

import pytest
from certificates import make_certificate
from cryptography.hazmat.primitives import serialization

from mend.server.server_tls import server_tls
from mend.server.settings import WrongSettingsError


def refusal(certificate: Path, key: Path) -> str:
    with pytest.raises(WrongSettingsError) as wrong:
        server_tls(certificate, key)
    (sentence,) = wrong.value.problems
    assert sentence.startswith("The service cannot use TLS: ")
    return sentence


def test_what_fits_together_is_used(tmp_path: Path) -> None:
    made = make_certificate(tmp_path, "localhost")
    context = server_tls(made.path, made.key)
    assert context.minimum_version is ssl.TLSVersion.TLSv1_2


def test_a_file_that_is_not_there_is_named(tmp_path: Path) -> None:
    made = make_certificate(tmp_path, "localhost")
    nowhere = tmp_path / "nowhere.pem"
    assert f"'tls_certificate' ({nowhere}) cannot be read: No such file" in refusal(
        nowhere, made.key
    )
    assert f"'tls_key' ({nowhere}) cannot be read: No such file" in refusal(made.path, nowhere)
    assert "'tls_key' " in refusal(made.path, tmp_path)


@pytest.mark.parametrize("text", ["", "no PEM at all", "-----BEGIN CERTIFICATE-----\nAAAA\n"])
def test_what_is_no_pem_is_named(tmp_path: Path, text: str) -> None:
    made = make_certificate(tmp_path, "localhost")
    wrong = tmp_path / "wrong.pem"
    wrong.write_text(text)
    assert f"'tls_certificate' ({wrong}) holds no certificate in PEM" in refusal(wrong, made.key)
    assert f"'tls_key' ({wrong}) holds no private key in PEM" in refusal(made.path, wrong)


def test_a_key_of_another_certificate_is_refused(tmp_path: Path) -> None:
    one, other = (make_certificate(tmp_path / name, "localhost") for name in ("one", "other"))
    assert f"'tls_key' ({other.key}) is not the key of the certificate in {one.path}" in (
        refusal(one.path, other.key)
    )


def test_a_key_with_a_password_is_refused_without_asking_for_it(tmp_path: Path) -> None:
    made = make_certificate(tmp_path, "localhost")
    key = serialization.load_pem_private_key(made.key.read_bytes(), None)
    made.key.write_bytes(
        key.private_bytes(
            serialization.Encoding.PEM,
            serialization.PrivateFormat.PKCS8,
            serialization.BestAvailableEncryption(b"secret"),
        )
    )
    assert "needs a password; give a key without one" in refusal(made.path, made.key)
