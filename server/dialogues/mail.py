"""Mail to the operators when no helper answers: the last rung of the ladder."""

import re
from collections.abc import Sequence
from dataclasses import dataclass
from datetime import datetime
from email.message import EmailMessage
from email.utils import format_datetime
from ipaddress import ip_address
from pathlib import Path
from typing import Annotated, Literal, Self
from uuid import UUID

import aiosmtplib
from jinja2 import Environment, PackageLoader, StrictUndefined
from pydantic import (
    AfterValidator,
    BaseModel,
    ConfigDict,
    Field,
    SecretStr,
    StringConstraints,
    model_validator,
)

from mend.errors import MendError

FOR_GOOD = 500
"""SMTP's answers below that are about this moment only."""


def _require_address(text: str) -> str:
    if len(text) > 254 or not re.fullmatch(r"[^\s@<>,;:\"\\]+@[^\s@<>,;:\"\\]+", text):
        raise ValueError(f"{text!r} is not a mail address; one looks like name@example.org")
    return text


Address = Annotated[str, AfterValidator(_require_address)]


class MailSettings(BaseModel):
    """The SMTP server to send through.

    `tls`: encrypted from the first byte (`tls`), after STARTTLS, or not at all (`none`).
    `ca_file` names the certificates to trust in place of the system's.
    """

    model_config = ConfigDict(extra="forbid", frozen=True)

    host: Annotated[str, StringConstraints(pattern=r"^[A-Za-z0-9.:\-]+$", max_length=253)]
    port: Annotated[int, Field(ge=1, le=65535)] = 587
    tls: Literal["tls", "starttls", "none"] = "starttls"
    ca_file: Path | None = None
    user: str | None = None
    password: SecretStr | None = None
    sender: Address
    operators: Annotated[tuple[Address, ...], Field(min_length=1, max_length=64)]
    timeout_s: Annotated[float, Field(gt=0.0, le=300.0, allow_inf_nan=False)] = 15.0

    @model_validator(mode="after")
    def _require_safe_credentials(self) -> Self:
        if (self.user is None) != (self.password is None):
            raise ValueError("'user' and 'password' go together: set both or neither")
        if self.user is not None and self.tls == "none" and not _is_loopback(self.host):
            raise ValueError(
                "the password would cross the network in clear; set 'tls' to 'starttls' or 'tls'"
            )
        return self


@dataclass(frozen=True, slots=True)
class MailRequest:
    """What an operator is told about an ask that nobody answered."""

    run: UUID
    dialogue: UUID
    prompt: UUID
    tree: str
    robot: str
    issue: str
    object: str | None
    node: str
    name: str
    question: str
    yes_effect: str
    no_effect: str
    timeout_effect: str = ""
    answer_within_s: float | None = None
    console_url: str | None = None


@dataclass(frozen=True, slots=True)
class MailNotice:
    """What an operator is told about an issue that may be a false alarm."""

    run: UUID
    dialogue: UUID
    tree: str
    robot: str
    issue: str
    object: str | None
    node: str
    name: str
    times: int
    explanation: str
    console_url: str | None = None


@dataclass(frozen=True, slots=True)
class RefusedAddress:
    """An address that the server does not take a mail for; `for_now`: it may later."""

    address: str
    reason: str
    for_now: bool


class MailError(MendError):
    """A mail could not be sent; the message says through which server, and why.

    `for_now`: it is worth trying again.
    """

    def __init__(self, message: str, *, for_now: bool) -> None:
        super().__init__(message)
        self.for_now = for_now


class Mailer:
    """Writes to operators through one SMTP server."""

    def __init__(self, settings: MailSettings) -> None:
        self._settings = settings
        environment = Environment(
            loader=PackageLoader("mend.server.dialogues", "."),
            undefined=StrictUndefined,
            trim_blocks=True,
            autoescape=False,
        )
        self._request = environment.get_template("mail_request.txt.j2")
        self._notice = environment.get_template("mail_notice.txt.j2")

    async def send(
        self, mail: MailRequest | MailNotice, to: Sequence[str], written: datetime
    ) -> tuple[RefusedAddress, ...]:
        """Send a request for help, or a notice; returns the addresses that the server refused.

        Raises `MailError` when it could be sent to none of them for another reason. A mail that is
        sent again for the same prompt (or suspicion) has the same Message-ID.
        """
        settings = self._settings
        message = self.compose(mail, to, written)
        try:
            refused, _ = await aiosmtplib.send(
                message,
                hostname=settings.host,
                port=settings.port,
                username=settings.user,
                password=settings.password.get_secret_value() if settings.password else None,
                use_tls=settings.tls == "tls",
                start_tls=settings.tls == "starttls",
                cert_bundle=str(settings.ca_file) if settings.ca_file else None,
                timeout=settings.timeout_s,
            )
        except aiosmtplib.SMTPRecipientsRefused as error:
            return tuple(
                _refused(each.recipient, each.code, each.message) for each in error.recipients
            )
        except (aiosmtplib.SMTPException, OSError) as error:
            raise MailError(
                f"the mail to {', '.join(to)} could not be sent through "
                f"{settings.host}:{settings.port}: {_one_line(str(error)) or type(error).__name__}",
                for_now=not _is_final(error),
            ) from error
        return tuple(
            _refused(address, answer.code, answer.message) for address, answer in refused.items()
        )

    def compose(
        self, mail: MailRequest | MailNotice, to: Sequence[str], written: datetime
    ) -> EmailMessage:
        """The filled-in mail."""
        about = f"{mail.issue}, {mail.object}" if mail.object else mail.issue
        match mail:
            case MailRequest():
                subject, of = f"{mail.robot} asks for help ({about})", str(mail.prompt)
                text = self._request.render(request=mail)
            case MailNotice():
                subject, of = f"{mail.robot} may be wrong ({about})", f"{mail.dialogue}.suspected"
                text = self._notice.render(notice=mail)
        message = EmailMessage()
        message["From"] = self._settings.sender
        message["To"] = ", ".join(to)
        message["Date"] = format_datetime(written)
        message["Message-ID"] = f"<{of}@{self._settings.sender.rpartition('@')[2]}>"
        message["Subject"] = _one_line(subject)
        # Mail programs do not answer such mails with "I am on holiday".
        message["Auto-Submitted"] = "auto-generated"
        message.set_content(text)
        return message


def _one_line(text: str) -> str:
    """Without line breaks, which would begin another header."""
    return " ".join(text.split())


def _refused(address: str, code: int, message: str) -> RefusedAddress:
    return RefusedAddress(address, f"{code} {_one_line(message)}", for_now=code < FOR_GOOD)


def _is_final(error: Exception) -> bool:
    """Whether the server has said that it will never take this, as with a wrong password."""
    return isinstance(error, aiosmtplib.SMTPResponseException) and error.code >= FOR_GOOD


def _is_loopback(host: str) -> bool:
    try:
        return ip_address(host).is_loopback
    except ValueError:
        return host == "localhost"
