"""The requests that the documentation shows do what it says of them."""

import json
import re
import shlex
from pathlib import Path
from uuid import UUID

import httpx
import pytest

from mend.server.composition import open_service
from mend.server.settings import Settings

ROOT = Path(__file__).parents[2]


def documented_requests() -> list[list[str]]:
    """The words of each `curl` in the document of the API, without `curl` itself."""
    (block,) = re.findall(r"```sh\n(.*?)```", (ROOT / "docs/console_api.md").read_text(), re.S)
    lines = [shlex.split(each) for each in block.splitlines()]
    return [words[1:] for words in lines if words[0] == "curl"]


async def send(client: httpx.AsyncClient, words: list[str]) -> httpx.Response:
    path = words[-1].removeprefix("$api")
    body = words[words.index("--json") + 1] if "--json" in words else None
    if body is not None:
        return await client.post(path, json=json.loads(body))
    header, _, value = words[words.index("-H") + 1].partition(": ")
    file = ROOT / words[words.index("--data-binary") + 1].removeprefix("@")
    return await client.post(path, content=file.read_bytes(), headers={header: value})


@pytest.mark.slow
async def test_own_files_are_kept_and_run_over_rest(tmp_path: Path) -> None:
    settings = Settings(port=0, data_dir=tmp_path, speech_voice="none", log_level="error")
    async with (
        open_service(settings) as service,
        httpx.AsyncClient(base_url=f"{service.url}/api") as client,
    ):
        replies = [await send(client, each) for each in documented_requests()]
        assert [each.status_code for each in replies] == [201] * 4, [each.text for each in replies]
        view = await service.runtime.wait_for_end(UUID(replies[-1].json()["id"]))
    assert view.result is not None
    assert (view.status, view.result.missing) == ("finished", [])
