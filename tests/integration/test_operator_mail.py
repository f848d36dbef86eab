"""A question that nobody answers reaches the operators by mail, over a real SMTP server."""

from pathlib import Path

import pytest
from smtp_inbox import Inbox, smtp_server

from server.composition import open_service
from server.dialogues.mail import MailSettings
from server.journal import events as ev
from server.runtime.requests import RunRequest
from server.runtime.views import RunStatus
from server.settings import Settings


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
        settings = Settings(port=0, data_dir=tmp_path, mail=mail, speech_voice="none")
        async with open_service(settings) as service:
            request = RunRequest(
                tree="eket",
                world="tabletop",
                speed="max",
                scenario="eket_paper",
                answers="none",
                max_attempts=1,
            )
            started = await service.runtime.start_run(request)
            view = await service.runtime.wait_for_end(started.id)
            events = await service.journal.read(0, 10_000, started.id)
    assert view.status is RunStatus.FAILED
    [escalated] = [each for each in events if isinstance(each, ev.Escalated)]
    assert (escalated.channel, escalated.to) == ("mail", "ops@example.org")
    [received] = inbox.mails
    assert inbox.recipients == ["ops@example.org"]
    assert "I lost hold of the pink bar." in received.get_content()
    [closed] = [each for each in events if isinstance(each, ev.DialogueClosed)]
    assert closed.reason == "gave_up"
