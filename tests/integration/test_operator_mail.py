"""A question that nobody answers reaches the operators by mail, over a real SMTP server."""

import asyncio
from pathlib import Path
from typing import Any

import httpx
import pytest
from smtp_inbox import Inbox, Watched, listening, smtp_server

from mend.server.composition import open_service
from mend.server.dialogues.mail import MailSettings
from mend.server.journal import events as ev
from mend.server.runtime.requests import RunRequest
from mend.server.runtime.views import RunStatus
from mend.server.settings import Settings

NOBODY_ANSWERS = RunRequest(
    tree="eket",
    world="tabletop",
    speed="max",
    scenario="eket_paper",
    answers="none",
    max_attempts=1,
)

# In a simulation that nobody interrupts, waiting costs time too.
PATIENCE: dict[str, Any] = {"ask_deadline_s": 5.0, "mail_deadline_s": 10.0, "help_window_s": 5.0}


@pytest.mark.slow
async def test_operators_are_written_to_and_the_run_gives_up_when_they_are_silent_too(
    tmp_path: Path,
) -> None:
    inbox = Inbox()
    async with smtp_server(inbox) as port:
        mail = MailSettings(
            host="127.0.0.1",
            port=port,
            tls="none",
            sender="mend@example.org",
            operators=("ops@example.org",),
        )
        settings = Settings(
            port=0,
            data_dir=tmp_path,
            mail=mail,
            speech_voice="none",
            public_url="https://mend.example.org/",
            **PATIENCE,
        )
        async with open_service(settings) as service:
            started = await service.runtime.start_run(NOBODY_ANSWERS)
            view = await service.runtime.wait_for_end(started.id)
            events = await service.journal.read(0, 10_000, started.id)
    assert view.status is RunStatus.FAILED
    [escalated] = [each for each in events if isinstance(each, ev.Escalated)]
    assert (escalated.channel, escalated.to) == ("mail", "ops@example.org")
    [received] = inbox.mails
    assert inbox.recipients == ["ops@example.org"]
    assert "I lost hold of the pink bar." in received.get_content()
    assert f"https://mend.example.org/runs/{started.id}" in received.get_content()
    [closed] = [each for each in events if isinstance(each, ev.DialogueClosed)]
    assert closed.reason == "gave_up"


@pytest.mark.slow
async def test_a_mail_server_that_never_answers_does_not_keep_the_service_from_stopping(
    tmp_path: Path, caplog: pytest.LogCaptureFixture
) -> None:
    async with listening(Watched) as port:
        mail = MailSettings(
            host="127.0.0.1",
            port=port,
            tls="none",
            sender="mend@example.org",
            operators=("ops@example.org",),
            timeout_s=300.0,
        )
        settings = Settings(port=0, data_dir=tmp_path, mail=mail, speech_voice="none", **PATIENCE)
        opened = open_service(settings)
        service = await opened.__aenter__()
        started = await service.runtime.start_run(NOBODY_ANSWERS)
        await service.runtime.wait_for_end(started.id)
        async with asyncio.timeout(60):
            await opened.__aexit__(None, None, None)
    assert any("the service stops: the mail about" in each for each in caplog.messages)


@pytest.mark.parametrize(
    ("host", "public_url", "console"),
    [
        ("127.0.0.1", None, "http://127.0.0.1:"),
        ("0.0.0.0", None, None),
        ("0.0.0.0", "https://mend.example.org", "https://mend.example.org"),
    ],
)
async def test_others_are_told_an_address_under_which_they_reach_the_service(
    tmp_path: Path, host: str, public_url: str | None, console: str | None
) -> None:
    settings = Settings(
        host=host,
        port=0,
        token="long-and-random",
        data_dir=tmp_path,
        speech_voice="none",
        public_url=public_url,
    )
    async with open_service(settings) as service:
        assert service.url.startswith("http://127.0.0.1:")
        assert (service.public_url is None) is (console is None)
        assert (service.public_url or "").startswith(console or "")
        async with httpx.AsyncClient(base_url=service.url) as client:
            response = await client.get("/healthz", headers={"Host": "mend.example.org"})
    assert response.status_code == (200 if public_url else 421)
