"""Operators are written to through a real SMTP server, and failures are told in one sentence."""

from dataclasses import replace
from datetime import UTC, datetime
from uuid import UUID

import pytest
from aiosmtpd.smtp import SMTP, AuthResult, Envelope, LoginPassword, Session
from certificates import Certificate, make_certificate
from pydantic import ValidationError
from smtp_inbox import Inbox, Watched, WatchedSMTP, listening, smtp_server

from mend.server.dialogues.mail import Mailer, MailError, MailRequest, MailSettings, RefusedAddress

WRITTEN = datetime(2026, 1, 1, 12, 0, tzinfo=UTC)
OPERATORS = ("ops@example.org", "night@example.org")
REQUEST = MailRequest(
    run=UUID(int=1),
    dialogue=UUID(int=2),
    prompt=UUID(int=3),
    tree="eket",
    robot="pr2",
    issue="dropped",
    object="pink_bar",
    node="/1/0",
    name="place_pink_bar",
    question="I dropped the pink bar. Shall I try again?",
    yes_effect="You put the pink bar back on the table; I pick it up later.",
    no_effect="I ask whether you will place the pink bar yourself.",
    answer_within_s=600.0,
    console_url="http://127.0.0.1:8000/",
)


def mailer(port: int, /, **settings: object) -> Mailer:
    given = {
        "host": "127.0.0.1",
        "port": port,
        "tls": "none",
        "sender": "mend@example.org",
        "operators": OPERATORS,
        "timeout_s": 5.0,
    }
    return Mailer(MailSettings.model_validate(given | settings))


async def test_an_operator_reads_what_is_asked_and_what_each_answer_does() -> None:
    inbox = Inbox()
    async with smtp_server(inbox) as port:
        refused = await mailer(port).send(REQUEST, OPERATORS, WRITTEN)
    assert refused == ()
    assert inbox.recipients == list(OPERATORS)
    (mail,) = inbox.mails
    assert mail["Subject"] == "pr2 asks for help (dropped, pink_bar)"
    assert mail["From"] == "mend@example.org"
    text = mail.get_content()
    for told in (
        REQUEST.question,
        REQUEST.yes_effect,
        REQUEST.no_effect,
        "http://127.0.0.1:8000/",
        "10.0 minutes",
        str(REQUEST.dialogue),
    ):
        assert told in text


async def test_a_mail_sent_again_for_the_same_prompt_can_be_told_as_the_same() -> None:
    inbox = Inbox()
    async with smtp_server(inbox) as port:
        for _ in range(2):
            await mailer(port).send(REQUEST, OPERATORS, WRITTEN)
    first, second = inbox.mails
    assert first["Message-ID"] == second["Message-ID"]


async def test_addresses_that_the_server_refuses_are_returned() -> None:
    inbox = Inbox(refuses=("night@example.org",))
    async with smtp_server(inbox) as port:
        refused = await mailer(port).send(REQUEST, OPERATORS, WRITTEN)
    assert refused == (RefusedAddress("night@example.org", "550 no such mailbox", for_now=False),)
    assert inbox.recipients == ["ops@example.org"]


async def test_a_mail_that_reaches_nobody_returns_all_addresses() -> None:
    async with smtp_server(Inbox(refuses=OPERATORS)) as port:
        refused = await mailer(port).send(REQUEST, OPERATORS, WRITTEN)
    assert [each.address for each in refused] == list(OPERATORS)


@pytest.mark.parametrize(("answer", "for_now"), [("451 come back", True), ("550 no", False)])
async def test_the_server_says_whether_it_is_worth_trying_again(answer: str, for_now: bool) -> None:
    inbox = Inbox(refuses=OPERATORS[:1], refusal=answer)
    async with smtp_server(inbox) as port:
        (refused,) = await mailer(port).send(REQUEST, OPERATORS, WRITTEN)
    assert refused.for_now is for_now


async def test_a_server_that_is_not_there_is_named() -> None:
    async with smtp_server(Inbox()) as port:
        pass
    with pytest.raises(MailError, match=rf"through 127\.0\.0\.1:{port}: ") as error:
        await mailer(port).send(REQUEST, OPERATORS, WRITTEN)
    assert error.value.for_now


async def test_a_server_that_never_speaks_is_not_waited_for() -> None:
    async with listening(Watched) as port:
        with pytest.raises(MailError, match="could not be sent through"):
            await mailer(port, timeout_s=0.05).send(REQUEST, OPERATORS, WRITTEN)


async def test_a_server_without_encryption_is_not_talked_to_in_clear() -> None:
    inbox = Inbox()
    async with smtp_server(inbox) as port:
        with pytest.raises(MailError, match="STARTTLS"):
            await mailer(port, tls="starttls").send(REQUEST, OPERATORS, WRITTEN)
    assert inbox.mails == []


@pytest.fixture(scope="module")
def certificate(tmp_path_factory: pytest.TempPathFactory) -> Certificate:
    return make_certificate(tmp_path_factory.mktemp("certificate"), "127.0.0.1")


@pytest.mark.parametrize("trusted", [True, False])
@pytest.mark.parametrize("tls", ["starttls", "tls"])
async def test_only_a_server_with_a_trusted_certificate_gets_the_mail(
    certificate: Certificate, tls: str, trusted: bool
) -> None:
    context = certificate.server_context()
    inbox = Inbox()
    from_first_byte = context if tls == "tls" else None

    def protocol() -> Watched:
        return WatchedSMTP(inbox, tls_context=None if from_first_byte else context)

    async with listening(protocol, from_first_byte) as port:
        sending = mailer(port, tls=tls, ca_file=certificate.issuer if trusted else None)
        if trusted:
            await sending.send(REQUEST, OPERATORS, WRITTEN)
        else:
            with pytest.raises(MailError, match="certificate"):
                await sending.send(REQUEST, OPERATORS, WRITTEN)
    assert len(inbox.mails) == trusted


@pytest.mark.parametrize(("password", "taken"), [("right", True), ("wrong", False)])
async def test_the_server_may_want_a_password(
    certificate: Certificate, password: str, taken: bool
) -> None:
    def authenticate(
        server: SMTP,  # noqa: ARG001
        session: Session,  # noqa: ARG001
        envelope: Envelope,  # noqa: ARG001
        mechanism: str,  # noqa: ARG001
        credentials: LoginPassword,
    ) -> AuthResult:
        return AuthResult(success=credentials == LoginPassword(b"mend", b"right"), handled=False)

    inbox = Inbox()
    context = certificate.server_context()

    def protocol() -> Watched:
        return WatchedSMTP(
            inbox, tls_context=context, authenticator=authenticate, auth_required=True
        )

    async with listening(protocol) as port:
        sending = mailer(
            port, tls="starttls", ca_file=certificate.issuer, user="mend", password=password
        )
        if taken:
            await sending.send(REQUEST, OPERATORS, WRITTEN)
        else:
            with pytest.raises(MailError, match="could not be sent through") as caught:
                await sending.send(REQUEST, OPERATORS, WRITTEN)
            assert password not in str(caught.value)
            assert not caught.value.for_now
    assert bool(inbox.mails) is taken


def test_a_name_with_a_line_break_begins_no_header() -> None:
    spoilt = replace(REQUEST, robot="pr2\r\nBcc: thief@example.org", object="bar\nX-Evil: 1")
    mail = mailer(25).compose(spoilt, OPERATORS, WRITTEN)
    assert mail["Bcc"] is None
    assert mail["X-Evil"] is None
    assert mail["Subject"] == "pr2 Bcc: thief@example.org asks for help (dropped, bar X-Evil: 1)"


def test_a_request_without_an_object_or_a_console_reads_well() -> None:
    bare = replace(REQUEST, object=None, console_url=None, answer_within_s=None)
    mail = mailer(25).compose(bare, OPERATORS, WRITTEN)
    assert mail["Subject"] == "pr2 asks for help (dropped)"
    assert "None" not in mail.get_content()
    assert "Please answer in the helper console." in mail.get_content()


@pytest.mark.parametrize(
    ("wrong", "sentence"),
    [
        ({"user": "mend"}, "go together"),
        ({"host": "mail.example.org", "user": "mend", "password": "s"}, "in clear"),
        ({"operators": ()}, "at least 1 item"),
        ({"operators": ("ops@example.org\nBcc: thief@example.org",)}, "is not a mail address"),
        ({"sender": "nobody"}, "'nobody' is not a mail address"),
        ({"port": 0}, "greater than or equal to 1"),
        ({"tls": "maybe"}, "'tls', 'starttls' or 'none'"),
    ],
)
def test_wrong_settings_are_refused(wrong: dict[str, object], sentence: str) -> None:
    with pytest.raises(ValidationError, match=sentence):
        mailer(25, **wrong)
