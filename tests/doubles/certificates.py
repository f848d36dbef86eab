"""Certificates of an issuer that nobody trusts but a test."""

import ssl
from dataclasses import dataclass
from pathlib import Path

import trustme


@dataclass(frozen=True, slots=True)
class Certificate:
    """A certificate, its key and its issuer's certificate, as files in PEM."""

    path: Path
    key: Path
    issuer: Path

    def server_context(self) -> ssl.SSLContext:
        context = ssl.create_default_context(ssl.Purpose.CLIENT_AUTH)
        context.load_cert_chain(self.path, self.key)
        return context

    def client_context(self) -> ssl.SSLContext:
        return ssl.create_default_context(cafile=str(self.issuer))


def make_certificate(folder: Path, *names: str) -> Certificate:
    """One for these names and addresses, by an issuer of its own."""
    folder.mkdir(parents=True, exist_ok=True)
    issuer = trustme.CA()
    issued = issuer.issue_cert(*names)
    made = Certificate(folder / "cert.pem", folder / "key.pem", folder / "issuer.pem")
    made.path.write_bytes(b"".join(each.bytes() for each in issued.cert_chain_pems))
    made.key.write_bytes(issued.private_key_pem.bytes())
    made.issuer.write_bytes(issuer.cert_pem.bytes())
    return made
