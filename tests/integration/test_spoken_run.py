"""A whole service, a run in which things go wrong, and a helper who only speaks."""

import asyncio
import shutil
from pathlib import Path

import pytest
from wav_device import WavDevice

from mend.server.cli.spoken_helper import SpokenHelper
from mend.server.client import MendClient
from mend.server.composition import open_service
from mend.server.journal.events import Answered, DialogueClosed
from mend.server.runtime.requests import RunRequest
from mend.server.settings import Settings
from mend.server.speech.ear import NoEars, choose_ears
from mend.server.speech.voice import NoVoice, choose_voice


@pytest.mark.slow
async def test_a_dialogue_is_answered_by_voice_alone(tmp_path: Path) -> None:
    person = choose_voice("flite", flite_voice="rms", piper_model=None)
    if isinstance(person, NoVoice) or shutil.which("flite") is None:
        pytest.skip("flite is not installed, and nobody else can speak here")
    if isinstance(choose_ears(True, 1), NoEars):
        pytest.skip("pocketsphinx is not installed")
    device = WavDevice(await person.render("no thank you"))
    settings = Settings(port=0, data_dir=tmp_path, journal=tmp_path / "journal.db")
    request = RunRequest(tree="eket", world="tabletop", speed="max", seed=7, interventions="random")
    async with (
        asyncio.timeout(120),
        open_service(settings) as service,
        MendClient(service.url) as client,
        client.follow("watcher") as events,
    ):
        helping = asyncio.create_task(SpokenHelper(client, "anna", device, device.tell).run())
        run = await client.start_run(request)
        answered = None
        async for event in events:
            if isinstance(event, Answered):
                answered = answered or event
            if isinstance(event, DialogueClosed) and answered is not None:
                break
        assert answered is not None
        assert (answered.helper, answered.answer) == ("anna", "no")
        assert 'You: "no thank you"' in device.told
        assert device.played
        await client.abort(run.id)
        helping.cancel()
        await asyncio.gather(helping, return_exceptions=True)
