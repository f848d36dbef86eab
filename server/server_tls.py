"""TLS with the operator's own certificate."""

import ssl
from pathlib import Path

from mend.errors import MendError
from mend.server.settings import Settings, WrongSettingsError


def tls_of(settings: Settings) -> ssl.SSLContext | None:
    """What a service with these settings encrypts with; None if with nothing."""
    if settings.tls_certificate is None or settings.tls_key is None:
        return None
    return server_tls(settings.tls_certificate, settings.tls_key)


def server_tls(certificate: Path, key: Path) -> ssl.SSLContext:
    """What the service encrypts with. Raises `WrongSettingsError` with what is wrong."""
    _require_readable("tls_certificate", certificate)
    _require_readable("tls_key", key)
    context = ssl.create_default_context(ssl.Purpose.CLIENT_AUTH)
    context.minimum_version = ssl.TLSVersion.TLSv1_2
    context.set_alpn_protocols(["http/1.1"])
    try:
        # Only to tell which of the two is no PEM: on its own it changes nothing.
        ssl.create_default_context(cafile=certificate)
    except ssl.SSLError:
        raise _wrong(f"'tls_certificate' ({certificate}) holds no certificate in PEM") from None
    try:
        context.load_cert_chain(certificate, key, password=_no_password)
    except _PasswordWantedError:
        raise _wrong(f"'tls_key' ({key}) needs a password; give a key without one") from None
    except ssl.SSLError as error:
        if error.reason == "KEY_VALUES_MISMATCH":
            sentence = f"'tls_key' ({key}) is not the key of the certificate in {certificate}"
            raise _wrong(sentence) from None
        raise _wrong(f"'tls_key' ({key}) holds no private key in PEM") from None
    return context


class _PasswordWantedError(MendError):
    pass


def _no_password() -> str:
    # Without this OpenSSL would ask at the terminal.
    raise _PasswordWantedError


def _require_readable(setting: str, file: Path) -> None:
    try:
        file.read_bytes()
    except OSError as error:
        raise _wrong(f"'{setting}' ({file}) cannot be read: {error.strerror}") from None


def _wrong(sentence: str) -> WrongSettingsError:
    return WrongSettingsError([f"The service cannot use TLS: {sentence}."])
