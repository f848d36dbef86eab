"""A page that was left counts as away, is called after who is here, and everybody may see it."""

import json
from pathlib import Path
from typing import Any

import httpx
import pytest
from websockets.asyncio.client import ClientConnection, connect

from mend.server.client import MendClient
from mend.server.composition import Service, open_service
from mend.server.settings import Settings


def page(service: Service, helper: str, presence: str) -> connect:
    url = service.url.replace("http", "ws", 1)
    return connect(f"{url}/ws/helper?helper={helper}&presence={presence}")


async def says(socket: ClientConnection, presence: str) -> Any:
    await socket.send(json.dumps({"type": "here", "presence": presence, "id": 1}))
    async for frame in socket:
        message = json.loads(frame)
        if message.get("id") == 1:
            return message
    raise AssertionError("the connection has ended")


async def reach(service: Service) -> dict[str, str]:
    async with MendClient(service.url) as client:
        return {each.helper: each.reach for each in (await client.helpers()).helpers}


@pytest.mark.slow(seconds=3)
async def test_pages_say_whether_somebody_is_at_them(tmp_path: Path) -> None:
    settings = Settings(
        port=0, data_dir=tmp_path, speech_voice="none", log_level="error",
        helpers=["anna", "ben", "carl"], away_after_s=600,
    )  # fmt: skip
    async with (
        open_service(settings) as service,
        page(service, "anna", "active") as anna,
        page(service, "ben", "away") as ben,
        page(service, "dan", "beside") as dan,
    ):
        for each in (anna, dan):
            # Refused, it changes nothing, and is answered once the service knows of the page.
            await says(each, "asleep")
        said = await says(ben, "away")
        assert (said["type"], said["result"]) == ("result", {"away_after_s": 600})
        here = {"anna": "here", "ben": "away", "carl": "gone", "dan": "here"}
        assert await reach(service) == here
        await says(anna, "away")
        await says(ben, "active")
        assert await reach(service) == {**here, "anna": "away", "ben": "here"}
        wrong = await says(ben, "asleep")
        assert (wrong["type"], wrong["status"]) == ("error", 422)
        assert (await reach(service))["ben"] == "here"
        async with httpx.AsyncClient(base_url=service.url) as client:
            seen = (await client.get("/api/helpers")).json()
        assert {*seen["helpers"][0]} == {"helper", "reach", "on", "asked"}
